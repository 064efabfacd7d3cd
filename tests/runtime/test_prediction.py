"""Where others will be: the intelligent driver model against its article, arcs, paths, records, and who may stray."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from regdb_runtime.maps.reference_path import ReferencePath
from regdb_runtime.observation import Track
from regdb_runtime.planning.idm import IdmParameters, desired_gap, idm_acceleration
from regdb_runtime.planning.prediction import ConstantVelocity, IdmPrediction, Recorded, Recording

TIME = np.arange(51) * 0.1
ARTICLE = IdmParameters(desired_speed=120 / 3.6, headway=1.6, jam_distance=2.0, acceleration=0.73, braking=1.67)
"""Table I of arXiv:cond-mat/0002177."""


def car(name: str, x: float, y: float = 0.0, speed: float = 0.0, heading: float = 0.0, **more: float) -> Track:
    return Track(name, "car", x, y, heading, speed, 4.8, 1.8, **more)


def test_on_a_free_road_the_model_speeds_up_to_its_desired_speed() -> None:
    assert idm_acceleration(0.0, math.inf, 0.0, ARTICLE) == pytest.approx(0.73)
    assert idm_acceleration(120 / 3.6, math.inf, 0.0, ARTICLE) == pytest.approx(0.0)
    assert idm_acceleration(60 / 3.6, math.inf, 0.0, ARTICLE) == pytest.approx(0.73 * (1 - 0.5**4))


def test_behind_another_the_model_follows_the_articles_equations() -> None:
    wanted = 2.0 + 20 * 1.6 + 20 * 5 / (2 * math.sqrt(0.73 * 1.67))
    assert desired_gap(20.0, 5.0, ARTICLE) == pytest.approx(wanted)
    assert idm_acceleration(20.0, 50.0, 5.0, ARTICLE) == pytest.approx(0.73 * (1 - (20 / (120 / 3.6)) ** 4 - (wanted / 50.0) ** 2))
    assert desired_gap(20.0, -50.0, ARTICLE) == 2.0, "one who runs away asks for the jam distance alone"


def test_the_equilibrium_gap_is_kept() -> None:
    """s_e(v) = (s0 + v T) / sqrt(1 - (v/v0)^delta): article, section II."""
    speed = 15.0
    gap = (2.0 + speed * 1.6) / math.sqrt(1 - (speed / ARTICLE.desired_speed) ** 4)
    assert idm_acceleration(speed, gap, 0.0, ARTICLE) == pytest.approx(0.0, abs=1e-12)


def test_the_answer_is_bounded_and_touching_means_braking() -> None:
    assert idm_acceleration(30.0, 1.0, 30.0, ARTICLE) == -ARTICLE.hardest_braking
    assert idm_acceleration(1.0, 0.0, 0.0, ARTICLE) == -ARTICLE.hardest_braking
    assert idm_acceleration(3.0, math.inf, 0.0, ARTICLE, 0.0) == -ARTICLE.hardest_braking


@given(st.floats(0, 40), st.floats(0, 200), st.floats(-20, 20))
def test_arrays_and_numbers_agree(speed: float, gap: float, closing: float) -> None:
    one = idm_acceleration(speed, gap, closing, ARTICLE)
    many = idm_acceleration(np.array([speed]), np.array([gap]), np.array([closing]), ARTICLE)
    assert many[0] == pytest.approx(one, rel=1e-12, abs=1e-12)


def test_constant_velocity_goes_straight_on_or_along_its_arc() -> None:
    found = ConstantVelocity().predict([car("a", 1.0, 2.0, 10.0, math.pi / 2), car("b", 0.0, 0.0, 8.0, yaw_rate=0.4)], TIME)
    assert found.y[0] == pytest.approx(2.0 + 10 * TIME)
    assert found.x[0] == pytest.approx(np.full(51, 1.0))
    radius, at = 8.0 / 0.4, found.time <= 2.0
    assert np.hypot(found.x[1][at], found.y[1][at] - radius) == pytest.approx(radius)
    assert found.heading[1][-1] == pytest.approx(0.8), "a yaw rate lasts two seconds"
    assert found.heading[1][10] == pytest.approx(0.4)
    steps = np.hypot(np.diff(found.x[1]), np.diff(found.y[1]))
    assert steps == pytest.approx(0.8, abs=1e-3)
    assert not found.reach.any()


def test_a_standing_user_with_a_yaw_rate_stays() -> None:
    found = ConstantVelocity().predict([car("a", 1.0, 2.0, 0.0, 0.3, yaw_rate=0.5)], TIME)
    assert np.ptp(found.x) == np.ptp(found.y) == np.ptp(found.heading) == 0.0


def test_nobody_is_predicted_where_nobody_is() -> None:
    for predictor in (ConstantVelocity(), IdmPrediction(), Recorded({})):
        assert len(predictor.predict([], TIME)) == 0


def test_a_follower_brakes_behind_its_leader_and_never_through_it() -> None:
    tracks = [car("last", -60.0, speed=15.0), car("middle", -20.0, speed=12.0), car("first", 0.0, speed=0.0), car("aside", -10.0, 4.0, 15.0)]
    found = IdmPrediction().predict(tracks, np.arange(151) * 0.1)
    assert np.all(found.x[2] == 0.0) or found.x[2][-1] > 0.0
    assert np.all(found.x[0] + 4.8 < found.x[1] + 1e-9)
    assert np.all(found.x[1] + 4.8 < found.x[2] + 1e-9)
    assert found.speed[1][-1] < 1.0
    assert found.x[3][-1] == pytest.approx(-10.0 + 15.0 * 15.0, abs=1.0), "who has nobody ahead goes on"


def test_one_who_comes_towards_us_is_no_leader_that_runs_away() -> None:
    found = IdmPrediction().predict([car("own", 0.0, speed=10.0), car("other", 60.0, speed=10.0, heading=math.pi)], TIME)
    assert found.speed[0][-1] < 7.0


def test_a_vehicle_keeps_to_its_path_and_goes_on_straight_beyond() -> None:
    angles = np.linspace(0.0, math.pi / 2, 60)
    arc = np.stack((30 * np.sin(angles), 30 - 30 * np.cos(angles)), axis=1)
    found = IdmPrediction(paths={"a": ReferencePath(arc)}, desired_speeds={"a": 12.0}).predict([car("a", 0.0, 0.0, 12.0)], TIME)
    on_arc = found.time < 30 * math.pi / 2 / 12.0
    assert np.hypot(found.x[0][on_arc], found.y[0][on_arc] - 30.0) == pytest.approx(30.0, abs=0.02)
    assert found.heading[0][-1] == pytest.approx(math.pi / 2, abs=0.01)
    assert found.y[0][-1] > 40.0
    assert np.abs(found.x[0][~on_arc] - 30.0).max() < 0.2


def test_walkers_may_stray_a_little_and_others_not() -> None:
    walker = Track("w", "pedestrian", 0.0, 0.0, 0.0, 1.4, 0.5, 0.5)
    found = ConstantVelocity().predict([walker, car("c", 5.0)], TIME)
    assert found.reach[0] == pytest.approx(np.minimum(0.1 + 0.3 * TIME, 0.6))
    assert not found.reach[1].any()
    assert found.x[0] == pytest.approx(1.4 * TIME)


def test_a_record_is_followed_from_now_to_its_end() -> None:
    time = np.arange(0.0, 4.01, 0.5)
    record = Recording(time, 3 * time, time * 0, np.zeros_like(time), np.full_like(time, 3.0))
    known = replace(Recorded({"a": record}), now=1.0)
    found = known.predict([car("a", 3.0, speed=99.0), car("b", 0.0, 5.0, 2.0)], TIME)
    assert found.x[0] == pytest.approx(3.0 + 3.0 * TIME), "on beyond the record's end at its last speed"
    assert found.speed[0] == pytest.approx(np.full(51, 3.0))
    assert found.x[1] == pytest.approx(2.0 * TIME)
    assert known.at(2.0).predict([car("a", 0.0)], TIME).x[0][0] == pytest.approx(6.0)


def test_the_same_input_gives_the_same_bytes() -> None:
    dice = np.random.default_rng(3)
    tracks = [car(str(i), *dice.uniform(-50, 50, 2), speed=float(dice.uniform(0, 15)), heading=float(dice.uniform(-3, 3))) for i in range(12)]
    for predictor in (ConstantVelocity(), IdmPrediction()):
        one, two = predictor.predict(tracks, TIME), predictor.predict(list(tracks), TIME.copy())
        assert all(getattr(one, name).tobytes() == getattr(two, name).tobytes() for name in ("x", "y", "heading", "speed", "reach"))
    assert one.row("3") == 3
    with pytest.raises(KeyError):
        one.row("nobody")
