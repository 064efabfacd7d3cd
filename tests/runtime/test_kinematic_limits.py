"""What each failing plan fails, by how much, and what is excused."""

import numpy as np
import pytest
from regdb_runtime.observation import Footprint
from regdb_runtime.planning.goal import Follow, Goal, SpeedCap, StopPoint
from regdb_runtime.planning.kinematic_limits import REASONS, UNITS, check
from regdb_runtime.planning.settings import VehicleLimits
from regdb_runtime.trajectory import Candidates

TIME = np.arange(51) * 0.1
FRONT = Footprint().front
LIMITS = VehicleLimits(acceleration=3.0, braking=5.0, jerk=10.0)


def plans(speed: np.ndarray, curvature: np.ndarray | None = None) -> Candidates:
    """Straight plans from speeds (n, 51)."""
    speed = np.atleast_2d(speed).astype(float)
    station = np.concatenate((np.zeros((len(speed), 1)), np.cumsum((speed[:, 1:] + speed[:, :-1]) / 2 * 0.1, axis=1)), axis=1)
    rate = np.gradient(speed, 0.1, axis=1)
    jerk = np.diff(rate, axis=1, append=rate[:, -1:]) / 0.1
    zero = np.zeros_like(speed)
    return Candidates(TIME, station, zero, zero, speed, rate, jerk, zero if curvature is None else curvature, station, zero)


def test_reasons_have_units() -> None:
    assert set(REASONS) == set(UNITS)


@pytest.mark.parametrize(
    ("reason", "speed", "value"),
    [("speed", 10 + 0 * TIME + 45 * (TIME / 5), 55.0), ("acceleration", 3.5 * TIME, 3.5), ("braking", 30 - 5.5 * TIME, 5.5)],
)
def test_limits_of_the_vehicle(reason: str, speed: np.ndarray, value: float) -> None:
    limits = VehicleLimits(acceleration=3.0 if reason != "speed" else 99.0, braking=5.0, settle=0.1)
    found = check(plans(np.stack((np.full(51, speed[0]), speed))), limits) if reason == "speed" else check(plans(speed), limits)
    assert not found.ok[-1]
    assert found.first_reason[-1] == reason
    assert found.counts == {reason: 1}
    assert found.measured[-1] == pytest.approx(value, rel=1e-6)
    assert found.bound[-1] == getattr(limits, reason)


def test_bends() -> None:
    speed = np.full((4, 51), 10.0)
    rising = np.outer([0.0, 0.19, 0.25, 0.08], np.minimum(TIME / 4, 1.0))
    found = check(plans(speed, rising), VehicleLimits(yaw_rate=1.5, lateral_acceleration=7.0))
    assert found.first_reason.tolist() == ["", "yaw_rate", "curvature", "lateral_acceleration"]
    assert found.counts == {"curvature": 1, "yaw_rate": 1, "lateral_acceleration": 1}
    assert found.measured[3] == pytest.approx(8.0)
    assert found.bound[3] == 7.0
    assert np.isnan(found.measured[0])
    sudden = np.where(TIME < 1, 0.0, 0.1)[None]
    assert check(plans(np.full(51, 3.0), sudden), VehicleLimits()).first_reason[0] == "curvature_rate"


def test_a_start_beyond_a_limit_may_come_back() -> None:
    speed = 20 - np.where(TIME < 0.3, 6.0 * TIME, 1.8 + 3 * (TIME - 0.3))
    candidates = plans(np.stack((speed, 20 - 6 * TIME / 2 - 2.9 * TIME)))
    limits = VehicleLimits(braking=5.0, jerk=1000.0)
    found = check(candidates, limits)
    assert found.ok.tolist() == [True, False] or found.first_reason[1] == "braking"
    assert found.ok[0]


def test_a_cap_binds_at_the_front_bumper() -> None:
    cap = SpeedCap(20.0, 100.0, 11.0, "22352")
    slow = np.maximum(13 - 2 * np.maximum(TIME - 0.1, 0), 11.0)
    found = check(plans(np.stack((slow, np.full(51, 13.0)))), LIMITS, Goal(cruise_speed=30.0, caps=(cap,)))
    reached = FRONT + np.cumsum(slow)[9] / 10
    assert reached < 20.0
    assert found.ok.tolist() == [True, False]
    assert found.first_reason[1] == "speed_cap"
    assert (found.measured[1], found.bound[1], found.rules[1]) == (13.0, 11.0, "22352")
    assert not found.late


