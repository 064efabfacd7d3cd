"""The emergency path: it brakes within one tick whatever else is broken, and hands the car back gently."""

import datetime

import numpy as np
import pytest
from regdb_runtime.errors import DatabaseDamaged
from regdb_runtime.maps.road_map import RoadMap
from regdb_runtime.observation import EgoState, Footprint, Observation, Track
from regdb_runtime.planner import EMERGENCY, Planner
from strategy_scenes import car, ego, law, route, seen, straight

CLOCK = datetime.datetime(2026, 3, 4, 12, 0)
WALL = Track("wall", "obstacle", 22.0, 0.0, 0.0, 0.0, 1.0, 3.0)
MOVING = EgoState(0.0, 0.0, 0.0, 15.0)


class Gone:
    """A database whose file is gone: whatever is asked of it raises."""

    def __getattr__(self, name: str) -> object:
        raise DatabaseDamaged(f"the database is gone ({name})")


def broken() -> Planner:
    """No law, an empty map, no route."""
    return Planner(Gone(), RoadMap({}), ("nowhere",))


def test_with_nothing_left_it_brakes_within_one_tick():
    decision = broken().step(Observation(0.0, CLOCK, MOVING, (WALL,), silent=frozenset(("perception",))))
    assert decision.state == EMERGENCY
    assert decision.flag == "emergency"
    assert decision.events == ("emergency",)
    assert decision.emergency.track == "wall"
    assert decision.trajectory.acceleration[0] < -6.0
    assert decision.trajectory.speed[-1] == 0.0


def test_without_an_emergency_a_broken_planner_brakes_comfortably_and_says_why():
    decision = broken().step(Observation(0.0, CLOCK, MOVING))
    assert decision.flag == "no_trajectory"
    assert decision.reason
    assert decision.trajectory.speed[-1] == 0.0
    assert decision.trajectory.acceleration.min() >= -3.0


def test_a_database_that_raises_leaves_the_last_plans_way():
    road = straight()
    decision = Planner(Gone(), road, route(road)).step(seen(ego(50.0)))
    assert decision.flag == "no_trajectory"
    assert "the database is gone" in decision.reason
    assert np.ptp(decision.trajectory.y) < 1e-9


@pytest.mark.parametrize("speed", [2.0, 8.0, 15.0, 30.0])
def test_an_emergency_brakes_at_every_speed(speed):
    wall = Track("wall", "obstacle", Footprint().front + 0.5 + 3.0 * 0.7, 0.0, 0.0, 0.0, 1.0, 3.0)
    decision = broken().step(Observation(0.0, CLOCK, EgoState(0.0, 0.0, 0.0, speed), (wall,)))
    assert decision.state == EMERGENCY
    assert decision.emergency.gap < max(3.0, speed * 0.3 + speed**2 / 13.0)


def test_the_emergency_ends_through_slowing_down():
    road = straight()
    planner = Planner(law(), road, route(road))
    states = []
    for tick in range(40):
        near = tick < 3
        tracks = (car("cut_in", 62.0, 2.0),) if near else ()
        decision = planner.step(seen(ego(50.0 + 0.5 * tick, 8.0), *tracks, time=round(0.1 * tick, 3)))
        states.append((decision.state, decision.steps, decision.events))
    assert states[0] == (EMERGENCY, (EMERGENCY,), ("emergency",))
    visited = list(dict.fromkeys(state for state, _, _ in states))
    assert visited == [EMERGENCY, "emergency_stop.slow_down", "lane_following.go_straight"]
    assert [events for _, _, events in states if "emergency_over" in events]


def test_a_check_that_fails_brakes():
    planner = broken()
    planner.brake.check = lambda *_: 1 / 0
    decision = planner.step(Observation(0.0, CLOCK, MOVING))
    assert decision.state == EMERGENCY
    assert "emergency check failed" in decision.reason
