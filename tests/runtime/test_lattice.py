"""What is sampled: exact starts, plans that are what they say by differences, stops, caps and leaders kept."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from regdb_runtime.maps.reference_path import ReferencePath
from regdb_runtime.observation import Footprint
from regdb_runtime.planning.goal import Follow, Goal, SpeedCap, StopPoint
from regdb_runtime.planning.kinematic_limits import Feasibility, check
from regdb_runtime.planning.lattice import Workspace, sample
from regdb_runtime.planning.settings import LatticeSettings, VehicleLimits
from regdb_runtime.trajectory import Candidates, FrenetState

MPH = 0.44704
FRONT = Footprint().front
ALONG = np.linspace(0.0, 400.0, 101)
STRAIGHT = ReferencePath([(0.0, 0.0), (400.0, 0.0)])
BENT = ReferencePath(np.column_stack((ALONG, 10 * np.sin(ALONG / 30))))
PATHS = st.sampled_from([STRAIGHT, BENT])
STARTS = st.builds(
    FrenetState, s=st.floats(5, 60), s_dot=st.floats(0, 20), s_ddot=st.floats(-1.5, 1.5), d=st.floats(-1.5, 1.5),
    d_prime=st.floats(-0.05, 0.05), d_double_prime=st.floats(-0.01, 0.01),
)  # fmt: skip


def planned(path: ReferencePath, start: FrenetState, goal: Goal, limits: VehicleLimits | None = None) -> tuple[Candidates, Feasibility]:
    plans = sample(path, start, goal)
    return plans, check(plans, limits or VehicleLimits.comfortable(), goal)


@settings(max_examples=60, deadline=None)
@given(PATHS, STARTS)
def test_every_plan_starts_in_the_start_state(path: ReferencePath, start: FrenetState) -> None:
    plans = sample(path, start, Goal(offsets=(0.0, 3.5), cruise_speed=18.0))
    ego = path.ego_state(start)
    assert len(plans) >= 12  # all but braking on may be out of reach at a walk
    assert plans.time[0] == 0.0
    assert plans.time[-1] == pytest.approx(5.0)
    for row, value in ((plans.x, ego.x), (plans.y, ego.y), (plans.speed, ego.speed)):
        assert np.allclose(row[:, 0], value, atol=1e-6)
    stands = start.s_dot <= 1e-3 and start.s_ddot < 0  # brakes that hold it accelerate nothing
    assert np.allclose(plans.acceleration[:, 0], 0.0 if stands else ego.acceleration, atol=1e-6)
    assert np.allclose(np.sin((plans.heading[:, 0] - ego.heading) / 2), 0.0, atol=1e-7)
    assert np.allclose(plans.curvature[:, 0], ego.curvature, atol=1e-6)
    assert np.allclose(plans.station[:, 0], start.s)
    assert np.allclose(plans.offset[:, 0], start.d)
    assert np.all(np.diff(plans.station, axis=1) >= -1e-5)
    assert np.all(plans.speed >= 0.0)


@settings(max_examples=40, deadline=None)
@given(PATHS, STARTS, st.sampled_from([VehicleLimits(), VehicleLimits.comfortable()]))
def test_plans_within_limits_are_so_by_differences_of_their_places(path: ReferencePath, start: FrenetState, limits: VehicleLimits) -> None:
    assume(start.s_dot > 1.0)
    plans, found = planned(path, start, Goal(offsets=(0.0,), cruise_speed=20.0), limits)
    x, y, step = plans.x[found.ok], plans.y[found.ok], 0.1
    assume(len(x))
    middle_speed = np.hypot(np.diff(x), np.diff(y)) / step  # chords: shorter than the arc by at most (0.2 m)^2-th parts
    speed = plans.speed[found.ok]
    assert np.allclose(middle_speed, (speed[:, 1:] + speed[:, :-1]) / 2, atol=0.03)
    rate = np.diff(middle_speed) / step
    settled = slice(5, None)
    assert rate[:, settled].max(initial=0.0) <= limits.acceleration + 0.1
    assert rate[:, settled].min(initial=0.0) >= -limits.braking - 0.1
    heading = plans.heading[found.ok]
    assert np.abs(np.diff(heading)).max() / step <= limits.yaw_rate + 0.02
    moving = middle_speed > 0.5
    direction = np.arctan2(np.diff(y), np.diff(x))
    assert np.abs(np.sin(direction - (heading[:, 1:] + heading[:, :-1]) / 2))[moving].max(initial=0.0) < 0.01
    way = np.maximum(middle_speed * step, 1e-9)
    assert np.abs(np.diff(heading) / way)[moving].max(initial=0.0) <= limits.curvature + 0.01


@settings(max_examples=80, deadline=None)
@given(PATHS, STARTS, st.floats(40, 160))
def test_stops_end_at_rest_before_the_line(path: ReferencePath, start: FrenetState, way: float) -> None:
    """By the front bumper 0 to 2 m before the line, at rest to the end; and no plan that passes goes over it."""
    assume(start.s_dot > 1.0 and 1.2 * start.s_dot**2 / 2 < way - FRONT)
    stop = StopPoint(start.s + way, "line")
    plans = sample(path, start, Goal(cruise_speed=20.0, stop=stop), settings=LatticeSettings(horizon=40.0))
    found = check(plans, VehicleLimits.comfortable(), Goal(cruise_speed=20.0, stop=stop))
    bumper = plans.station + FRONT
    assert np.all(bumper[found.ok] <= stop.station)
    at_line = (plans.speed[:, -1] < 1e-6) & (np.abs(bumper[:, -1] - stop.station + stop.margin) < 0.02)
    assert (found.ok & at_line).any()
    for row in np.flatnonzero(at_line):
        standing = plans.speed[row] == 0.0
        first = int(np.argmax(standing))
        assert standing[-1]
        assert standing[first:].all()
        assert np.ptp(plans.x[row, first:]) < 1e-3


@settings(max_examples=80, deadline=None)
@given(PATHS, STARTS, st.floats(20, 150), st.sampled_from([15 * MPH, 20 * MPH, 25 * MPH]))
def test_no_plan_that_is_ok_passes_a_cap(path: ReferencePath, start: FrenetState, way: float, low: float) -> None:
    caps = (SpeedCap(-100.0, start.s + way, 45 * MPH, "now"), SpeedCap(start.s + way, 1000.0, low, "then"))
    plans, found = planned(path, start, Goal(cruise_speed=30.0, caps=caps))
    assume(start.s_dot < 44 * MPH and not found.late)
    bumper = plans.station + FRONT
    for cap in caps:
        within = (bumper >= cap.start) & (bumper < cap.end) & found.ok[:, None]
        within[:, 0] = False
        assert plans.speed[within].max(initial=0.0) <= cap.speed + 1e-5


@pytest.mark.parametrize("path", [STRAIGHT, BENT])
@pytest.mark.parametrize("way", [45.0, 60.0, 90.0, 200.0])
def test_from_35_to_25_mph_by_the_boundary(path: ReferencePath, way: float) -> None:
    """Within the figure's bounds: 2 m/s^2 and 4.13 m/s^3; the boundary may lie beyond the horizon."""
    start = FrenetState(20.0, 34.5 * MPH)
    boundary = start.s + FRONT + way
    caps = (SpeedCap(0.0, boundary, 35 * MPH, "35"), SpeedCap(boundary, 1000.0, 25 * MPH, "25"))
    goal = Goal(cruise_speed=35 * MPH, caps=caps)
    plans = sample(path, start, goal, settings=LatticeSettings(horizon=20.0))
    found = check(plans, VehicleLimits.comfortable(), goal)
    bumper = plans.station[found.ok] + FRONT
    speed = plans.speed[found.ok]
    reached = bumper[:, -1] > boundary
    assert reached.any()
    assert speed[reached].max(axis=1).max() > 34 * MPH  # the fastest of them brakes no earlier than it must
    assert (speed[reached][:, -1] > 24.5 * MPH).any()
    assert np.abs(plans.acceleration[found.ok]).max() <= 2.0 + 1e-6
    assert np.abs(plans.jerk[found.ok]).max() <= 4.13 + 1e-6
    assert speed[bumper >= boundary].max() <= 25 * MPH + 1e-6