def test_the_end_must_be_in_time_for_what_comes() -> None:
    goal = Goal(cruise_speed=30.0, caps=(SpeedCap(90.0, 500.0, 5.0, "zone"),))
    found = check(plans(np.stack((np.full(51, 16.0), np.linspace(16, 8, 51)))), LIMITS, goal)
    assert found.ok.tolist() == [False, True]
    assert found.first_reason[0] == "cap_ahead"
    found = check(plans(np.stack((np.full(51, 16.0), np.linspace(16, 2, 51)))), LIMITS, Goal(cruise_speed=30.0, stop=StopPoint(90.0, "line")))
    assert found.first_reason.tolist() == ["stop_ahead", ""]


def test_over_the_cap_already_one_comes_down() -> None:
    goal = Goal(cruise_speed=30.0, caps=(SpeedCap(-50.0, 500.0, 12.0, "22349"),))
    candidates = plans(np.stack((np.full(51, 14.0), np.maximum(14 - 1.2 * TIME, 12.0))))
    found = check(candidates, LIMITS, goal)
    assert found.ok.tolist() == [False, True]
    assert found.late == ("22349",)


def test_a_cap_seen_too_late_asks_for_all_that_can_be_done() -> None:
    goal = Goal(cruise_speed=30.0, caps=(SpeedCap(FRONT + 5.0, 500.0, 5.0, "zone"),))
    hard = np.maximum(20 - 7.5 * np.maximum(TIME - 0.2, 0), 5.0)
    candidates = plans(np.stack((hard, np.maximum(20 - 3 * TIME, 5.0))))
    found = check(candidates, VehicleLimits(jerk=1000.0), goal)
    assert found.ok.tolist() == [True, False]
    assert found.late == ("zone",)
    assert not check(candidates, VehicleLimits.comfortable(), goal).ok.any()


def test_stop_and_leader() -> None:
    speed = np.stack((np.full(51, 8.0), np.maximum(8 - 2 * TIME, 0.0)))
    found = check(plans(speed), LIMITS, Goal(cruise_speed=30.0, stop=StopPoint(FRONT + 20.0, "22450")))
    assert found.ok.tolist() == [False, True]
    assert (found.first_reason[0], found.rules[0]) == ("stop", "22450")
    assert found.measured[0] == pytest.approx(FRONT + 40.0)
    assert found.bound[0] == pytest.approx(FRONT + 20.0)
    found = check(plans(speed), LIMITS, Goal(cruise_speed=30.0, follow=Follow("a", FRONT + 20.0, 2.0)))
    assert found.first_reason.tolist() == ["leader", ""]
    found = check(plans(speed), LIMITS, Goal(cruise_speed=30.0, follow=Follow("a", FRONT + 41.0, 0.0)))
    assert found.first_reason.tolist() == ["leader_ahead", ""]
    assert check(plans(speed), LIMITS, Goal(cruise_speed=30.0, follow=Follow("beside", FRONT - 1.0, 0.0))).ok.all()


def test_cruise_is_a_wish_with_a_way_back() -> None:
    found = check(plans(np.stack((8 + 0.5 * TIME, 8 + 0 * TIME))), LIMITS, Goal(cruise_speed=9.0))
    assert found.first_reason.tolist() == ["cruise", ""]
    found = check(plans(np.stack((8 + 0 * TIME, np.maximum(8 - 1.5 * TIME, 6.0)))), LIMITS, Goal(cruise_speed=6.0))
    assert found.first_reason.tolist() == ["cruise", ""]


def test_no_plans() -> None:
    found = check(plans(np.empty((0, 51))), LIMITS, Goal(caps=(SpeedCap(0, 1, 1, "x"),), stop=StopPoint(1.0, "y")))
    assert len(found.ok) == 0
    assert found.counts == {}
