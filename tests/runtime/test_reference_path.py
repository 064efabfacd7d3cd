"""Paths against formulas (straight, circle, clothoid), and there and back between plane and path."""

import math
import subprocess
import sys

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from regdb_runtime.errors import OutsideDomain, RegdbRuntimeError
from regdb_runtime.maps.reference_path import ReferencePath
from regdb_runtime.maps.smoothing import PathSettings
from regdb_runtime.observation import EgoState
from scipy.special import fresnel

EXACT = PathSettings(smoothing_length=0.0)


def circle(radius: float, spacing: float, turn: float = math.pi) -> np.ndarray:
    angle = np.linspace(0.0, turn, math.ceil(abs(radius) * turn / spacing) + 1)
    return np.column_stack((abs(radius) * np.sin(angle), radius * (1 - np.cos(angle))))


def clothoid(rate: float, length: float, spacing: float = 1.0) -> np.ndarray:
    """Curvature grows from 0 by `rate` with each metre: x, y are Fresnel's integrals."""
    scale = math.sqrt(math.pi / rate)
    sine, cosine = fresnel(np.linspace(0.0, length, math.ceil(length / spacing) + 1) / scale)
    return scale * np.column_stack((cosine, sine))


def winding(seed: int = 3) -> ReferencePath:
    along = np.linspace(0.0, 300.0, 61)
    phase = np.random.default_rng(seed).uniform(0, math.tau, 2)
    return ReferencePath(np.column_stack((along, 8 * np.sin(along / 40 + phase[0]) + 3 * np.sin(along / 17 + phase[1]))))


def test_straight() -> None:
    path = ReferencePath([(10.0, 5.0), (40.0, 45.0), (70.0, 85.0)])
    assert path.length == pytest.approx(100.0, abs=1e-6)
    s = np.linspace(0, 100, 333)
    assert np.allclose(path.to_plane(s, 2.0), np.column_stack((10 + 0.6 * s - 1.6, 5 + 0.8 * s + 1.2)), atol=1e-6)
    assert np.allclose(path.heading(s), math.atan2(4, 3))
    assert np.allclose(path.curvature(s), 0, atol=1e-7)


@pytest.mark.parametrize("radius", [8.0, -8.0, 60.0])
@pytest.mark.parametrize("form", [EXACT, PathSettings()])
def test_circle(radius: float, form: PathSettings) -> None:
    path = ReferencePath(circle(radius, 0.5), form)
    close = 1e-6 if form is EXACT else 0.02
    assert path.length == pytest.approx(math.pi * abs(radius), abs=1e-4 if form is EXACT else 0.1)
    inner = np.linspace(3.0, path.length - 3.0, 200)
    assert np.allclose(path.curvature(inner), 1 / radius, rtol=5e-4 if form is EXACT else 0.05)
    place = path.to_plane(inner, 0.0) - (0.0, radius)
    assert np.allclose(np.hypot(*place.T), abs(radius), atol=close)
    if form is EXACT:
        assert np.allclose(path.heading(inner), inner / radius, atol=1e-5)
        assert np.allclose(path.curvature_rate(inner), 0.0, atol=5e-4)


def test_clothoid() -> None:
    rate = 0.002
    path = ReferencePath(clothoid(rate, 60.0, 0.5), EXACT)
    s = np.linspace(2.0, 58.0, 500)
    assert path.length == pytest.approx(60.0, abs=1e-4)
    assert np.allclose(path.curvature(s), rate * s, atol=2e-4)
    assert np.allclose(path.heading(s), rate * s * s / 2, atol=1e-5)
    assert np.allclose(path.curvature_rate(np.linspace(5, 55, 11)), rate, rtol=0.1)


def test_arc_length_is_the_parameter() -> None:
    path = winding()
    s = np.linspace(0, path.length, 20_001)
    steps = np.hypot(*np.diff(path.to_plane(s), axis=0).T) / np.diff(s)
    assert np.all(np.abs(steps - 1.0) < 1e-3)


def test_lines_of_maps_get_bounded_curvature_within_the_tolerance() -> None:
    """A right turn of 8 m as maps give it: a few points between two straights; interpolated it would swing to the other side."""
    arc = circle(-8.0, 3.0, math.pi / 2)
    points = np.vstack(((-60.0, 0.0), arc, np.add(arc[-1], (0.0, -60.0))))
    path = ReferencePath(points)
    curvature = path.tabulated.curvature
    assert -0.16 < curvature.min() < -0.11
    assert curvature.max() < 0.02
    assert np.max(np.abs(path.project(points, extend=True)[1])) <= PathSettings().tolerance + 0.01
    plain = ReferencePath(points, EXACT).tabulated.curvature
    assert plain.max() > 0.1


def test_noise_of_a_survey_is_smoothed() -> None:
    noise = np.random.default_rng(1).normal(0, 0.05, 101)
    path = ReferencePath(np.column_stack((np.linspace(0, 200, 101), noise)))
    assert np.abs(path.tabulated.curvature).max() < 0.01
    assert np.abs(ReferencePath(np.column_stack((np.linspace(0, 200, 101), noise)), EXACT).tabulated.curvature).max() > 0.02


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 20), st.integers(0, 10_000))
def test_there_and_back(seed: int, draw: int) -> None:
    path, dice = winding(seed), np.random.default_rng(draw)
    s, d = dice.uniform(0, path.length, 100), dice.uniform(-5, 5, 100)
    back = path.project(path.to_plane(s, d))
    assert np.allclose(back[0], s, atol=1e-5)
    assert np.allclose(back[1], d, atol=1e-5)


