"""What plans say of themselves: each fact on motions made by hand, with numbers one can work out."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest
from assessment_scene import FOOTPRINT, GO, LEFT, LEFT_Y, MPH, PASS, POSTED, RIGHT, RIGHT_Y, along, bicycle, car, law, maneuver, road, stretch
from regdb_runtime.assessment.assessor import Assessor
from regdb_runtime.assessment.plan_facts import measure
from regdb_runtime.assessment.settings import AssessmentSettings
from regdb_runtime.maneuver import Junction, Maneuver
from regdb_runtime.observation import Track
from regdb_runtime.planning.goal import Goal
from regdb_runtime.planning.prediction import ConstantVelocity
from regdb_runtime.scenes.stretch import Stretch
from regdb_runtime.trajectory import Candidates, Floats

from regdb.vocabulary import Value

TIME = np.arange(51) * 0.1
HALF = FOOTPRINT.width / 2


def motion(speed: Floats | float, offset: Floats | float = 0.0, start: float = 60.0) -> Candidates:
    """One plan along the right lane (heading by the offset's change), its station the integral of the speed."""
    held = np.broadcast_to(np.asarray(speed, float), TIME.shape)
    aside = np.broadcast_to(np.asarray(offset, float), TIME.shape)
    station = start + np.concatenate(([0.0], np.cumsum((held[1:] + held[:-1]) / 2 * 0.1)))
    heading = np.arctan2(np.gradient(aside, 0.1), np.maximum(held, 0.1))
    acceleration = np.gradient(held, 0.1)
    rows = (station, RIGHT_Y + aside, heading, held, acceleration, np.zeros(51), np.zeros(51), station, aside)
    return Candidates(TIME, *(row[None, :].copy() for row in rows))


def facts(
    candidates: Candidates, planned: Maneuver | None = None, tracks: Sequence[Track] = (), stretches: Sequence[Stretch] = (), index: int = 0,
    profile: str | None = None, settings: AssessmentSettings | None = None,
) -> dict[str, Value]:  # fmt: skip
    assessor = Assessor(law(), FOOTPRINT, settings, law().interpretations[profile] if profile else None, road())
    planned = planned or maneuver()
    pieces = stretches or (stretch(60.0 + FOOTPRINT.front, 1e9, POSTED),)
    what = assessor._measuring(planned, pieces, candidates, ConstantVelocity().predict(tuple(tracks), TIME))
    return measure(what, candidates, np.array([0])).one(index, 0, pieces[index].roles)


def test_speed_is_the_greatest_within_the_stretch() -> None:
    """15 m/s, braking by 2 m/s2 from the start: at a border 30 m on, v^2 = 225 - 120."""
    border = 60.0 + FOOTPRINT.front + 30.0
    pieces = (stretch(60.0 + FOOTPRINT.front, border, POSTED), stretch(border, 1e9, POSTED))
    braking = motion(np.maximum(15.0 - 2.0 * TIME, 0.0))
    assert facts(braking, stretches=pieces)["plan.speed"] == pytest.approx(14.8)
    assert facts(braking, stretches=pieces, index=1)["plan.speed"] == pytest.approx(105**0.5, abs=2e-3)


def test_a_stretch_never_reached_is_not_judged() -> None:
    border = 60.0 + FOOTPRINT.front + 30.0
    pieces = (stretch(60.0 + FOOTPRINT.front, border, POSTED), stretch(border, 1e9, POSTED))
    assessor = Assessor(law(), FOOTPRINT, road_map=road())
    slow = motion(2.0)
    what = assessor._measuring(maneuver(), pieces, slow, ConstantVelocity().predict((), TIME))
    assert measure(what, slow, np.array([0])).reached.tolist() == [[True], [False]]


@pytest.mark.parametrize(("beyond", "enters"), [(-0.5, False), (0.0, False), (0.005, False), (0.05, True)])
def test_entering_is_the_front_bumper_past_the_line(beyond: float, enters: bool) -> None:
    line = 60.0 + FOOTPRINT.front + 25.0 - beyond
    told = facts(motion(5.0), stretches=(stretch(60.0 + FOOTPRINT.front, 1e9, POSTED, line=line, crosswalk=line, rail=line, bus=line),))
    for fact in ("plan.enters_intersection", "plan.enters_crosswalk", "plan.enters_rail_crossing", "plan.passes_school_bus"):
        assert told[fact] is enters


def test_a_manoeuvre_that_commits_enters_wherever_its_horizon_ends() -> None:
    pieces = (stretch(60.0 + FOOTPRINT.front, 1e9, POSTED, line=200.0),)
    assert facts(motion(5.0), maneuver(commits=True), stretches=pieces)["plan.enters_intersection"] is True
    assert facts(motion(5.0), maneuver(), stretches=pieces)["plan.enters_intersection"] is False


@pytest.mark.parametrize("aside", [1.5, 1.8144, 2.5])
def test_clearance_is_edge_to_edge(aside: float) -> None:
    """Side by side: the offset less half of both widths."""
    planned = maneuver(GO, PASS, passes="bike", passing_side="left")
    told = facts(motion(12.0, aside), planned, [bicycle(80.0, RIGHT_Y)])
    assert told["plan.clearance"] == pytest.approx(aside - HALF - 0.3)
    assert told["plan.passes"] == "bicycle"
    assert told["plan.passing_side"] == "left"


def test_clearance_counts_the_rest_of_a_pass_beyond_the_horizon() -> None:
    """Still alongside when the plan ends, and drifting nearer: the gap at the last offset counts, not only what lies within five seconds."""
    planned = maneuver(GO, PASS, passes="bike", passing_side="left")
    drifting = 2.0 - 0.1 * TIME
    told = facts(motion(6.0, drifting), planned, [bicycle(60.0 + FOOTPRINT.front + 8.0, RIGHT_Y, 4.0)])
    corner = FOOTPRINT.front * 0.1 / 6.0  # turned towards the bicycle by 0.1 m each 6 m
    assert told["plan.clearance"] == pytest.approx(1.5 - HALF - 0.3 - corner, abs=0.002)


def test_a_pass_nobody_planned_is_seen() -> None:
    """Going by a bicycle in the own lane, or a slower car in the next one, is overtaking whatever the state is called."""
    told = facts(motion(12.0, 0.5), tracks=[bicycle(80.0, RIGHT_Y - 1.2)])
    assert (told["plan.passes"], told["plan.passing_side"], told["plan.passes_in_same_lane"]) == ("bicycle", "left", True)
    told = facts(motion(12.0), tracks=[car("slow", 80.0, LEFT_Y, 5.0)])
    assert (told["plan.passes"], told["plan.passing_side"], told["plan.passes_in_same_lane"]) == ("vehicle", "right", False)
    standing = facts(motion(12.0), tracks=[car("parked", 80.0, LEFT_Y, 0.0)])
    assert standing["plan.passes"] == "stopped_vehicle"


@pytest.mark.parametrize(
    "other",
    [car("oncoming", 110.0, -LEFT_Y, 10.0), car("faster", 80.0, LEFT_Y, 16.0), car("far", 80.0, 3 * -RIGHT_Y, 5.0), car("behind", 50.0, LEFT_Y, 5.0)],
)
def test_what_is_not_overtaken(other: Track) -> None:
    turned = Track(other.id, other.kind, other.x, other.y, np.pi if other.id == "oncoming" else 0.0, other.speed, other.length, other.width)
    assert facts(motion(12.0), tracks=[turned])["plan.passes"] == "none"


def test_the_other_lane_is_another_lane() -> None:
    planned = maneuver(GO, PASS, passes="bike", passing_side="left", target_lane=LEFT)
    changed = facts(motion(12.0, 3.5), planned, [bicycle(80.0, RIGHT_Y - 1.2)])
    assert changed["plan.passes_in_same_lane"] is False
    assert changed["plan.clearance"] == pytest.approx(3.5 - HALF + 1.2 - 0.3)


@pytest.mark.parametrize(
    ("offset", "crosses", "left", "off"),
    [(0.0, False, False, False), (0.8, False, False, False), (0.9, True, False, False), (3.5, False, False, False), (4.5, True, True, False),
     (-0.8, False, False, False), (-1.0, False, False, True)],
)  # fmt: skip
def test_lines_are_crossed_by_any_part(offset: float, crosses: bool, left: bool, off: bool) -> None:
    """Lanes of 3.5 m, a car of 1.8 m: the lane line at 1.75 is touched from 0.85 on, the centre line at 5.25 from 4.35, the edge from -0.85."""
    told = facts(motion(10.0, offset))
    assert told["plan.crosses_marking"] is crosses
    assert told["plan.drives_left_of_center"] is left
    assert told["plan.leaves_roadway"] is off


def test_the_corner_crosses_first() -> None:
    """Turned to the left by 0.1 rad the front corner is 0.38 m farther to the left than the axle."""
    offset = 0.5 + np.zeros_like(TIME)
    straight, turned = motion(10.0, offset), motion(10.0, 0.5 + 0.0 * TIME)
    turned.heading[:] = 0.1
    assert facts(straight)["plan.crosses_marking"] is False
    assert facts(turned)["plan.crosses_marking"] is True


def test_straddling_is_driving_on_a_line_without_changing_lanes() -> None:
    assert facts(motion(10.0, 1.75))["plan.straddles_lanes"] is True
    assert facts(motion(10.0, 1.75), maneuver(target_lane=LEFT))["plan.straddles_lanes"] is False
    leaving = np.where(TIME < 1.0, 2.8, 3.5)
    assert facts(motion(10.0, np.interp(TIME, (0, 2), (2.6, 3.5))))["plan.straddles_lanes"] is False, "a line that is being left"
    assert facts(motion(10.0, leaving[::-1]))["plan.straddles_lanes"] is False or leaving[-1] == 3.5


def test_distance_on_the_other_half() -> None:
    over = np.where((TIME >= 1.0) & (TIME <= 3.0), 5.0, 3.5)
    told = facts(motion(10.0, over))
    assert told["plan.distance_in_opposing_lane"] == pytest.approx(20.0, abs=2.1)


def test_following_distance_is_bumper_to_bumper() -> None:
    planned = maneuver(GO, "lane_following.car_following", lead="lead")
    told = facts(motion(10.0), planned, [car("lead", 60.0 + FOOTPRINT.front + 20.0 + 2.4, RIGHT_Y, 8.0)])
    assert told["plan.following_distance"] == pytest.approx(20.0 - 2.0 * 5.0)


def test_following_is_unsafe_by_the_interpretation_in_use() -> None:
    planned = maneuver(GO, "lane_following.car_following", lead="lead")
    near, far = ([car("lead", 60.0 + FOOTPRINT.front + gap + 2.4, RIGHT_Y, 10.0)] for gap in (25.0, 35.0))
    assert facts(motion(10.0), planned, near, profile="conservative")["lead.following_unsafe"] is True, "25 m are less than 3 s at 10 m/s"
    assert facts(motion(10.0), planned, far, profile="conservative")["lead.following_unsafe"] is False
    assert "lead.following_unsafe" not in facts(motion(10.0), planned, far)
    growing = facts(motion(np.maximum(10.0 - TIME, 7.0)), planned, near, profile="conservative")
    assert growing["lead.following_unsafe"] is False, "a gap that was too small from the first and grows"


def test_who_only_the_scene_tells_of_is_followed_too() -> None:
    """A vehicle too far ahead for the strategist to follow, not for the law: its distance and speed are roles of the scene."""
    roles: dict[str, Value] = {"lead.present": True, "lead.distance": 25.0, "lead.speed": 10.0}
    here = stretch(60.0 + FOOTPRINT.front, 1e9, POSTED, roles)
    assert facts(motion(10.0), stretches=(here,), profile="conservative")["lead.following_unsafe"] is True
    roles["lead.distance"] = 90.0
    told = facts(motion(12.0), stretches=(here,), profile="conservative")
    assert told["lead.following_unsafe"] is False
    assert told["plan.following_distance"] == pytest.approx(80.0)


def test_speed_for_conditions_is_stopping_in_sight() -> None:
    near = stretch(60.0 + FOOTPRINT.front, 1e9, POSTED, measures={"speed.unsafe_for_conditions": {"sight_distance": 30.0}})
    assert facts(motion(10.0), stretches=(near,), profile="conservative")["speed.unsafe_for_conditions"] is True, "25 m + 14.7 m"
    assert facts(motion(8.0), stretches=(near,), profile="conservative")["speed.unsafe_for_conditions"] is False, "20 m + 9.4 m"
    assert "speed.unsafe_for_conditions" not in facts(motion(8.0), stretches=(near,))


def test_slowing_is_said() -> None:
    told = facts(motion(np.maximum(10.0 - 4.0 * TIME, 0.0)))
    assert (told["plan.reduces_speed"], told["plan.slows_suddenly"], told["plan.speeds_up"]) == (True, True, False)
    told = facts(motion(10.0 + TIME))
    assert (told["plan.reduces_speed"], told["plan.slows_suddenly"], told["plan.speeds_up"]) == (False, False, True)


def test_standing_in_a_junction_is_a_stop_in_it() -> None:
    inside = Junction("j", 80.0, 82.0, 95.0, "straight", "signal")
    stops = motion(np.maximum(10.0 - 2.5 * TIME, 0.0))
    front = float(stops.station[0, -1]) + FOOTPRINT.front
    assert front == pytest.approx(83.85, abs=0.1)
    assert facts(stops, maneuver(junction=inside))["plan.stop_places"] == frozenset({"intersection"})
    before = Junction("j", 90.0, 92.0, 105.0, "straight", "signal")
    assert facts(stops, maneuver(junction=before))["plan.stop_places"] == frozenset()
    assert facts(motion(10.0), maneuver(junction=inside))["plan.stop_places"] == frozenset()


def test_turns_say_their_lanes() -> None:
    turning = Junction("j", 400.0, 402.0, 420.0, "right", "signal")
    told = facts(motion(10.0), maneuver("intersection_handling.go_straight", "intersection_handling.turn_right", junction=turning))
    assert (told["plan.turn_purpose"], told["plan.prepares_turn"], told["plan.turn_lane"]) == ("intersection", "right", "rightmost")
    left = Maneuver("intersection_handling.stop", "intersection_handling.turn_right", LEFT, along(LEFT), Goal(), junction=turning)
    assert facts(motion(10.0), left)["plan.turn_lane"] == "leftmost"
    approaching = facts(motion(10.0), maneuver(junction=turning))
    assert (approaching["plan.turn_purpose"], approaching["plan.prepares_turn"]) == ("none", "right")


def test_no_room_is_claimed_only_when_asked() -> None:
    """The bicycle in the middle of the two lanes: 3.5 m to either edge less its half width and the car's width leave 1.4 m."""
    tracks = [bicycle(80.0, (RIGHT_Y + LEFT_Y) / 2)]
    planned = maneuver(GO, PASS, passes="bike", passing_side="left")
    asked = AssessmentSettings(claims_no_room=True)
    assert "plan.no_room_for_three_feet" not in facts(motion(10.0, 3.5), planned, tracks)
    assert facts(motion(10.0, 3.5), planned, tracks, settings=asked)["plan.no_room_for_three_feet"] is False
    wide = [Track("bike", "bicycle", 80.0, (RIGHT_Y + LEFT_Y) / 2, 0.0, 4.0, 1.8, 2.0)]
    assert facts(motion(10.0, 3.5), planned, wide, settings=asked)["plan.no_room_for_three_feet"] is True, "0.7 m are left"


def test_numbers_are_rounded_to_a_micrometre() -> None:
    assert facts(motion(25 * MPH + 1e-12))["plan.speed"] == 25 * MPH
    assert RIGHT == "main.e.1"
