"""Routes and paths along lanes: cheapest ways, lane changes, the next junction, where to stop, and the recorded streets' right turns."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from regdb_runtime.errors import NoRoute
from regdb_runtime.maps.commonroad import read_commonroad
from regdb_runtime.maps.junctions import derive_junctions
from regdb_runtime.maps.lane_path import LanePaths, lane_path, next_junction
from regdb_runtime.maps.lanelet2 import read_lanelet2
from regdb_runtime.maps.road_map import Lane, RoadMap
from regdb_runtime.maps.route import find_route, next_moves, route_along, route_through
from regdb_runtime.maps.sumo_net import read_sumo

DATA = Path(__file__).parent / "data"
SCENARIOS = Path(__file__).resolve().parents[3] / "shared" / "scenarios"
MPH = 0.44704


@pytest.fixture(scope="module")
def junction() -> RoadMap:
    return read_commonroad(DATA / "junction_2020a.xml")


@pytest.fixture(scope="module")
def net() -> RoadMap:
    return read_sumo(DATA / "crossing.net.xml")


def recorded(name: str) -> RoadMap:
    file = SCENARIOS / f"{name}.xml"
    if not file.is_file():
        pytest.skip(f"the recorded scenario is not there: {file}")
    return read_commonroad(file)


def test_a_route_with_its_segments(junction: RoadMap) -> None:
    route = find_route(junction, "10", "30")
    assert route.lanes == ("10", "20", "30")
    assert route.segments == (("13", "10"), ("20",), ("30",))
    assert [route.segment_of(name) for name in ("13", "10", "30", "31")] == [0, 0, 2, None]
    assert route.lanes_on_segment("13") == ("13", "10")
    assert route.lanes_on_segment("31") == ()


def test_a_lane_change_is_made_where_the_marking_lets_one(junction: RoadMap) -> None:
    route = find_route(junction, "13", "30")
    assert route.lanes == ("10", "20", "30"), "the segment is left by lane 10"
    assert (route.changes("13"), route.changes("10"), route.leads_on("13"), route.leads_on("10")) == (-1, 0, False, True)
    solid = {**junction.lanes, "13": replace(junction.lanes["13"], right_marking="solid")}
    with pytest.raises(NoRoute, match="no lanes lead from 13 to 30"):
        find_route(replace(junction, lanes=solid), "13", "30")
    unknown = {**junction.lanes, "13": replace(junction.lanes["13"], right_marking="unknown")}
    assert find_route(replace(junction, lanes=unknown), "13", "30").lanes == route.lanes, "unknown says nothing against it"


def test_lanes_through_a_junction_that_lead_alike_are_one_segment(junction: RoadMap) -> None:
    route = find_route(junction, "10", "31")
    assert route.segments == (("13", "10"), ("23", "21"), ("32", "31"))
    assert route.onward("13") == "23"
    assert route.changes("13") == 0


def test_no_route(junction: RoadMap) -> None:
    for start, goal, told in (("30", "10", "no lanes lead"), ("10", "60", "no lanes lead"), ("10", "nowhere", "lane nowhere is not on the map")):
        with pytest.raises(NoRoute, match=told):
            find_route(junction, start, goal)
    with pytest.raises(NoRoute, match="neither follows lane 10 nor runs beside it"):
        route_along(junction, ("10", "30"))


def test_a_route_through_lanes_fills_in_what_lies_between(junction: RoadMap) -> None:
    assert route_through(junction, ("13", "20", "30")).lanes == ("10", "20", "30")
    assert route_through(junction, ("10",)).lanes == ("10",)


def test_next_turn_and_what_remains(junction: RoadMap) -> None:
    route = find_route(junction, "10", "30")
    turn = route.next_turn("10", 15.0)
    assert turn is not None
    assert (turn.lane, turn.turn, turn.distance) == ("20", "right", 25.0)
    assert route.next_turn("30") is None
    assert route.next_turn("31") is None
    assert route.remaining("10", 15.0) == pytest.approx(25 + junction.lanes["20"].length + 50)
    with pytest.raises(NoRoute, match="lane 31 is not on the route"):
        route.remaining("31", 0.0)


def test_next_moves_name_what_the_route_needs_first(junction: RoadMap) -> None:
    route = find_route(junction, "13", "30")
    assert [(move.kind, move.lane, move.needed) for move in next_moves(junction, route, "13", 10.0)] == [
        ("lane_change_right", "10", True), ("straight", "23", False),
    ]  # fmt: skip
    assert {move.within for move in next_moves(junction, route, "13", 10.0)} == {30.0}
    assert [(move.kind, move.needed) for move in next_moves(junction, route, "10")] == [
        ("right", True), ("lane_change_left", False), ("straight", False),
    ]  # fmt: skip


def test_no_route_runs_on_a_footway(net: RoadMap) -> None:
    with pytest.raises(NoRoute):
        find_route(net, "S_1", "S_0")
    assert find_route(net, "S_1", "on_0").lanes == ("S_1", ":J_1_0", "E_0", ":E_0_0", "on_0")


def test_a_path_has_whole_lanes_and_stays_on_their_centres(junction: RoadMap) -> None:
    route = find_route(junction, "10", "30")
    path = lane_path(junction, route, "20", 30.0, 5.0)
    assert path.lanes == ("10", "20", "30")
    assert path.spans[0].start == 0
    assert path.spans[-1].end == pytest.approx(path.path.length)
    assert all(first.end == second.start for first, second in zip(path.spans, path.spans[1:], strict=False))
    for span in path.spans:
        points = junction.lanes[span.lane].center
        at, off = path.path.project(points, extend=True)
        assert np.abs(off).max() < 0.3
        assert at[0] == pytest.approx(span.start, abs=0.3)
        assert at[-1] == pytest.approx(span.end, abs=0.3)
    assert path.lane_at(1.0).lane == "10"
    assert path.lane_at(path.spans[1].start + 1).lane == "20"
    assert path.lane_at(1e6).lane == "30"
    assert path.span_of("31") is None


def test_a_path_stops_at_the_maps_ends_and_is_built_once(junction: RoadMap) -> None:
    paths = LanePaths(junction)
    route = find_route(junction, "10", "30")
    path = paths.ahead(route, "10", 500.0, 500.0, 20.0)
    assert path.lanes == ("10", "20", "30")
    assert paths.ahead(route, "10", 480.0, 500.0, 25.0) is path


def test_without_a_route_and_off_it_the_path_goes_straight_on(junction: RoadMap) -> None:
    assert lane_path(junction, None, "10", 70.0, 0.0).lanes == ("10", "21", "31")
    route = find_route(junction, "13", "30")
    assert lane_path(junction, route, "13", 70.0, 0.0).lanes == ("13", "23", "32"), "a lane change is needed, until then the lane leads on"


def test_the_next_junction_and_where_to_stop(junction: RoadMap) -> None:
    route = find_route(junction, "10", "30")
    path = lane_path(junction, route, "10", 100.0, 0.0)
    found = next_junction(junction, path, 0.0)
    assert found is not None
    assert (found.id, found.turn, found.control, found.stop_line_marked) == ("70", "right", "signal", True)
    assert found.stop_station == pytest.approx(38.0, abs=0.2), "the line is drawn two metres before the junction"
    assert found.entrance == pytest.approx(40.0, abs=0.3)
    assert found.exit == pytest.approx(path.spans[2].start)
    assert found.lights == ("51",), "the other light speaks to left and straight alone"
    assert found.crosswalks == ("60",)
    assert next_junction(junction, path, found.exit - 0.1) is found
    assert next_junction(junction, path, found.exit + 0.1) is None


def test_lights_by_the_turn(junction: RoadMap) -> None:
    path = lane_path(junction, find_route(junction, "10", "31"), "10", 100.0, 0.0)
    found = next_junction(junction, path, 0.0)
    assert found is not None
    assert (found.turn, found.lights) == ("straight", ("50",))


def test_without_a_line_one_stops_before_the_crosswalk_else_at_the_entrance(junction: RoadMap) -> None:
    bare = {name: replace(lane, stop_line=None) for name, lane in junction.lanes.items()}
    road_map = replace(junction, lanes=bare)
    found = next_junction(road_map, lane_path(road_map, None, "10", 100.0, 0.0), 0.0)
    assert found is not None
    assert found.stop_station == pytest.approx(32.0, abs=0.3)
    assert not found.stop_line_marked
    plain = replace(road_map, crosswalks=())
    again = next_junction(plain, lane_path(plain, None, "10", 100.0, 0.0), 0.0)
    assert again is not None
    assert again.stop_station == again.entrance


def test_a_sumo_signal_on_the_path(net: RoadMap) -> None:
    found = next_junction(net, lane_path(net, find_route(net, "S_1", "on_0"), "S_1", 150.0, 0.0), 0.0)
    assert found is not None
    assert (found.id, found.turn, found.control, found.lights) == ("J", "right", "signal", ("J/3",))
    assert found.crosswalks == (":J_c0_0",)
    assert found.stop_station == found.entrance


def test_a_lanelet2_street_without_a_junction_has_none() -> None:
    street = read_lanelet2(DATA / "street.osm")
    assert next_junction(street, lane_path(street, None, "1001", 80.0, 0.0), 0.0) is None
    assert find_route(street, "1002", "1004").lanes == ("1001", "1004")


def test_peachtrees_right_turns() -> None:
    road_map = recorded("USA_Peach-4_8_T-1")
    for start, inner, goal, light in (("43406", "43646", "43488", "43918"), ("43343", "43640", "43476", "43920")):
        route = find_route(road_map, start, goal)
        assert route.lanes == (start, inner, goal)
        assert [road_map.lanes[name].speed_limit for name in route.lanes] == pytest.approx([35 * MPH, 35 * MPH, 25 * MPH])
        path = lane_path(road_map, route, start, 120.0, 50.0)
        found = next_junction(road_map, path, 0.0)
        assert found is not None
        assert (found.turn, found.control, found.lights, found.stop_line_marked) == ("right", "signal", (light,), True)
        assert found.stop_station == pytest.approx(path.span_of(start).end, abs=0.1)  # type: ignore[union-attr]
        curvature = path.path.curvature(np.arange(0.0, path.path.length, 0.5))
        assert np.abs(curvature).max() < 0.2, "a car of 5 m turning circle can follow it"


def test_peachtrees_ways_straight_through_cross_the_whole_junction() -> None:
    road_map = recorded("USA_Peach-4_8_T-1")
    route = find_route(road_map, "43404", "43341")
    path = lane_path(road_map, route, "43404", 120.0, 0.0)
    found = next_junction(road_map, path, 0.0)
    assert found is not None
    assert found.turn == "straight"
    assert [span.lane for span in path.spans if road_map.lanes[span.lane].junction == found.id] == ["43836", "43636", "43596"]
    left = next_junction(road_map, lane_path(road_map, find_route(road_map, "43402", "43474"), "43402", 80.0, 0.0), 0.0)
    assert left is not None
    assert left.turn == "left"


def unplaced(road_map: RoadMap) -> dict[str, Lane]:
    return {name: replace(lane, junction=None, turn=None) for name, lane in road_map.lanes.items()}


@pytest.mark.parametrize("name", ["USA_Lanker-1_3_T-1", "USA_Peach-4_8_T-1", "USA_Test4WayStopIntersection-1_1_T-1"])
def test_derived_junctions_are_the_named_ones(name: str) -> None:
    road_map = recorded(name)
    derived, (found,) = (lambda pair: (pair[0], list(pair[1].values())))(derive_junctions(unplaced(road_map)))
    (named,) = road_map.junctions.values()
    assert sorted(found.lanes) == sorted(named.lanes)
    assert {lane: derived[lane].turn for lane in found.lanes} == {lane: road_map.lanes[lane].turn for lane in named.lanes}


@pytest.mark.parametrize("name", ["USA_Lanker-1_2_T-1", "USA_Lanker-1_5_T-1", "USA_Lanker-2_4_T-1"])
def test_the_older_maps_of_lankershim_agree_with_the_newer(name: str) -> None:
    old, new = recorded(name), recorded("USA_Lanker-1_3_T-1")
    both = {lane for lane in old.lanes if lane in new.lanes}
    turns = [{lane: (one.lanes[lane].turn, one.lanes[lane].junction is None) for lane in both} for one in (old, new)]
    assert turns[0] == turns[1]
    assert {lane.control for lane in old.lanes.values()} == {"unknown"}


def test_merges_and_forks_of_a_freeway_are_no_junction() -> None:
    assert not recorded("USA_US101-3_3_T-1").junctions
