"""Rectangles: known distances, and overlap and distance against dense sampling of the rectangles themselves."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from regdb_runtime.geometry import Boxes, boxes, distance, overlap

CAR = (4.8, 1.8)


def box(x: float, y: float, heading: float, length: float = CAR[0], width: float = CAR[1]) -> Boxes:
    return boxes(x, y, heading, length, width)


@pytest.mark.parametrize(
    ("other", "apart"),
    [
        (box(0, 3.0, 0), 1.2),
        (box(10, 0, 0), 5.2),
        (box(10, 0, math.pi / 2), 10 - 2.4 - 0.9),
        (box(7.8, 5.8, 0), math.hypot(3.0, 4.0)),
        (box(0, 5.0, math.pi / 4), 5.0 - 0.9 - (2.4 + 0.9) / math.sqrt(2)),
        (box(0, 0, 1.0), 0.0),
        (box(4.8, 0, 0), 0.0),
    ],
    ids=["beside", "ahead", "across", "corner to corner", "corner to side", "through", "touching"],
)
def test_distance_is_between_the_nearest_parts(other: Boxes, apart: float) -> None:
    own = box(0, 0, 0)
    assert distance(own, other) == pytest.approx(apart, abs=1e-12)
    assert distance(other, own) == pytest.approx(apart, abs=1e-12)
    assert bool(overlap(own, other)) == (apart == 0.0)


def test_a_pole_between_the_corners_is_inside() -> None:
    assert overlap(box(0, 0, 0.7), box(0.1, 0.1, 2.0, 0.05, 0.05))
    assert distance(box(0, 0, 0.7), box(0.1, 0.1, 2.0, 0.05, 0.05)) == 0.0


def test_shapes_broadcast_plans_road_users_and_instants() -> None:
    dice = np.random.default_rng(1)
    plans = boxes(dice.uniform(-20, 20, (5, 1, 7)), dice.uniform(-20, 20, (5, 1, 7)), dice.uniform(-4, 4, (5, 1, 7)), *CAR)
    users = boxes(dice.uniform(-20, 20, (3, 7)), dice.uniform(-20, 20, (3, 7)), dice.uniform(-4, 4, (3, 7)), 2.0, 0.6)
    apart = distance(plans, users)
    assert apart.shape == (5, 3, 7)
    for n, m, t in ((0, 0, 0), (4, 2, 6), (2, 1, 3)):
        assert apart[n, m, t] == distance(plans[n, 0, t], users[m, t])


places = st.floats(-8, 8)
turns = st.floats(-math.pi, math.pi)
sizes = st.floats(0.05, 6)


def filled(shape: Boxes, steps: int = 61) -> np.ndarray:
    """A grid of points that fills a rectangle, its edges included."""
    one = np.linspace(-1, 1, steps)
    ahead, aside = (part.ravel() for part in np.meshgrid(one * shape.half_length, one * shape.half_width))
    return np.stack((shape.x + ahead * shape.cos - aside * shape.sin, shape.y + ahead * shape.sin + aside * shape.cos), axis=1)


def to_filled(points: np.ndarray, shape: Boxes) -> np.ndarray:
    """Distance of points to a filled rectangle, by its definition in the rectangle's own axes."""
    dx, dy = points[:, 0] - shape.x, points[:, 1] - shape.y
    along, across = np.abs(dx * shape.cos + dy * shape.sin), np.abs(dy * shape.cos - dx * shape.sin)
    return np.hypot(np.clip(along - shape.half_length, 0, None), np.clip(across - shape.half_width, 0, None))


@given(places, places, turns, sizes, sizes, turns, sizes, sizes)
def test_distance_agrees_with_dense_sampling(
    x: float, y: float, a_turn: float, a_long: float, a_wide: float, b_turn: float, b_long: float, b_wide: float
) -> None:
    a, b = box(0, 0, a_turn, a_long, a_wide), box(x, y, b_turn, b_long, b_wide)
    sampled = float(to_filled(filled(a), b).min())
    spacing = math.hypot(a_long, a_wide) / 60
    exact = float(distance(a, b))
    assert exact <= sampled + 1e-9
    assert exact >= sampled - spacing
    assert exact == pytest.approx(float(distance(b, a)), abs=1e-9)
    if sampled == 0.0:
        assert overlap(a, b)
    if overlap(a, b):
        assert sampled <= spacing


@given(places, places, turns, sizes, sizes, st.floats(0, 2))
def test_a_grown_box_holds_all_within_its_margin(x: float, y: float, turn: float, long: float, wide: float, margin: float) -> None:
    a, b = box(0, 0, 0.3), box(x, y, turn, long, wide)
    if distance(a, b) < margin - 1e-9:
        assert overlap(a.grown(margin), b)

