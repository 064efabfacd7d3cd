"""What lanes say: places in the row, kinds, markings, counts; and what stays open where the map leaves it open."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from regdb_runtime.maps.road_map import Lane, Marking, RoadMap
from regdb_runtime.scenes.lane_facts import CROSSED, ON_CENTER, lane_facts, place_in_row, target_facts, turn_facts, types_with_lanes
from regdb_runtime.scenes.pieces import LanePieces
from regdb_runtime.worlds.road_builder import build_road_map
from small_worlds import law, road


def built(**road_spec: Any) -> RoadMap:
    return build_road_map(road(**road_spec), law().vocabulary)


def bare(lane_id: str, y: float, width: float = 3.5, **more: Any) -> Lane:
    """A lane of 100 m along y, its middle there, of which nothing else is known."""
    x = np.linspace(0.0, 100.0, 11)
    left, right = np.column_stack((x, np.full(11, y + width / 2))), np.column_stack((x, np.full(11, y - width / 2)))
    return Lane(lane_id, left, right, (left + right) / 2, **more)


def test_the_row_of_lanes() -> None:
    road_map = built(forward=3, backward=2, bicycle_lane=1.5, width=3.4)
    facts = {name: lane_facts(road_map, road_map.lanes[name]) for name in ("main.e.1", "main.e.2", "main.e.3", "main.e.bike", "main.w.1")}
    assert [facts[f"main.e.{n}"]["ego.lane_position"] for n in (1, 2, 3)] == ["rightmost", "middle", "leftmost"]
    assert [facts[f"main.e.{n}"]["ego.lane_from_right"] for n in (1, 2, 3)] == [1.0, 2.0, 3.0]
    assert facts["main.e.1"]["road.lanes_same_direction"] == 3.0
    assert facts["main.w.1"]["road.lanes_same_direction"] == 2.0
    assert facts["main.e.2"]["road.lanes"] == 5.0
    assert facts["main.e.bike"]["lane.kind"] == "bicycle"
    assert facts["main.e.bike"]["ego.lane_position"] == "bicycle_lane"
    assert facts["main.e.1"]["bicycle_lane.present"] is True
    assert facts["main.e.1"]["lane.width"] == pytest.approx(3.4)
    assert facts["main.e.1"]["road.width"] == pytest.approx(5 * 3.4 + 2 * 1.5)
    assert facts["main.e.1"]["posted.speed"] == pytest.approx(15.6464)
    assert facts["main.e.2"]["road.slow_passing_ok"] is True


def test_two_lanes_undivided() -> None:
    narrow = built()
    assert lane_facts(narrow, narrow.lanes["main.e.1"])["road.types"] == {"highway", "two_lane_undivided"}
    wide = built(forward=2, backward=2)
    assert lane_facts(wide, wide.lanes["main.e.1"])["road.types"] == {"highway"}
    told = frozenset(("highway", "two_lane_undivided", "bridge"))
    assert types_with_lanes(told, {"road.lanes": 4.0}) == {"highway", "bridge"}
    assert types_with_lanes(told, {"road.divided": True}) == {"highway", "bridge"}
    both = frozenset(("highway", "two_lane_undivided"))
    assert types_with_lanes(frozenset(("highway",)), {"road.types": both}) == both


@pytest.mark.parametrize(("marking", "word"), sorted(ON_CENTER.items()))
def test_the_centre_marking_is_told_with_its_own_side_first(marking: Marking, word: str) -> None:
    ours = bare("ours", -1.75, kinds=frozenset(("urban",)), left="theirs", left_marking=marking)
    theirs = bare("theirs", 1.75, kinds=frozenset(("urban",)), left="ours")
    assert lane_facts(RoadMap({"ours": ours, "theirs": theirs}), ours)["lane.center_marking"] == word


def test_an_unknown_centre_marking_stays_unknown() -> None:
    ours, theirs = bare("ours", -1.75, left="theirs"), bare("theirs", 1.75, left="ours")
    facts = lane_facts(RoadMap({"ours": ours, "theirs": theirs}), ours)
    assert "lane.center_marking" not in facts
    assert "lane.kind" not in facts
    assert "road.types" not in facts
    assert facts["road.two_way"] is True


def test_a_lane_alone_may_be_one_way_or_half_of_a_divided_road() -> None:
    facts = lane_facts(RoadMap({"a": bare("a", 0.0)}), bare("a", 0.0))
    assert not {"road.one_way", "road.two_way", "road.lanes", "road.width", "lane.center_marking", "posted.speed"} & set(facts)


@pytest.mark.parametrize("marking", sorted(CROSSED))
def test_what_a_change_of_lane_crosses(marking: Marking) -> None:
    right = bare("right", -3.5, kinds=frozenset(("urban",)), left="left", left_same_direction=True, left_marking=marking)
    left = bare("left", 0.0, kinds=frozenset(("urban",)), right="right", right_same_direction=True, left="other", left_marking=marking)
    other = bare("other", 3.5, kinds=frozenset(("bicycle_lane",)), left="left")
    road_map = RoadMap({lane.id: lane for lane in (right, left, other)})
    white, yellow = CROSSED[marking]
    assert target_facts(road_map, right, left, "left") == {"target_lane.kind": "general", "lane.crossed_marking": white}
    assert target_facts(road_map, left, other, "left") == {"target_lane.kind": "bicycle", "lane.crossed_marking": yellow}
    assert target_facts(road_map, left, None, None) == {"target_lane.kind": "none", "lane.crossed_marking": "none"}


def test_an_unknown_marking_and_kind_of_a_target_stay_unknown() -> None:
    lanes = {"a": bare("a", 0.0, left="b", left_same_direction=True), "b": bare("b", 3.5)}
    assert target_facts(RoadMap(lanes), lanes["a"], lanes["b"], "left") == {}


def test_turn_lanes_and_the_bicycle_lane_beside_a_turn() -> None:
    road_map = built(forward=2, bicycle_lane=1.5)
    told = {"lane.turns": frozenset(("right",)), "bicycle_lane.beside_turn": False}
    marked = replace(road_map.lanes["main.e.1"], facts={"lane.turns": frozenset(("right",))})
    assert turn_facts(road_map, marked, "straight", told)["lane.turn_marked"] is True
    right = turn_facts(road_map, marked, "right", told)
    assert (right["lane.turn_marked"], right["lane.designated_for_turn"], right["bicycle_lane.beside_turn"]) == (False, True, True)
    assert turn_facts(road_map, road_map.lanes["main.e.2"], "left", told)["bicycle_lane.beside_turn"] is False
    assert "lane.turn_marked" not in turn_facts(road_map, marked, "right", {})


def test_place_in_row() -> None:
    road_map = built(forward=3)
    assert [place_in_row(road_map, road_map.lanes[f"main.e.{n}"]) for n in (1, 2, 3)] == ["rightmost", "other", "leftmost"]
    single = built()
    assert place_in_row(single, single.lanes["main.e.1"]) == "none"


def test_the_map_says_one_way_where_it_says_undivided_and_no_lane_comes_back() -> None:
    lane = bare("a", 0.0, kinds=frozenset(("urban",)))
    undivided = LanePieces(RoadMap({"a": lane}, facts={"road.divided": False}), {}, {}).facts_of(lane)
    assert (undivided["road.one_way"], undivided["road.two_way"], undivided["road.lanes"]) == (True, False, 1.0)
    assert "road.one_way" not in LanePieces(RoadMap({"a": lane}), {}, {}).facts_of(lane)


def test_a_lane_s_own_facts_stand_before_what_is_worked_out() -> None:
    lane = bare("a", 0.0, kinds=frozenset(("urban",)), facts={"lane.kind": "hov", "road.one_way": True}, speed_limit=20.0)
    facts = LanePieces(RoadMap({"a": lane}, facts={"road.grade": 0.04, "lane.kind": "general"}), {}, {}).facts_of(lane)
    assert (facts["lane.kind"], facts["road.one_way"], facts["road.grade"], facts["posted.speed"]) == ("hov", True, 0.04, 20.0)