def test_a_boundary_beyond_the_horizon_binds() -> None:
    """A stop 100 m ahead of 35 mph: 78 m of horizon do not reach it, yet no plan may go on as before."""
    start = FrenetState(20.0, 15.5)
    goal = Goal(cruise_speed=15.6, stop=StopPoint(120.0, "line"))
    plans, found = planned(STRAIGHT, start, goal)
    assert found.ok.any()
    left = 120.0 - FRONT - plans.station[found.ok][:, -1]
    assert np.all(plans.speed[found.ok][:, -1] ** 2 <= 2 * 2.0 * left)
    assert plans.speed[found.ok][:, -1].max() < 15.0


def test_standing_and_starting() -> None:
    stand = FrenetState(20.0, 0.0, d=0.4, d_prime=0.03)
    held = StopPoint(20.0 + FRONT + 1.0, "line")
    plans = sample(STRAIGHT, stand, Goal(stop=held))
    assert len(plans)
    assert np.all(plans.speed == 0.0)
    assert np.ptp(plans.x) == 0.0
    assert np.all(plans.acceleration == 0.0)
    assert np.allclose(plans.heading, np.arctan(0.03))
    plans, found = planned(STRAIGHT, stand, Goal(cruise_speed=15.0))
    assert plans.speed[found.ok][:, -1].max() > 4.0
    assert (plans.speed[:, -1] == 0.0).any()
    assert np.abs(plans.curvature[found.ok]).max() < 0.2
    plans, found = planned(STRAIGHT, stand, Goal(cruise_speed=15.0, stop=StopPoint(20.0 + FRONT + 12.0, "line")))
    aimed = (plans.station[:, -1] + FRONT > 20.0 + FRONT + 3.0) & found.ok
    assert aimed.any()