def test_projection_finds_the_nearest_point() -> None:
    path, dice = winding(), np.random.default_rng(5)
    points = np.column_stack((dice.uniform(-30, 330, 400), dice.uniform(-40, 40, 400)))
    s, d = path.project(points, extend=True)
    line = path.to_plane(np.linspace(0, path.length, 30_001))
    least = np.array([np.hypot(*(line - point).T).min() for point in points])
    inside = (s >= 0) & (s <= path.length)
    assert inside.sum() > 200
    assert np.allclose(np.abs(d[inside]), least[inside], atol=1e-3)


@settings(max_examples=200, deadline=None)
@given(
    st.floats(1, 280), st.floats(-4, 4), st.floats(-1.0, 1.0), st.floats(0, 30), st.floats(-6, 4), st.floats(-0.2, 0.2)
)  # fmt: skip
def test_motion_there_and_back(s: float, d: float, turned: float, speed: float, acceleration: float, curvature: float) -> None:
    path = winding()
    x, y = path.to_plane(s, d)[0]
    ego = EgoState(float(x), float(y), math.remainder(float(path.heading(s)) + turned, math.tau), speed, acceleration, curvature)
    again = path.ego_state(path.frenet_state(ego))
    assert (again.x, again.y, again.heading) == pytest.approx((ego.x, ego.y, ego.heading), abs=1e-5)
    assert (again.speed, again.curvature) == pytest.approx((speed, curvature), abs=1e-6)
    assert again.acceleration == pytest.approx(acceleration, abs=1e-6)


def test_motion_along_a_circle() -> None:
    """At offset d to the left of a left bend of radius R the station runs R / (R - d) times as fast."""
    path = ReferencePath(circle(50.0, 1.0), EXACT)
    x, y = path.to_plane(60.0, 4.0)[0]
    state = path.frenet_state(EgoState(float(x), float(y), 60.0 / 50.0, 10.0, 1.0, 1 / 46.0))
    assert (state.s, state.d) == pytest.approx((60.0, 4.0), abs=1e-4)
    assert (state.s_dot, state.s_ddot) == pytest.approx((10 * 50 / 46, 50 / 46), abs=1e-3)
    assert (state.d_dot, state.d_ddot) == pytest.approx((0.0, 0.0), abs=5e-3)


def test_outside_the_domain() -> None:
    path = ReferencePath([(0.0, 0.0), (100.0, 0.0)])
    for ask in (lambda: path.project([(50.0, 1.0), (-3.0, 1.0)]), lambda: path.to_plane([50.0, -3.0]), lambda: path.heading(-3.0)):
        with pytest.raises(OutsideDomain, match=r"-3\.00") as caught:
            ask()
        assert caught.value.station == pytest.approx(-3.0)
        assert isinstance(caught.value, RegdbRuntimeError)
    station, offset = path.project([(-3.0, 1.0), (104.0, -2.0)], extend=True)
    assert np.allclose(station, (-3.0, 104.0))
    assert np.allclose(offset, (1.0, -2.0))
    longer = path.extended(before=5.0, after=10.0)
    assert longer.start <= -5.0
    assert longer.end >= 110.0
    assert longer.length == path.length
    assert np.allclose(longer.to_plane([-3.0, 104.0], [1.0, -2.0]), [(-3.0, 1.0), (104.0, -2.0)])
    bend = ReferencePath(circle(10.0, 0.5), EXACT)
    with pytest.raises(OutsideDomain, match="centre of curvature") as caught:
        bend.to_plane(10.0, 10.5)
    assert caught.value.offset == pytest.approx(10.5)
    with pytest.raises(OutsideDomain, match="centre of curvature"):
        bend.project([(0.05, 10.0)])
    with pytest.raises(OutsideDomain, match="off the path"):
        path.frenet_state(EgoState(50.0, 0.0, math.pi, 5.0))


@pytest.mark.parametrize("points", [[], [(0.0, 0.0)], [(1.0, 1.0), (1.0, 1.0)], [(0.0, 0.0), (math.nan, 1.0)], [(0.0, 0.0, 0.0)] * 2])
def test_no_path(points: list[tuple[float, ...]]) -> None:
    with pytest.raises(ValueError, match="a path needs"):
        ReferencePath(points)


def test_repeated_points_and_far_origins() -> None:
    near = ReferencePath([(0.0, 0.0), (0.0, 0.0), (30.0, 1.0), (30.0, 1.0), (60.0, 0.0)])
    far = ReferencePath(np.add([(0.0, 0.0), (30.0, 1.0), (60.0, 0.0)], (500_000.0, 4_000_000.0)))
    assert near.length == pytest.approx(far.length, abs=1e-6)
    s, d = far.project(far.to_plane([10.0, 50.0], [3.0, -3.0]))
    assert np.allclose(s, (10.0, 50.0), atol=1e-5)
    assert np.allclose(d, (3.0, -3.0), atol=1e-5)


def test_the_import_is_light() -> None:
    """scipy.interpolate takes 0.4 s; only laying a path may ask for it."""
    code = "import sys, regdb_runtime.planning.lattice, regdb_runtime.planning.kinematic_limits; print('scipy.interpolate' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.strip() == "False"
