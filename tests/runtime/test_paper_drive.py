"""The paper's drive and its variants, accepted by what the world itself says, not by what the planner reports of itself (P32-P41)."""

from __future__ import annotations

import itertools
import math

import pytest
from regdb_runtime.drive.events import Event, events_of
from regdb_runtime.drive.expected import shortfalls
from regdb_runtime.drive.log import line_of
from regdb_runtime.drive.measures import measure, super_states
from regdb_runtime.drive.paper_scene import scene_spec
from regdb_runtime.drive.prepare import eye_of
from regdb_runtime.drive.variants import VARIANTS, Variant, variant
from regdb_runtime.maps.road_map import StopLine
from watched_drives import Instant, Witnessed, bumper, gap, inside, law, witness, witnessed

MPH = 0.44704
THREE_FEET = 0.9144
NAMES = [item.name for item in VARIANTS]


@pytest.fixture
def paper() -> Witnessed:
    return witnessed("paper")


def happened(drive: Witnessed) -> dict[str, Event]:
    return {event.name: event for event in events_of(drive.log.run, drive.log.ticks)}


def between(drive: Witnessed, first: float, last: float) -> list[Instant]:
    return [item for item in drive.instants if first - 1e-6 <= item.time <= last + 1e-6]


def in_zone(drive: Witnessed, item: Instant) -> bool:
    point = bumper(item.ego, drive.footprint)
    return any(inside(point, [(float(x), float(y)) for x, y in zone.polygon]) for zone in drive.world.road_map.zones)


def stop_line(drive: Witnessed) -> StopLine:
    return next(line for name in drive.world.route if (line := drive.world.road_map.lanes[name].stop_line) is not None)


def before_line(drive: Witnessed, item: Instant) -> float:
    """Metres from the front bumper on to the stop line, along the lane that leads up to it; negative past it."""
    line = stop_line(drive)
    along = math.atan2(line.end[1] - line.start[1], line.end[0] - line.start[0])
    x, y = bumper(item.ego, drive.footprint)
    left = -math.sin(along) * (x - line.start[0]) + math.cos(along) * (y - line.start[1])
    first = drive.instants[0]
    start = bumper(first.ego, drive.footprint)
    side = -math.sin(along) * (start[0] - line.start[0]) + math.cos(along) * (start[1] - line.start[1])
    return math.copysign(1.0, side) * left


def test_the_drive_has_exactly_the_papers_events_in_order(paper: Witnessed) -> None:
    events = events_of(paper.log.run, paper.log.ticks)
    assert [event.name for event in events] == ["overtaking_begins", "back_in_lane", "stopped", "released", "zone_detected", "reduced_speed"]
    assert paper.log.end["ended"] == "destination"


def test_the_states_go_as_the_paper_says(paper: Witnessed) -> None:
    """P12-P15, P38-P40: lane following, overtaking, back; intersection handling from and to go-straight; lane following through the zone."""
    states = measure(paper.log).states
    assert states[0] == "lane_following.go_straight"
    assert super_states(states) == ("lane_following", "overtaking", "lane_following", "intersection_handling", "lane_following")
    for before, after in itertools.pairwise(states):
        assert after in law().machine.states[before].next
        if before.partition(".")[0] != after.partition(".")[0]:
            assert (before.partition(".")[2], after.partition(".")[2]) == ("go_straight", "go_straight")
    assert "intersection_handling.stop" in states
    assert "intersection_handling.turn_right" in states
    after_turn = happened(paper)["zone_detected"].time
    assert {tick["state"].partition(".")[0] for tick in paper.log.ticks if tick["time"] >= after_turn} == {"lane_following"}


def test_the_cyclist_is_never_passed_closer_than_three_feet(paper: Witnessed) -> None:
    """P33: any part of the vehicle to any part of the bicycle or its rider, over the whole pass."""
    events = happened(paper)
    gaps = [
        gap(item.ego, paper.footprint, track) for item in between(paper, events["overtaking_begins"].time, events["back_in_lane"].time)
        for track in item.tracks if track.kind == "bicycle"
    ]  # fmt: skip
    assert len(gaps) > 50
    assert min(gaps) >= THREE_FEET


def test_the_pass_is_made_from_the_second_lane_and_ends_in_the_first(paper: Witnessed) -> None:
    """P38: overtaking begins and ends in the original lane; the line between the lanes is dashed."""
    events = happened(paper)
    lane = paper.world.road_map.lanes["first.e.1"]
    assert lane.left_marking == "dashed"
    middle = float(lane.center[0][1])
    sides = [item.ego.y - middle for item in between(paper, events["overtaking_begins"].time, events["back_in_lane"].time + 2.0)]
    assert abs(sides[0]) < 0.3
    assert max(sides) > lane.widths.min() - 0.3
    assert abs(sides[-1]) < 0.3


def test_no_speed_is_over_the_limit_in_force(paper: Witnessed) -> None:
    """P38, P40: 35 mph as posted, 25 mph where the front bumper is in the school's zone."""
    for item in paper.instants:
        limit = 25 * MPH if in_zone(paper, item) else 35 * MPH
        assert item.ego.speed <= limit + 1e-6, (item.time, item.ego.speed / MPH)


