"""Contacts and clearances: known meetings, thin things at speed, and agreement with motion cut very finely."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from regdb_runtime.geometry import boxes, distance, overlap
from regdb_runtime.observation import Footprint, Track
from regdb_runtime.planning.contacts import Sweeper, best_free, clearances, first_contact, least_clearance
from regdb_runtime.planning.prediction import ConstantVelocity, Predictions
from regdb_runtime.trajectory import Candidates, Trajectory

FOOTPRINT = Footprint()
TIME = np.arange(51) * 0.1
STEADY = ConstantVelocity(turning=False)


def straight(speed: float, offset: float = 0.0, heading: float = 0.0, time: np.ndarray = TIME) -> Trajectory:
    """Rear axle from the origin (moved aside) at constant speed."""
    way = speed * time
    flat = np.zeros_like(time)
    x, y = way * math.cos(heading) - offset * math.sin(heading), way * math.sin(heading) + offset * math.cos(heading)
    return Trajectory(time, x, y, flat + heading, flat + speed, flat, flat, flat, way, flat + offset)


def together(*plans: Trajectory) -> Candidates:
    names = ("x", "y", "heading", "speed", "acceleration", "jerk", "curvature", "station", "offset")
    return Candidates(plans[0].time, *(np.stack([getattr(plan, name) for plan in plans]) for name in names))


def user(name: str, x: float, y: float, speed: float = 0.0, heading: float = 0.0, length: float = 4.8, width: float = 1.8) -> Track:
    return Track(name, "car", x, y, heading, speed, length, width)


def seen(*tracks: Track) -> Predictions:
    return STEADY.predict(tracks, TIME)


def test_a_standing_car_ahead_is_touched_when_the_bumper_arrives() -> None:
    ahead = seen(user("wall", FOOTPRINT.front + 20 + 2.4, 0.0))
    found = first_contact(straight(10.0), FOOTPRINT, ahead)
    assert found.time == pytest.approx([2.0], abs=0.02)
    assert found.track.tolist() == [0]
    assert first_contact(straight(10.0), FOOTPRINT, ahead, margin=1.0).time == pytest.approx([1.9], abs=0.02)
    assert first_contact(straight(3.9), FOOTPRINT, ahead).free.all()


def test_of_several_the_first_in_time_is_named() -> None:
    others = seen(user("far", 60, 0), user("near", 30, 0), user("beside", 20, 4.0))
    assert first_contact(straight(12.0), FOOTPRINT, others).track.tolist() == [1]
    assert first_contact(straight(12.0, offset=8.0), FOOTPRINT, others).free.all()
    assert first_contact(straight(12.0), FOOTPRINT, seen()).free.all()


@pytest.mark.parametrize("speed", [30.0, 45.0, 60.0])
def test_a_thin_pole_is_not_jumped_over(speed: float) -> None:
    """At 60 m/s the vehicle moves 6 m from instant to instant and is 4.8 m long: a pole can stand where it never is at an instant."""
    for place in np.linspace(8.0, 14.0, 25):
        pole = seen(user("pole", float(place), 0.6, length=0.05, width=0.05))
        assert first_contact(straight(speed), FOOTPRINT, pole).track.tolist() == [0]


def test_what_crosses_between_two_instants_is_found() -> None:
    """A thin thing shot across the bonnet within one step of 0.1 s, in front of a short vehicle: at neither instant does it touch."""
    short = Footprint(0.3, 0.3, 0.2, 0.05)
    arrow = seen(user("arrow", 0.1, -2.05, speed=40.0, heading=math.pi / 2, length=0.05, width=0.05))
    plan = straight(0.0)
    at_instants = overlap(boxes(short.center, 0.0, 0.0, 0.3, 0.3), arrow.boxes)
    assert not at_instants.any()
    found = first_contact(plan, short, arrow)
    assert found.track.tolist() == [0]
    assert found.time[0] == pytest.approx((2.05 - 0.15) / 40.0, abs=0.003)


def test_reach_makes_a_walker_larger() -> None:
    walker = Track("walker", "pedestrian", 20.0, 1.6, 0.0, 0.0, 0.5, 0.5)
    grown = ConstantVelocity().predict((walker,), TIME)
    assert grown.reach[0, 0] == pytest.approx(0.1)
    assert grown.reach[0, -1] == pytest.approx(0.6)
    assert first_contact(straight(8.0), FOOTPRINT, grown).track.tolist() == [0]
    parked = seen(Track("post", "obstacle", 20.0, 1.6, 0.0, 0.0, 0.5, 0.5))
    assert first_contact(straight(8.0), FOOTPRINT, parked).free.all()


def test_the_best_free_plan_is_found_in_order() -> None:
    plans = together(straight(15.0), straight(12.0), straight(2.0), straight(1.0))
    found, hit = best_free(plans, np.array([0, 1, 2, 3]), FOOTPRINT, seen(user("wall", 30, 0)))
    assert found == 2
    assert sorted(hit) == [0, 1]
    assert hit[0][1] == "wall"
    assert hit[0][0] < hit[1][0]
    assert best_free(plans, np.array([0, 1]), FOOTPRINT, seen(user("wall", 30, 0)))[0] is None


def test_clearance_is_between_any_parts_over_the_pass() -> None:
    cyclist = seen(Track("cyclist", "bicycle", 20.0, -(0.9 + 0.9144 + 0.3), 0.0, 4.0, 1.8, 0.6))
    plans = together(straight(12.0), straight(12.0, offset=0.5))
    by_time = clearances(plans, FOOTPRINT, cyclist, "cyclist")
    assert by_time.shape == (2, 51)
    assert by_time.min(axis=1) == pytest.approx([0.9144, 1.4144], abs=1e-9)
    assert least_clearance(plans, FOOTPRINT, cyclist, "cyclist") == pytest.approx([0.9144, 1.4144], abs=1e-9)
    assert least_clearance(plans, FOOTPRINT, cyclist, "cyclist", rows=np.array([1])) == pytest.approx([1.4144])
    with pytest.raises(KeyError):
        clearances(plans, FOOTPRINT, cyclist, "nobody")


def finely(plan: Trajectory, other: Predictions, cuts: int) -> tuple[float, float]:
    """Time of first overlap and least distance, by brute force: every interval cut `cuts` times."""
    time = np.linspace(0.0, 5.0, 50 * cuts + 1)
    at = lambda values: np.interp(time, TIME, values)  # noqa: E731
    turn = at(plan.heading)
    own_x, own_y = plan.x + FOOTPRINT.center * np.cos(plan.heading), plan.y + FOOTPRINT.center * np.sin(plan.heading)
    ours = boxes(at(own_x), at(own_y), turn, FOOTPRINT.length, FOOTPRINT.width)
    theirs = boxes(at(other.x[0]), at(other.y[0]), at(other.heading[0]), other.length[0], other.width[0])
    hits = np.flatnonzero(overlap(ours, theirs))
    return (float(time[hits[0]]) if len(hits) else math.inf), float(distance(ours, theirs).min())


@settings(max_examples=150, deadline=None)
@given(
    st.floats(0, 35), st.floats(-0.5, 0.5), st.floats(-30, 60), st.floats(-30, 30), st.floats(0, 35), st.floats(-math.pi, math.pi),
    st.floats(0.1, 12), st.floats(0.1, 2.5),
)  # fmt: skip
def test_contacts_agree_with_motion_cut_very_finely(
    speed: float, heading: float, x: float, y: float, other_speed: float, other_heading: float, length: float, width: float
) -> None:
    plan = straight(speed, 0.0, heading)
    other = seen(user("it", x, y, other_speed, other_heading, length, width))
    brute, least = finely(plan, other, 60)
    found = first_contact(plan, FOOTPRINT, other)
    if math.isfinite(brute):
        assert found.time[0] <= brute + 1e-9, "no contact may be missed"
        assert clearances_at(plan, other, float(found.time[0])) < 0.11, "not before they are all but touching"
    elif found.track[0] >= 0:
        assert least < 0.05, "a miss by more than 5 cm is no contact"
    among = Sweeper(other, FOOTPRINT, among=together(plan, straight(1.0))).first_contact(plan.x, plan.y, plan.heading)
    assert among == (found.time[0], found.track[0])


def clearances_at(plan: Trajectory, other: Predictions, time: float) -> float:
    own = [float(np.interp(time, TIME, part)) for part in (plan.x, plan.y, plan.heading)]
    center = own[0] + FOOTPRINT.center * math.cos(own[2]), own[1] + FOOTPRINT.center * math.sin(own[2])
    theirs = [float(np.interp(time, TIME, part[0])) for part in (other.x, other.y, other.heading)]
    return float(distance(
        boxes(*center, own[2], FOOTPRINT.length, FOOTPRINT.width), boxes(*theirs, other.length[0], other.width[0])
    ))  # fmt: skip
