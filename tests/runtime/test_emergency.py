"""The emergency brake: when it must act, when it must not, how it lets go, and that it needs nothing else."""

import math
import subprocess
import sys
import threading
import time as wall

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from regdb_runtime.emergency import EmergencyBrake, EmergencySettings, nearest
from regdb_runtime.geometry import boxes, overlap
from regdb_runtime.observation import EgoState, Footprint, Track

FOOTPRINT, SETTINGS = Footprint(), EmergencySettings()


def ego(speed: float, curvature: float = 0.0, heading: float = 0.0) -> EgoState:
    return EgoState(0.0, 0.0, heading, speed, 0.0, curvature)


def car(x: float, y: float = 0.0, speed: float = 0.0, heading: float = 0.0, **more: float) -> Track:
    return Track("car", "car", x, y, heading, speed, more.pop("length", 4.8), more.pop("width", 1.8), **more)  # type: ignore[arg-type]


def ahead(gap: float, speed: float = 0.0, **more: float) -> Track:
    """A car whose rear end is `gap` before our front bumper."""
    return car(FOOTPRINT.front + gap + 2.4, 0.0, speed, **more)


def active(own: EgoState, *tracks: Track) -> bool:
    return EmergencyBrake(FOOTPRINT).check(own, tracks, 0.0).active


@pytest.mark.parametrize(("speed", "distance"), [(0, 3.0), (5, 1.5 + 25 / 13), (15, 4.5 + 225 / 13), (30, 9 + 900 / 13)])
def test_the_required_distance_is_the_stopping_distance_but_three_metres_at_least(speed: float, distance: float) -> None:
    assert SETTINGS.required(speed) == pytest.approx(max(3.0, distance))


@pytest.mark.parametrize("speed", [0.5, 5.0, 15.0, 30.0])
def test_it_acts_below_the_required_distance_and_not_above(speed: float) -> None:
    required = SETTINGS.required(speed)
    assert active(ego(speed), ahead(required - 0.05))
    assert not active(ego(speed), ahead(required + 0.05))
    report = EmergencyBrake(FOOTPRINT).check(ego(speed), (ahead(required + 0.5),), 0.0)
    assert report.gap == pytest.approx(required + 0.5)
    assert (report.required, report.track, report.give) == (required, "car", 0.0)


@pytest.mark.parametrize(
    "track",
    [
        car(6, 3.5, 15),
        car(12, 3.5, 5),
        car(14, 3.5, 15, math.pi),
        Track("cyclist", "bicycle", 4, -(0.9 + 0.95 + 0.3), 0, 5, 1.8, 0.6),
        Track("cyclist", "bicycle", 15, -(0.9 + 0.9144 + 0.3), 0.02, 5, 1.8, 0.6),
        car(8, -2.2),
        car(10, -4.0, 12, -math.pi / 2),
        car(-6, 0.0, 20),
        Track("pedestrian", "pedestrian", 5, 3.0, 0, 0, 0.5, 0.5),
    ],
    ids=["passing in the next lane", "slower in the next lane", "oncoming in its own lane", "cyclist beside at 0.95 m", "cyclist ahead beside",
         "parked beside", "crossed and past", "behind and fast", "on the kerb"],
)  # fmt: skip
def test_it_leaves_ordinary_traffic_alone(track: Track) -> None:
    assert not active(ego(15.0), track)


@pytest.mark.parametrize("speed", [3.0, 8.0, 15.0, 25.0, 35.0])
def test_a_car_may_be_followed_at_the_same_speed(speed: float) -> None:
    """At the gap that IDM keeps (2 m and 1.5 s), and still at 1.2 s and the floor."""
    assert not active(ego(speed), ahead(2.0 + 1.5 * speed, speed))
    assert not active(ego(speed), ahead(3.0 + 1.2 * speed, speed))


def test_a_car_that_brakes_hard_is_braked_for() -> None:
    """What it still covers shrinks as it slows down, so the same gap becomes too short."""
    assert not active(ego(15.0), ahead(14.0, 15.0))
    assert active(ego(15.0), ahead(14.0, 8.0))


def test_what_comes_towards_us_in_our_lane_counts_with_its_own_way_to_a_stand() -> None:
    gap = 2 * SETTINGS.required(15.0) - 1.0
    assert active(ego(15.0), ahead(gap, 15.0, heading=math.pi))
    assert not active(ego(15.0), ahead(gap, 0.0, heading=math.pi))
    assert not active(ego(15.0), ahead(gap + 2.0, 15.0, heading=math.pi))


