"""Streets become maps whose lanes fit together, with curvature that never jumps, and know all that is mapped."""

import math

import numpy as np
import pytest
from regdb_runtime.errors import WorldError
from regdb_runtime.maps.lane_graph import LaneGraph
from regdb_runtime.maps.road_map import RoadMap
from regdb_runtime.worlds.built_in.build import shipped_vocabulary
from regdb_runtime.worlds.curves import connection, curve, middle_line, straight
from regdb_runtime.worlds.junction_builder import cycle
from regdb_runtime.worlds.road_builder import build_road_map, follow_turns
from regdb_runtime.worlds.road_spec import Arm, JunctionSpec, Piece, Pose, RoadSpec, SignalPhase, StreetsSpec, ZoneSpec

SETBACK = 16.0


def crossing(lanes: int = 2, **junction: object) -> StreetsSpec:
    roads = (
        RoadSpec("main", (Piece(200.0),), Pose(-200.0 - SETBACK), lanes, lanes, center="double_solid"),
        RoadSpec("on", (Piece(150.0),), Pose(SETBACK), lanes, lanes, center="double_solid"),
        RoadSpec("south", (Piece(150.0),), Pose(0.0, -SETBACK, 270.0)),
        RoadSpec("north", (Piece(150.0),), Pose(0.0, SETBACK, 90.0)),
    )
    arms = (Arm("main", "end", arrows=("right",)), Arm("on", "start"), Arm("south", "start"), Arm("north", "start"))
    told = {"control": "signal", "phases": (SignalPhase(("e", "w"), 20.0), SignalPhase(("n", "s", "e.right"), 15.0))} | junction
    return StreetsSpec(roads, (JunctionSpec("junction", arms, **told),))  # type: ignore[arg-type]


def built(spec: StreetsSpec) -> RoadMap:
    return build_road_map(spec, shipped_vocabulary())


def test_lanes_are_named_from_the_right_and_know_their_neighbours() -> None:
    lanes = built(crossing()).lanes
    right, left = lanes["main.e.1"], lanes["main.e.2"]
    assert (right.left, right.left_same_direction, right.right, right.right_marking) == ("main.e.2", True, None, "curb")
    assert (left.left, left.left_same_direction, left.left_marking) == ("main.w.2", False, "double_solid")
    assert right.left_marking == left.right_marking == "dashed"
    assert right.facts["ego.lane_position"] == "rightmost"
    assert left.facts["lane.center_marking"] == "double_solid_yellow"
    assert np.allclose(right.widths, 3.5)


def test_every_turn_begins_and_ends_where_its_lanes_do_and_never_bends_sharply() -> None:
    road_map = built(crossing())
    inner = [lane for lane in road_map.lanes.values() if lane.junction == "junction"]
    assert sorted(lane.id for lane in inner if lane.id.startswith("junction.e.")) == [
        "junction.e.left", "junction.e.right", "junction.e.straight.1", "junction.e.straight.2"]
    for lane in inner:
        before, after = road_map.lanes[lane.predecessors[0]], road_map.lanes[lane.successors[0]]
        assert np.allclose(lane.center[0], before.center[-1], atol=1e-6)
        assert np.allclose(lane.center[-1], after.center[0], atol=1e-6)
        headings = np.unwrap(np.arctan2(*np.diff(lane.center, axis=0).T[::-1]))
        bends = np.abs(np.diff(headings)) / np.hypot(*np.diff(lane.center, axis=0).T)[1:]
        assert bends.max(initial=0.0) < 0.16


def test_a_limit_line_stands_before_the_crosswalk_with_the_lights_that_speak_to_the_lane() -> None:
    road_map = built(crossing())
    line = road_map.lanes["main.e.1"].stop_line
    assert line is not None
    assert line.start[0] == pytest.approx(-SETBACK - 4.0 - 1.22)
    assert line.start[1] == pytest.approx(-3.5)
    assert line.end[1] == pytest.approx(-7.0)
    assert road_map.lanes["main.e.1"].lights == ("junction.e.light", "junction.e.right.light") or set(road_map.lanes["main.e.1"].lights) == {
        "junction.e.light", "junction.e.right.light"}
    assert road_map.lanes["junction.e.right"].lights == ("junction.e.right.light",)
    assert road_map.lights["junction.e.right.light"].arrow
    assert road_map.lights["junction.e.light"].direction == "left_straight"
    assert {crosswalk.id for crosswalk in road_map.crosswalks} == {f"junction.crosswalk.{side}" for side in "nesw"}


def test_a_head_shows_green_yellow_and_red_in_its_phase_and_red_when_no_phase_names_it() -> None:
    junction = crossing().junctions[0]
    assert [(phase.color, phase.duration) for phase in cycle(junction, "e")] == [("green", 20.0), ("yellow", 3.5), ("red", 21.5)]
    assert [(phase.color, phase.duration) for phase in cycle(junction, "n.left")] == [("red", 45.0)]


