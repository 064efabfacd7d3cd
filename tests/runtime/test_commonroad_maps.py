"""Reading CommonRoad XML: what is taken over, from a fixture of each version, and what a wrong file is told."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from regdb_runtime.errors import MapError
from regdb_runtime.maps.commonroad import read_commonroad
from regdb_runtime.maps.commonroad_traffic import read_traffic
from regdb_runtime.maps.road_map import Phase, RoadMap

DATA = Path(__file__).parent / "data"
NEW, OLD = DATA / "junction_2020a.xml", DATA / "crossing_2018b.xml"


@pytest.fixture(scope="module")
def new() -> RoadMap:
    return read_commonroad(NEW)


def test_geometry_is_the_files(new: RoadMap) -> None:
    lane = new.lanes["10"]
    assert lane.left_line.tolist() == [[0, -50], [0, -10]]
    assert lane.right_line.tolist() == [[3.5, -50], [3.5, -10]]
    assert lane.center.tolist() == [[1.75, -50], [1.75, -10]]
    assert lane.length == 40
    assert lane.widths.tolist() == [3.5, 3.5]


def test_sides_of_unequal_points_get_the_points_of_both(new: RoadMap) -> None:
    lane = new.lanes["22"]
    assert lane.left_line.tolist() == [[-10, 0], [0, 0], [10, 0]]
    assert lane.right_line.tolist() == [[-10, -3.5], [0, -3.5], [10, -3.5]]
    assert any("lanelet 22" in note for note in new.notes)


def test_links_neighbours_kinds_and_users(new: RoadMap) -> None:
    lane = new.lanes["10"]
    assert lane.successors == ("20", "21")
    assert (lane.left, lane.left_same_direction, lane.right) == ("13", True, None)
    assert (new.lanes["13"].left, new.lanes["13"].left_same_direction) == ("11", False)
    assert lane.kinds == {"urban"}
    assert lane.users == {"vehicle"}
    assert new.lanes["60"].users_both_ways == {"pedestrian"}


def test_markings_are_the_drivers_and_shared_between_neighbours(new: RoadMap) -> None:
    assert (new.lanes["10"].left_marking, new.lanes["10"].right_marking) == ("dashed", "curb")
    assert new.lanes["13"].right_marking == "dashed", "the line is marked for lane 10 alone"
    assert new.lanes["13"].left_marking == "dashed_solid", "solid on the far side, dashed on the own"
    assert new.lanes["11"].left_marking == "solid_dashed", "the same line from across"
    assert (new.lanes["12"].left_marking, new.lanes["12"].right_marking) == ("none", "solid")
    assert new.lanes["31"].left_marking == "solid", "unknown here, solid for the neighbour"
    assert new.lanes["30"].left_marking == "unknown"


def test_signs_plates_and_limits(new: RoadMap) -> None:
    assert new.lanes["10"].signs == ("40", "40/2")
    assert (new.signs["40"].code, new.signs["40"].speed, new.signs["40"].position) == ("R2-1", 15.6464, (4.0, -30.0))
    assert (new.signs["40/2"].code, new.signs["40/2"].speed) == ("R10-11", None)
    assert [new.lanes[name].speed_limit for name in ("10", "20", "30")] == [15.6464, None, 11.176]


def test_lights_speak_to_movements_and_have_a_nominal_plan(new: RoadMap) -> None:
    light = new.lights["50"]
    assert (light.direction, light.active, light.arrow, light.position) == ("left_straight", True, False, (5.0, 12.0))
    assert light.cycle == (Phase("green", 30.0), Phase("yellow", 3.0), Phase("red", 27.0))
    assert light.offset == 10.0
    other = new.lights["51"]
    assert (other.direction, other.active, other.arrow, other.cycle) == ("right", False, True, ())
    assert any("nominal" in note for note in new.notes)


def test_stop_lines_stand_where_they_are_drawn_else_at_the_lanes_end(new: RoadMap) -> None:
    drawn, implied = new.lanes["10"].stop_line, new.lanes["13"].stop_line
    assert drawn is not None
    assert (drawn.start, drawn.end, drawn.lights, drawn.marked) == ((-3.5, -12.0), (3.5, -12.0), ("50",), True)
    assert implied is not None
    assert (implied.start, implied.end) == ((-3.5, -10.0), (0.0, -10.0))


def test_the_intersection_places_its_lanes(new: RoadMap) -> None:
    inner = {name: (lane.turn, lane.control) for name, lane in new.lanes.items() if lane.junction == "70"}
    assert inner == {"20": ("right", "signal"), "21": ("straight", "signal"), "23": ("straight", "signal"), "22": ("straight", "stop")}
    junction = new.junctions["70"]
    assert [(part.lanes, part.left_of) for part in junction.approaches] == [(("10", "13"), "72"), (("12",), None)]
    assert not junction.derived


def test_crosswalks_and_place(new: RoadMap) -> None:
    (walk,) = new.crosswalks
    assert walk.id == "60"
    assert walk.polygon.tolist() == [[-4, -15], [4, -15], [4, -18], [-4, -18]]
    assert new.origin == (-84.38, 33.78)


def test_2018b_has_limits_and_its_junction_is_derived() -> None:
    old = read_commonroad(OLD)
    assert [old.lanes[name].speed_limit for name in ("1", "2", "3")] == [13.4112, 13.4112, None]
    (junction,) = old.junctions.values()
    assert junction.derived
    turns = {name: lane.turn for name, lane in old.lanes.items() if lane.junction is not None}
    assert turns == {"3": "straight", "4": "straight", "5": "straight", "6": "right"}
    assert {old.lanes[name].control for name in turns} == {"unknown"}, "nobody said that there are no lights"
    assert not old.lights
    assert any("derived" in note for note in old.notes)


def test_recorded_obstacles() -> None:
    traffic = read_traffic(NEW)
    parked, car = traffic.obstacles
    assert (parked.kind, parked.source_kind, parked.static) == ("car", "parkedVehicle", True)
    assert (parked.x[0], parked.y[0], parked.heading[0]) == (21.0, -8.0, 0.5), "the shape's own middle and direction"
    assert (car.length, car.width, car.steps.tolist()) == (4.5, 1.8, [0, 1, 2])
    np.testing.assert_allclose(np.column_stack((car.x, car.y, car.heading, car.speed)),
                               [[-40, -1.75, 0, 10], [-39, -1.75, 0.1, 10.2], [-38, -1.75, 0.2, 10.4]])  # fmt: skip
    assert np.isnan(car.acceleration).all()
    assert car.turn_signals == ("left", "left", "left")
    assert len(traffic.notes) == 2, "a region and an interval were taken at their middle"


def test_tracks_of_a_step() -> None:
    traffic = read_traffic(NEW)
    parked, car = traffic.tracks_at(1)
    assert (car.x, car.speed, car.turn_signal) == (-39, 10.2, "left")
    assert car.acceleration == pytest.approx(2.0)
    assert car.yaw_rate == pytest.approx(1.0)
    assert (parked.speed, parked.acceleration) == (0.0, 0.0)
    assert [track.id for track in traffic.tracks_at(3)] == ["80"], "the car is gone, what stands stays"
    assert traffic.tracks_at(1, leave_out=frozenset(("81",)))[0].id == "80"
    assert traffic.last_step == 2


def test_planning_problem() -> None:
    (problem,) = read_traffic(NEW).problems
    assert (problem.id, problem.step, problem.x, problem.y, problem.speed) == ("90", 0, 1.75, -45, 12)
    (goal,) = problem.goals
    assert (goal.steps, goal.speed, goal.heading, goal.lanes) == ((50, 80), (5, 12), None, ("30",))


def test_obstacles_of_2018b() -> None:
    traffic = read_traffic(OLD)
    barrel, bicycle = traffic.obstacles
    assert (barrel.kind, barrel.length, barrel.static) == ("obstacle", 0.8, True)
    assert (bicycle.kind, bicycle.static, bicycle.steps.tolist(), bicycle.acceleration.tolist()) == ("bicycle", False, [3], [0.5])
    assert traffic.time_step == 0.2


WRONG = {
    "twice": ('<lanelet id="11">', '<lanelet id="10">', "lanelet 10 is there twice"),
    "successor": ('<successor ref="20"/>', '<successor ref="999"/>', "lanelet 10 names lanelet 999 as successor"),
    "neighbour": ('<adjacentLeft ref="13"', '<adjacentLeft ref="77"', "names lanelet 77 as adjacentLeft"),
    "direction": ('ref="13" drivingDir="same"', 'ref="13" drivingDir="sideways"', "drivingDir='sideways'"),
    "not a number": ("<x>0</x><y>-50</y>", "<x>zero</x><y>-50</y>", "'zero', which is no number"),
    "nan": ("<x>0</x><y>-50</y>", "<x>nan</x><y>-50</y>", "no finite number"),
    "one point": ("<point><x>0</x><y>-50</y></point>", "", "leftBound of lanelet 10 has 1 points"),
    "one spot": ("<x>0</x><y>-50</y>", "<x>0</x><y>-10</y>", "all its points on one spot"),
    "no bound": ("leftBound", "oldBound", "lanelet 10 has no <leftBound>"),
    "sign": ('<trafficSignRef ref="41"/>', '<trafficSignRef ref="400"/>', "lanelet 12, which names sign 400"),
    "light": ('<trafficLightRef ref="51"/>', '<trafficLightRef ref="500"/>', "lanelet 10, which names light 500"),
    "incoming": ('<incomingLanelet ref="12"/>', '<incomingLanelet ref="120"/>', "incoming 72 names lanelet 120"),
    "marking": ("<lineMarking>curb</lineMarking>", "<lineMarking>zigzag</lineMarking>", "'zigzag', which is no marking"),
    "colour": ("<color>red</color>", "<color>blue</color>", "'blue', which is no colour"),
    "light direction": ("<direction>right</direction>", "<direction>up</direction>", "'up', which is no direction"),
    "version": ('commonRoadVersion="2020a"', 'commonRoadVersion="1999"', "version 1999, this reader knows 2018b and 2020a"),
    "root": ("commonRoad", "openRoad", "the root element is <openRoad>"),
    "stop line": ("<point><x>-3.5</x><y>-12</y></point>", "", "stopLine of lanelet 10 has 1 points"),
}


@pytest.mark.parametrize(("here", "there", "told"), WRONG.values(), ids=WRONG)
def test_a_wrong_map_is_told_in_one_sentence(tmp_path: Path, here: str, there: str, told: str) -> None:
    text = NEW.read_text()
    assert here in text
    file = tmp_path / "wrong.xml"
    count = -1 if here in ("commonRoad", "leftBound") else 1
    file.write_text(text.replace(here, there, count))
    with pytest.raises(MapError) as caught:
        read_commonroad(file)
    assert told in str(caught.value)
    assert str(file) in str(caught.value)
    assert "\n" not in str(caught.value)


WRONG_TRAFFIC = {
    "shape": ("<circle><radius>0.4</radius></circle>", "", "shape of obstacle 20 has no <rectangle>"),
    "size": ("<radius>0.4</radius>", "<radius>-1</radius>", "has a size of -1 m"),
    "role": ("<role>dynamic</role>", "<role>ghost</role>", "the role 'ghost'"),
    "state": ("initialState", "state", "has no <initialState>"),
    "speed": ("<exact>4</exact>", "<exact>inf</exact>", "no finite number"),
}


@pytest.mark.parametrize(("here", "there", "told"), WRONG_TRAFFIC.values(), ids=WRONG_TRAFFIC)
def test_wrong_traffic_is_told(tmp_path: Path, here: str, there: str, told: str) -> None:
    text = OLD.read_text()
    assert here in text
    file = tmp_path / "wrong.xml"
    file.write_text(text.replace(here, there))
    with pytest.raises(MapError, match=told):
        read_traffic(file)


def test_states_out_of_order_are_told(tmp_path: Path) -> None:
    file = tmp_path / "wrong.xml"
    file.write_text(NEW.read_text().replace("<time><exact>2</exact></time>", "<time><exact>1</exact></time>"))
    with pytest.raises(MapError, match="dynamicObstacle 81 has states that do not follow each other in time"):
        read_traffic(file)


def test_a_truncated_file_and_a_missing_one_are_told(tmp_path: Path) -> None:
    file = tmp_path / "half.xml"
    file.write_text(NEW.read_text()[:3000])
    with pytest.raises(MapError, match="is not well-formed XML"):
        read_commonroad(file)
    with pytest.raises(MapError, match="cannot be read: No such file"):
        read_commonroad(tmp_path / "none.xml")
    file.write_text('<commonRoad commonRoadVersion="2020a" timeStepSize="0.1"/>')
    with pytest.raises(MapError, match="holds no <lanelet>"):
        read_commonroad(file)


def test_a_stop_lines_idle_reference_is_noted_and_left_out(tmp_path: Path) -> None:
    file = tmp_path / "idle.xml"
    marked = "<lineMarking>solid</lineMarking>"
    file.write_text(NEW.read_text().replace(f'{marked}<trafficLightRef ref="50"/>', f'{marked}<trafficLightRef ref="5"/>'))
    road_map = read_commonroad(file)
    line = road_map.lanes["10"].stop_line
    assert line is not None
    assert line.lights == ()
    assert any("light 5" in note for note in road_map.notes)
