"""From one plan to the next, and braking along the last one."""

import math
from dataclasses import replace

import numpy as np
import pytest
from regdb_runtime.emergency import EmergencySettings, full_braking
from regdb_runtime.observation import EgoState
from regdb_runtime.strategy.continuation import TrackingSettings, braking_along, expected, starting_state
from regdb_runtime.trajectory import Trajectory

SETTINGS = TrackingSettings()


def plan(speed: float = 10.0, curvature: float = 0.02) -> Trajectory:
    """An arc at constant speed for 5 s."""
    time = np.arange(51) * 0.1
    way = speed * time
    turn = curvature * way
    same = np.full_like(time, 1.0)
    return Trajectory(
        time, np.sin(turn) / curvature, (1 - np.cos(turn)) / curvature, turn, speed * same, 0 * same, 0 * same, curvature * same, way, 0 * same
    )  # fmt: skip


def test_the_next_plan_begins_in_the_last_one_while_the_vehicle_keeps_to_it():
    there = expected(plan(), 0.5)
    near = replace(there, x=there.x + 0.2, speed=there.speed - 0.3)
    begun = starting_state(near, plan(), 0.5, SETTINGS)
    assert (begun.x, begun.y, begun.speed) == (there.x, there.y, there.speed)


@pytest.mark.parametrize("change", [{"x": 0.5}, {"y": -0.4}, {"speed": 1.0}, {"heading": 0.1}])
def test_a_vehicle_off_its_plan_is_planned_for_from_where_it_is(change):
    there = expected(plan(), 0.5)
    off = replace(there, **{name: getattr(there, name) + value for name, value in change.items()})
    assert starting_state(off, plan(), 0.5, SETTINGS) is off


def test_without_a_plan_or_beyond_it_the_measurement_counts():
    ego = EgoState(1.0, 2.0, 0.3, 4.0)
    assert starting_state(ego, None, 0.0, SETTINGS) is ego
    assert starting_state(ego, plan(), 9.0, SETTINGS) is ego


def test_braking_stays_on_the_last_plans_way_and_ends_standing():
    ego = expected(plan(), 1.0)
    found = braking_along(ego, plan(), 1.0, SETTINGS)
    radius = np.hypot(found.x, found.y - 50.0)
    assert radius == pytest.approx(50.0, abs=0.01)
    assert found.speed[-1] == 0.0
    assert np.all(np.diff(found.speed) <= 1e-9)
    assert found.acceleration.min() >= -SETTINGS.braking
    assert found.station[0] == pytest.approx(10.0)
    way = np.hypot(np.diff(found.x), np.diff(found.y)).sum()
    assert 10.0**2 / (2 * SETTINGS.braking) < way < 10.0**2 / (2 * SETTINGS.braking) + 10.0 * SETTINGS.braking / SETTINGS.jerk


def test_braking_goes_straight_on_where_the_plan_ends():
    ego = replace(expected(plan(30.0, 0.001), 4.9), acceleration=0.0)
    found = braking_along(ego, plan(30.0, 0.001), 4.9, SETTINGS)
    assert np.hypot(found.x[-1] - found.x[0], found.y[-1] - found.y[0]) > 30.0**2 / (2 * SETTINGS.braking) - 1.0
    assert found.curvature[-1] == 0.0
    assert found.heading[-1] == pytest.approx(0.15, abs=1e-6)


def test_braking_without_a_plan_follows_the_present_curvature():
    ego = EgoState(0.0, 0.0, math.pi / 2, 8.0, 0.0, 0.05)
    found = braking_along(ego, None, 0.0, SETTINGS)
    assert np.hypot(found.x + 20.0, found.y) == pytest.approx(20.0, abs=1e-6)
    assert found.time[0] == 0.0


def test_a_standing_vehicle_stays_where_it_is():
    ego = EgoState(3.0, 4.0, 0.0, 0.0)
    for found in (braking_along(ego, plan(), 0.0, SETTINGS), full_braking(ego, EmergencySettings())):
        assert np.ptp(found.x) == 0.0
        assert np.all(found.speed == 0.0)