def test_past_the_line_nothing_but_stopping() -> None:
    plans = sample(STRAIGHT, FrenetState(20.0, 2.0), Goal(stop=StopPoint(20.0, "line")))
    assert np.all(np.diff(plans.speed, axis=1) <= 1e-9)
    assert plans.speed[:, -1].min() == 0.0


def test_following_ends_at_the_gap() -> None:
    form = LatticeSettings(horizon=25.0)
    leader = Follow("lead", 80.0, 8.0)
    goal = Goal(cruise_speed=15.0, follow=leader)
    plans = sample(STRAIGHT, FrenetState(20.0, 13.0), goal, settings=form)
    found = check(plans, VehicleLimits.comfortable(), goal)
    gap = leader.rear_station + 8.0 * plans.time[-1] - plans.station[:, -1] - FRONT
    wanted = form.standstill_gap + form.headway * 8.0
    there = found.ok & (np.abs(gap - wanted) < 0.05) & (np.abs(plans.speed[:, -1] - 8.0) < 1e-6)
    assert there.any()
    assert np.all(gap[found.ok] >= 0.0)
    stopped = sample(STRAIGHT, FrenetState(20.0, 13.0), Goal(cruise_speed=15.0, follow=Follow("lead", 120.0, 0.0)), settings=form)
    assert np.all(stopped.station[:, -1] + FRONT <= 120.0 - form.standstill_gap + 0.05)


def test_changes_of_offset_end_where_the_next_plan_ends_them() -> None:
    goal = Goal(offsets=(3.5,), cruise_speed=13.0)
    first = sample(STRAIGHT, FrenetState(20.0, 13.0), goal)
    done = np.abs(first.offset[:, -1] - 3.5) < 1e-9
    plan = first.one(int(np.flatnonzero(done & (np.abs(first.speed[:, -1] - 13.0) < 1e-9))[0]))
    state = STRAIGHT.frenet_state(STRAIGHT.ego_state(FrenetState(plan.station[5], 13.0, 0.0, plan.offset[5])))
    slope = np.tan(plan.heading[5])
    bend = plan.curvature[5] * (1 + slope**2) ** 1.5
    again = sample(STRAIGHT, FrenetState(state.s, 13.0, 0.0, plan.offset[5], d_prime=slope, d_double_prime=bend), goal)
    close = np.abs(again.offset[:, :40] - plan.offset[5:45]).max(axis=1) + np.abs(again.station[:, :40] - plan.station[5:45]).max(axis=1)
    assert close.min() < 1e-6


def test_the_same_bytes_with_and_without_a_workspace() -> None:
    start, goal, room = FrenetState(20.0, 12.0, 0.3, 0.4), Goal(offsets=(0.0, 3.5), stop=StopPoint(130.0, "line")), Workspace()
    sample(BENT, FrenetState(40.0, 5.0, 0.0, 1.0), Goal(offsets=(0.0, 1.0, 2.0)), workspace=room)
    one, other = sample(BENT, start, goal, workspace=room), sample(BENT, start, goal)
    for name in ("x", "y", "heading", "speed", "acceleration", "jerk", "curvature", "station", "offset"):
        assert getattr(one, name).tobytes() == getattr(other, name).tobytes()


def test_a_plan_may_run_beyond_the_path() -> None:
    plans = sample(STRAIGHT, FrenetState(390.0, 15.0), Goal(cruise_speed=15.0))
    assert plans.x.max() > 460.0
    assert np.allclose(plans.y, 0.0)


def test_inside_the_centre_of_curvature_nothing_is_ok() -> None:
    angle = np.linspace(0, np.pi, 60)
    bend = ReferencePath(np.column_stack((8 * np.sin(angle), 8 - 8 * np.cos(angle))))
    plans, found = planned(bend, FrenetState(8.0, 3.0), Goal(offsets=(9.0,), cruise_speed=5.0))
    crossed = plans.offset.max(axis=1) > 8.2
    assert crossed.any()
    assert not found.ok[crossed].any()