def test_oncoming_traffic_that_leaves_the_corridor_round_a_bend_does_not() -> None:
    """The road bends right (radius 200 m) before us; the oncoming car, in its own lane 3.5 m to the left, is seen across our straight way."""
    radius, lane, angle = 200.0, 3.5, 0.17
    x, y = (radius + lane) * math.sin(angle), (radius + lane) * math.cos(angle) - radius
    oncoming = car(x, y, 15.0, math.pi - angle)
    assert nearest(ego(15.0), (oncoming,), FOOTPRINT, SETTINGS)[2] == "car"
    assert not active(ego(15.0), oncoming)


def test_crossing_traffic_in_the_corridor_is_a_wall() -> None:
    assert active(ego(10.0), car(FOOTPRINT.front + 5, 0.0, 12, math.pi / 2))


def test_the_corridor_follows_the_arc() -> None:
    radius = 20.0
    angle = 0.6
    on_arc = car(radius * math.sin(angle), radius * (1 - math.cos(angle)), 0.0, angle)
    straight_on = car(12.0, 0.0)
    speed = 8.0
    assert active(ego(speed, 1 / radius), on_arc)
    assert not active(ego(speed), on_arc)
    assert active(ego(speed), straight_on)
    assert not active(ego(speed, 1 / 8.0), straight_on)
    mirrored = car(on_arc.x, -on_arc.y, 0.0, -angle)
    assert active(ego(speed, -1 / radius), mirrored)


@given(
    st.floats(-0.2, 0.2).filter(lambda k: abs(k) > 2e-5 or k == 0.0), st.floats(-4, 16), st.floats(-8, 8), st.floats(-math.pi, math.pi),
    st.floats(0.3, 10), st.floats(0.3, 2.5),
)  # fmt: skip
def test_the_gap_is_the_way_until_the_rectangle_touches(
    curvature: float, x: float, y: float, heading: float, length: float, width: float
) -> None:
    """Between the way until a rectangle 1 cm larger touches and that until one 1 cm smaller does, driven along the arc in steps of 2 cm."""
    track = Track("it", "obstacle", x, y, heading, 0.0, length, width)
    gap, _, _ = nearest(ego(10.0, curvature), (track,), FOOTPRINT, EmergencySettings(side_margin=0.0))
    way = np.arange(0.0, 12.0, 0.02)
    turn = curvature * way
    chord = way * np.sinc(turn / (2 * math.pi))
    rear = chord * np.cos(turn / 2), chord * np.sin(turn / 2)
    swept = boxes(rear[0] + FOOTPRINT.center * np.cos(turn), rear[1] + FOOTPRINT.center * np.sin(turn), turn, FOOTPRINT.length, FOOTPRINT.width)
    body = boxes(x, y, heading, length, width)
    larger, smaller = (np.flatnonzero(overlap(swept.grown(by), body)) for by in (0.01, -0.01))
    ahead_of_axle = x + abs(length / 2 * math.cos(heading)) + abs(width / 2 * math.sin(heading)) > 0.02
    if len(smaller) and ahead_of_axle and abs(turn[smaller[0]]) < 1.5:
        assert gap is not None
        assert way[larger[0]] - 0.02 <= gap <= way[smaller[0]] + 1e-9


def test_it_lets_go_after_distance_and_time() -> None:
    brake = EmergencyBrake(FOOTPRINT)
    required = SETTINGS.required(10.0)
    assert brake.check(ego(10.0), (ahead(required - 1),), 0.0).active
    assert brake.check(ego(10.0), (ahead(required + 0.5),), 0.1).active, "half a metre is no release"
    assert brake.check(ego(10.0), (ahead(required + 2),), 0.2).active
    assert brake.check(ego(10.0), (ahead(required + 0.5),), 0.5).active, "the distance must be kept all the while"
    assert brake.check(ego(10.0), (), 0.6).active
    assert brake.check(ego(10.0), (), 1.0).active
    assert not brake.check(ego(10.0), (), 1.1).active
    assert not brake.check(ego(10.0), (), 1.2).active


def test_a_standing_vehicle_is_in_no_emergency_but_one_that_stopped_for_it_waits() -> None:
    waiting = Track("walker", "pedestrian", FOOTPRINT.front + 1.5, 0.0, math.pi / 2, 1.3, 0.5, 0.5)
    assert not active(ego(0.0), waiting)
    brake = EmergencyBrake(FOOTPRINT)
    assert brake.check(ego(2.0), (waiting,), 0.0).active
    assert brake.check(ego(0.0), (waiting,), 5.0).active
    brake.check(ego(0.0), (), 5.1)
    assert not brake.check(ego(0.0), (), 5.6).active