def test_a_stop_on_the_side_road_is_seen_from_both_roads() -> None:
    spec = crossing(control="stop", phases=())
    arms = tuple(Arm(arm.road, arm.end, control="none" if arm.road in ("main", "on") else None) for arm in spec.junctions[0].arms)
    road_map = built(StreetsSpec(spec.roads, (JunctionSpec("junction", arms, "stop"),)))
    assert road_map.lanes["junction.n.left"].facts["intersection.control"] == "stop_ego"
    assert road_map.lanes["junction.e.left"].facts["intersection.control"] == "stop_cross"
    line = road_map.lanes["south.n.1"].stop_line
    assert line is not None
    assert [road_map.signs[name].code for name in line.signs] == ["R1-1"]
    assert road_map.lanes["main.e.1"].stop_line is None


def test_a_map_of_our_own_leaves_no_mapped_fact_unknown() -> None:
    vocabulary, road_map = shipped_vocabulary(), built(crossing())
    mapped = {fact.name for fact in vocabulary if fact.source == "map" and fact.quiet is not None}
    assert mapped <= road_map.facts.keys()


def test_roads_whose_ends_coincide_are_joined_lane_to_lane() -> None:
    first, second = RoadSpec("first", (Piece(100.0),), limit=15.0), RoadSpec("second", (Piece(80.0),), Pose(100.0), limit=11.0)
    lanes = built(StreetsSpec((first, second))).lanes
    assert lanes["first.e.1"].successors == ("second.e.1",)
    assert lanes["second.w.1"].successors == ("first.w.1",)
    assert LaneGraph(built(StreetsSpec((first, second)))).successors("first.e.1") == ("second.e.1",)


def test_a_route_follows_the_turns_told_from_the_lane_that_makes_them() -> None:
    road_map = built(crossing())
    assert follow_turns(road_map, "main.e.1", ("left",)) == ("main.e.2", "junction.e.left", "north.n.1")
    assert follow_turns(road_map, "main.e.2", ()) == ("main.e.2", "junction.e.straight.2", "on.e.2")
    with pytest.raises(WorldError, match="turns u_turn"):
        follow_turns(road_map, "main.e.1", ("u_turn",))


def test_a_curve_turns_by_its_angle_and_its_curvature_never_jumps() -> None:
    points, headings = middle_line(Pose(), [straight(50.0), curve(90.0, 60.0), straight(50.0)], step=0.5)
    assert headings[-1] == pytest.approx(math.pi / 2, abs=1e-6)
    steps = np.hypot(*np.diff(points, axis=0).T)
    bends = np.diff(headings) / steps
    assert np.abs(bends).max() == pytest.approx(1 / 60.0, rel=1e-3)
    assert np.abs(np.diff(bends)).max() < 1 / 60.0 / 20.0 * 0.6


@pytest.mark.parametrize("end", [(20.0, 0.2, 0.0), (20.0, 12.0, math.pi / 2), (14.0, -14.0, -math.pi / 2), (25.0, 10.0, math.radians(50))])
def test_a_connection_leaves_and_arrives_in_the_directions_asked_for(end: tuple[float, float, float]) -> None:
    points, headings = connection((0.0, 0.0, 0.0), end)
    assert np.allclose(points[0], (0.0, 0.0))
    assert np.allclose(points[-1], end[:2], atol=1e-3)
    assert (headings[0], headings[-1]) == (pytest.approx(0.0, abs=1e-6), pytest.approx(end[2], abs=1e-3))


def test_a_zone_covers_the_road_between_its_stations() -> None:
    zone = ZoneSpec("school", "school", "south", 20.0, 120.0, facts={"school.present": True}, distance_fact="school.distance", landmark=(30.0, -80.0))
    spec = crossing()
    found = built(StreetsSpec(spec.roads, spec.junctions, (), (zone,))).zones[0]
    assert found.facts == {"school.present": True}
    assert found.polygon[:, 1].max() == pytest.approx(-SETBACK - 20.0)
    assert found.polygon[:, 1].min() == pytest.approx(-SETBACK - 120.0)


@pytest.mark.parametrize(("zone", "said"), [
    (ZoneSpec("z", "school", "west", 0.0, 10.0), "no road 'west'"),
    (ZoneSpec("z", "school", "main", 150.0, 300.0), "200.0 m long"),
    (ZoneSpec("z", "school", "main", 0.0, 10.0, facts={"school.preset": True}), "did you mean school.present"),
])  # fmt: skip
def test_what_does_not_fit_is_named(zone: ZoneSpec, said: str) -> None:
    spec = crossing()
    with pytest.raises(WorldError, match=said):
        built(StreetsSpec(spec.roads, spec.junctions, (), (zone,)))


def test_lanes_for_bicycles_and_for_parking_lie_between_the_lanes_and_the_kerb() -> None:
    road = RoadSpec("main", (Piece(100.0),), bicycle_lane=1.6, parking_lane=2.4)
    lanes = built(StreetsSpec((road,))).lanes
    assert lanes["main.e.1"].right == "main.e.bike"
    assert lanes["main.e.bike"].center[0, 1] == pytest.approx(-3.5 - 0.8)
    assert lanes["main.e.parking"].center[0, 1] == pytest.approx(-3.5 - 1.6 - 1.2)
    assert (lanes["main.e.parking"].right_marking, lanes["main.e.parking"].left) == ("curb", None)
    assert "main.e.parking" not in LaneGraph(built(StreetsSpec((road,)))).neighbors("main.e.1")
