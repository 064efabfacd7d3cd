"""Planning anew at 10 Hz with ideal tracking: one stop, no creeping, limits reached by the boundary, no drift."""

import numpy as np
import pytest
from closed_loop import FOOTPRINT, drive
from regdb_runtime.maps.reference_path import ReferencePath
from regdb_runtime.planning.goal import Follow, Goal, SpeedCap, StopPoint
from regdb_runtime.trajectory import FrenetState

MPH = 0.44704
LINE = np.linspace(0.0, 400.0, 101)
PATHS = [ReferencePath([(0.0, 0.0), (400.0, 0.0)]), ReferencePath(np.column_stack((LINE, 10 * np.sin(LINE / 30))))]
LIMIT = SpeedCap(-10.0, 500.0, 35 * MPH, "22349")
both_paths = pytest.mark.parametrize("path", PATHS, ids=["straight", "bent"])
tempers = pytest.mark.parametrize("progress", [0.3, 1.0, 3.0])


@both_paths
@tempers
def test_comes_to_rest_once_before_the_line(path: ReferencePath, progress: float) -> None:
    goal = Goal(cruise_speed=35 * MPH, caps=(LIMIT,), stop=StopPoint(130.0, "line"))
    found = drive(path, path.ego_state(FrenetState(10.0, 34.7 * MPH)), lambda _time, _bumper: goal, 25.0, progress)
    assert found.hard == 0
    assert np.abs(found.acceleration[1:]).max() <= 2.0
    assert np.abs(found.jerk).max() <= 4.13
    assert np.all(np.diff(found.speed[np.argmax(found.speed) :]) <= 1e-3)  # never speeds up again
    first = int(np.argmax(found.speed < 0.1))
    assert 128.0 <= found.bumper[first] <= 130.0
    assert np.all(found.speed[first:] < 0.1)
    assert found.bumper[-1] - found.bumper[first] < 0.05
    assert np.all(found.speed[-20:] < 1e-4)


@both_paths
@tempers
def test_35_to_25_by_the_boundary(path: ReferencePath, progress: float) -> None:
    goal = Goal(cruise_speed=35 * MPH, caps=(SpeedCap(-10.0, 150.0, 35 * MPH, "22349"), SpeedCap(150.0, 500.0, 25 * MPH, "22352")))
    found = drive(path, path.ego_state(FrenetState(10.0, 34.7 * MPH)), lambda _time, _bumper: goal, 18.0, progress)
    assert found.hard == 0
    assert found.speed.max() <= 35 * MPH
    assert found.speed[found.bumper >= 150.0].max() <= 25 * MPH
    assert found.speed[-1] == pytest.approx(25 * MPH, abs=0.15)
    assert np.abs(found.acceleration).max() <= 2.0
    assert np.abs(found.jerk).max() <= 4.13


@both_paths
def test_cruises_without_drift(path: ReferencePath) -> None:
    found = drive(path, path.ego_state(FrenetState(10.0, 13.0)), lambda _time, _bumper: Goal(cruise_speed=13.0, caps=(LIMIT,)), 20.0)
    assert np.abs(found.speed - 13.0).max() < 1e-3
    assert np.abs(found.offsets).max() < 1e-3


@both_paths
def test_starts_and_reaches_its_speed(path: ReferencePath) -> None:
    found = drive(path, path.ego_state(FrenetState(10.0, 0.0)), lambda _time, _bumper: Goal(cruise_speed=13.0, caps=(LIMIT,)), 18.0)
    assert found.hard == 0
    assert found.speed[-1] == pytest.approx(13.0, abs=0.06)
    assert found.speed.max() < 13.06
    assert np.abs(found.acceleration).max() <= 2.0
    assert np.abs(found.jerk).max() <= 4.13


@both_paths
def test_stops_from_a_stand_farther_back(path: ReferencePath) -> None:
    goal = Goal(cruise_speed=35 * MPH, caps=(LIMIT,), stop=StopPoint(30.0, "line"))
    found = drive(path, path.ego_state(FrenetState(10.0, 0.0)), lambda _time, _bumper: goal, 20.0)
    assert found.hard == 0
    assert 28.0 <= found.bumper[-1] <= 30.0
    assert found.speed[-1] < 1e-4


@both_paths
def test_a_line_seen_late_is_still_kept(path: ReferencePath) -> None:
    """42 m at 35 mph: over the comfortable braking, within what the car can do."""
    goal = Goal(cruise_speed=35 * MPH, caps=(LIMIT,), stop=StopPoint(10.0 + FOOTPRINT.front + 42.0, "line"))
    found = drive(path, path.ego_state(FrenetState(10.0, 34.7 * MPH)), lambda _time, _bumper: goal, 15.0)
    assert found.hard > 0
    assert found.bumper.max() <= 10.0 + FOOTPRINT.front + 42.0
    assert found.speed[-1] < 1e-4
    assert found.acceleration.min() > -6.0


@both_paths
def test_settles_behind_a_leader(path: ReferencePath) -> None:
    def goal(time: float, _bumper: float) -> Goal:
        return Goal(cruise_speed=13.0, caps=(LIMIT,), follow=Follow("lead", 70.0 + 6.0 * time, 6.0))

    found = drive(path, path.ego_state(FrenetState(10.0, 13.0)), goal, 25.0)
    rear = 70.0 + 6.0 * 0.1 * np.arange(len(found.bumper))
    assert found.hard == 0
    assert (rear - found.bumper).min() > 0.0
    assert found.speed[-1] == pytest.approx(6.0, abs=0.1)


@both_paths
def test_changes_lane_and_stays(path: ReferencePath) -> None:
    goal = Goal(offsets=(3.5,), cruise_speed=12.0, caps=(LIMIT,))
    found = drive(path, path.ego_state(FrenetState(10.0, 12.0)), lambda _time, _bumper: goal, 12.0)
    assert found.hard == 0
    assert found.offsets[-1] == pytest.approx(3.5, abs=0.05)
    assert max(found.offsets) < 3.6