def test_full_braking_keeps_the_arc_and_the_stand() -> None:
    own = EgoState(3.0, -2.0, 0.5, 14.0, 1.0, 0.02)
    plan = EmergencyBrake(FOOTPRINT).brake(own)
    assert (plan.x[0], plan.y[0], plan.heading[0], plan.speed[0]) == (3.0, -2.0, 0.5, 14.0)
    assert plan.station[-1] == pytest.approx(14.0**2 / (2 * SETTINGS.full_braking))
    assert plan.speed[-1] == 0.0
    assert np.all(plan.speed[plan.time >= 14.0 / 8.0] == 0.0)
    assert plan.time[-1] >= 14.0 / 8.0 + SETTINGS.plan_hold - 1e-9
    assert np.all(np.diff(plan.station) >= 0)
    middle = 3.0 - 50 * math.sin(0.5), -2.0 + 50 * math.cos(0.5)
    assert np.hypot(plan.x - middle[0], plan.y - middle[1]) == pytest.approx(50.0)
    assert plan.heading == pytest.approx(0.5 + plan.station * 0.02)


def test_braking_from_a_stand_stands() -> None:
    plan = EmergencyBrake(FOOTPRINT).brake(ego(0.0))
    assert np.all(plan.station == 0.0)
    assert np.all(plan.acceleration == 0.0)


@given(st.floats(0.5, 35.0), st.floats(0.0, 3.0))
def test_it_stops_before_what_stands_in_the_way(speed: float, offset: float) -> None:
    """Driven tick by tick at 10 Hz towards a standing car from afar, it never touches it."""
    brake = EmergencyBrake(FOOTPRINT)
    wall_at = FOOTPRINT.front + SETTINGS.required(speed) + 1.0 + offset
    station, own_speed, time = 0.0, speed, 0.0
    while own_speed > 0.0 and time < 60.0:
        report = brake.check(EgoState(station, 0.0, 0.0, own_speed), (car(wall_at + 2.4),), time)
        if report.active:
            own_speed_next = max(0.0, own_speed - SETTINGS.full_braking * 0.1)
            station += (own_speed + own_speed_next) / 2 * 0.1
            own_speed = own_speed_next
        else:
            station += own_speed * 0.1
        time += 0.1
        assert station + FOOTPRINT.front < wall_at
    assert brake.active


def test_it_needs_neither_law_nor_map_nor_planner() -> None:
    """In an interpreter that refuses all of these, and with another thread that holds the database's file and never answers."""
    code = (
        "import sys\n"
        "class Refuse:\n"
        "    def find_spec(self, name, path=None, target=None):\n"
        "        parts = ('database', 'legality', 'verdict', 'maps', 'planning', 'scenes', 'strategy', 'index')\n"
        "        if name == 'sqlite3' or name.startswith(tuple('regdb_runtime.' + part for part in parts)):\n"
        "            raise ImportError('gone: ' + name)\n"
        "sys.meta_path.insert(0, Refuse())\n"
        "from regdb_runtime.emergency import EmergencyBrake\n"
        "from regdb_runtime.observation import EgoState, Footprint, Track\n"
        "brake = EmergencyBrake(Footprint())\n"
        "own = EgoState(0, 0, 0, 12.0)\n"
        "report = brake.check(own, (Track('x', 'car', 12, 0, 0, 0, 4.8, 1.8),), 0.0)\n"
        "plan = brake.brake(own)\n"
        "assert report.active and plan.acceleration[0] < -7 and plan.speed[-1] == 0\n"
        "assert 'sqlite3' not in sys.modules and not any('regdb_runtime.planning' in name for name in sys.modules)\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 0, done.stderr


def test_a_hung_thread_holds_nothing_it_needs() -> None:
    hung = threading.Event()
    thread = threading.Thread(target=hung.wait, daemon=True)
    thread.start()
    start = wall.perf_counter()
    assert active(ego(12.0), ahead(5.0))
    assert wall.perf_counter() - start < 0.1
    hung.set()
    thread.join()


def test_results_do_not_depend_on_the_clock_or_the_order() -> None:
    tracks = [car(10.0 + 3 * i, (-1) ** i * 2.5, 5.0 + i, 0.1 * i) for i in range(20)]
    first = nearest(ego(14.0, 0.01), tracks, FOOTPRINT, SETTINGS)
    assert nearest(ego(14.0, 0.01), tracks[::-1], FOOTPRINT, SETTINGS) == first