def test_the_vehicle_stands_at_the_line_before_it_turns_on_red(paper: Witnessed) -> None:
    """P39: a plateau at the line, the front bumper 0-2 m before it; the light is red when it is left."""
    events = happened(paper)
    plateau = between(paper, events["stopped"].time, events["released"].time)
    assert plateau[-1].time - plateau[0].time >= 1.0
    for item in plateau:
        assert item.ego.speed < 0.1
        assert 0.0 <= before_line(paper, item) <= 2.0
    light = paper.log.run["marks"]["stop_lines"][0]["lights"][0]
    crossing = next(item for item in paper.instants if before_line(paper, item) < 0.0)
    assert crossing.time > events["released"].time
    assert crossing.lights[light] == "red"


def test_crossing_traffic_is_let_through(paper: Witnessed) -> None:
    """P39: nobody who crosses comes nearer than a metre while the vehicle turns in."""
    released = happened(paper)["released"].time
    near = [
        gap(item.ego, paper.footprint, track) for item in between(paper, released, released + 15.0) for track in item.tracks
        if track.id.startswith("crossing")
    ]  # fmt: skip
    assert near
    assert min(near) > 1.0


def test_the_zones_speed_is_reached_by_its_boundary_without_abrupt_change(paper: Witnessed) -> None:
    """P40: braking begins early, 25 mph at the boundary and through the zone, |a| <= 2 m/s2, |jerk| <= 4.13 m/s3."""
    events = happened(paper)
    inner = [item for item in paper.instants if in_zone(paper, item)]
    assert inner[0].ego.speed <= 25 * MPH
    assert events["zone_detected"].time < inner[0].time - 2.0
    assert min(item.ego.speed for item in inner) > 20 * MPH
    shown = between(paper, events["zone_detected"].time - 1.0, inner[-1].time)
    assert max(abs(item.ego.acceleration) for item in shown) <= 2.0
    jerks = [(after.ego.acceleration - before.ego.acceleration) / (after.time - before.time) for before, after in itertools.pairwise(shown)]
    assert max(map(abs, jerks)) <= 4.13


def test_every_drive_says_where_its_perception_came_from(paper: Witnessed) -> None:
    assert paper.log.run["provenance"] == "scripted"
    assert witnessed("no-eye").log.run["provenance"] == "none"
    assert not any(facts for _, facts, _ in eye_of(witnessed("no-eye").log))
    assert any(facts.get("school.children_going") for _, facts, _ in eye_of(paper.log))


def test_the_same_scene_gives_the_same_bytes() -> None:
    spec = scene_spec(variant("red").scene, "red")
    first, second = ([line_of(record) for record in (log.run, *log.ticks, log.end)] for log in (witness("red", spec).log, witness("red", spec).log))
    assert first == second


@pytest.mark.parametrize("item", VARIANTS, ids=NAMES)
def test_a_variant_ends_and_does_what_the_law_says(item: Variant) -> None:
    drive = witnessed(item.name)
    assert shortfalls(item.expects, measure(drive.log)) == ()
    assert not drive.world.contacts
    if item.expects.ends == "standstill":
        assert "not known: " in drive.log.end["reason"]
    else:
        assert longest_stand(drive) <= 60.0
    assert passes_at_three_feet(drive)
    assert never_runs_a_red_light(drive)
    flags = {tick["flag"] for tick in drive.log.ticks}
    assert "least_violation" not in flags
    assert "no_trajectory" not in flags


def longest_stand(drive: Witnessed) -> float:
    """Seconds of the longest standstill."""
    longest = since = 0.0
    for item in drive.instants:
        since = since if item.ego.speed < 0.1 else item.time
        longest = max(longest, item.time - since)
    return longest


def passes_at_three_feet(drive: Witnessed) -> bool:
    """Whether no bicycle is nearer than three feet while the vehicle's front is past its rear."""
    for item in drive.instants:
        for track in item.tracks:
            if track.kind == "bicycle":
                cos, sin = math.cos(item.ego.heading), math.sin(item.ego.heading)
                along = (track.x - item.ego.x) * cos + (track.y - item.ego.y) * sin
                beside = -3.0 < along < drive.footprint.front + track.length / 2
                if beside and item.ego.speed > track.speed and gap(item.ego, drive.footprint, track) < THREE_FEET:
                    return False
    return True


def never_runs_a_red_light(drive: Witnessed) -> bool:
    """Whether the line is crossed on red only where the variant allows it, and then only after a full stop."""
    lines = drive.log.run["marks"]["stop_lines"]
    if not lines:
        return True
    light = lines[0]["lights"][0]
    crossing = next((item for item in drive.instants if before_line(drive, item) < 0.0), None)
    if crossing is None or crossing.lights[light] == "green":
        return True
    stood = [item for item in drive.instants if item.time < crossing.time and item.ego.speed < 0.1 and 0.0 <= before_line(drive, item) <= 2.0]
    return variant(drive.log.run["variant"]).expects.crosses == "red" and len(stood) >= 10
