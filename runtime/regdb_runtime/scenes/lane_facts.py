"""What a lane's shape, kind, markings and neighbours say in the law's words."""

from __future__ import annotations

from collections.abc import Mapping

from regdb.vocabulary import Value
from regdb_runtime.maps.junctions import side_by_side
from regdb_runtime.maps.road_map import Lane, Marking, RoadMap, Side, Turn

KINDS: Mapping[str, str] = {
    "bicycle_lane": "bicycle", "bus_lane": "bus", "hov_lane": "hov", "parking": "parking", "two_way_left_turn": "two_way_left_turn",
    "turn_only": "turn_only", "truck_lane": "truck",
}  # fmt: skip
"""The map's kinds of lane that the vocabulary has words for; a lane of other known kinds is `general`."""
NOT_FOR_TRAFFIC = frozenset(("bicycle_lane", "parking", "shoulder", "sidewalk", "crosswalk", "border", "restricted", "walkingarea", "tram", "rail"))
"""Kinds that do not count as lanes for moving traffic."""
PUBLIC = frozenset(("urban", "highway", "interstate", "country", "main_carriage_way", "exit_ramp", "access_ramp", "intersection", "street"))
"""Kinds by which a map says that a lane belongs to a public street."""
FREEWAY = frozenset(("interstate", "freeway", "motorway"))
ON_CENTER: Mapping[Marking, str] = {
    "none": "none", "dashed": "broken_yellow", "double_dashed": "other", "solid": "other", "double_solid": "double_solid_yellow",
    "solid_dashed": "solid_on_right", "dashed_solid": "solid_on_left", "edge": "other", "curb": "other",
}  # fmt: skip
"""A marking between opposite directions, own side first, as a centre marking."""
CROSSED: Mapping[Marking, tuple[str, str]] = {
    "none": ("none", "none"), "dashed": ("broken_white", "broken_yellow"), "double_dashed": ("broken_white", "broken_yellow"),
    "dashed_solid": ("broken_white", "broken_yellow"), "solid": ("solid_white", "solid_yellow"), "edge": ("solid_white", "solid_yellow"),
    "solid_dashed": ("solid_white", "solid_yellow"), "double_solid": ("double_solid_white", "double_solid_yellow"),
}  # fmt: skip
"""A marking as one that is crossed: towards a lane of the same direction (white), of the other one (yellow)."""


def lane_kind(lane: Lane) -> str | None:
    """The lane's kind in the vocabulary's words; None where the map gives it no kind."""
    told = lane.facts.get("lane.kind")
    if isinstance(told, str):
        return told
    for kind in sorted(lane.kinds):
        if kind in KINDS:
            return KINDS[kind]
    return "general" if lane.kinds else None


def is_for_traffic(lane: Lane) -> bool:
    """Whether moving traffic uses the lane: no parking lane, bicycle lane, shoulder or the like."""
    return not lane.kinds & NOT_FOR_TRAFFIC


def beside(road_map: RoadMap, lane: Lane, side: Side) -> Lane | None:
    """The lane next to it in the same direction on one side, None without one."""
    same = lane.left_same_direction if side == "left" else lane.right_same_direction
    name = lane.left if side == "left" else lane.right
    return road_map.lanes.get(name) if same and name is not None else None


def lane_facts(road_map: RoadMap, lane: Lane) -> dict[str, Value]:
    """Facts worked out for one lane; what the map leaves open is left out."""
    row = [road_map.lanes[name] for name in side_by_side(road_map.lanes, lane.id)]
    traffic = [item for item in row if is_for_traffic(item)]
    facts: dict[str, Value] = {"lane.width": float(lane.widths.min())}
    if (kind := lane_kind(lane)) is not None:
        facts["lane.kind"] = kind
    facts["road.lanes_same_direction"] = float(max(1, len(traffic)))
    facts |= _position(traffic, lane) | _special_lanes(row) | _directions(road_map, row, traffic)
    if len(traffic) >= 2:
        facts["road.slow_passing_ok"] = True
    if lane.speed_limit is not None:
        facts |= {"sign.speed_limit": True, "posted.speed": float(lane.speed_limit)}
    return facts


def _position(traffic: list[Lane], lane: Lane) -> dict[str, Value]:
    """Where in the row of lanes for traffic (left to right) the lane lies."""
    names = [item.id for item in traffic]
    if lane.id not in names:
        return {"ego.lane_position": "bicycle_lane"} if "bicycle_lane" in lane.kinds else {}
    place = names.index(lane.id)
    words = {0: "leftmost", len(traffic) - 1: "rightmost"} if len(traffic) > 1 else {0: "only"}
    word = words.get(place, "middle")
    return {"ego.lane_position": word, "ego.lane_from_right": float(len(traffic) - place)}


def _special_lanes(row: list[Lane]) -> dict[str, Value]:
    """Lanes for bicycles, buses or several occupants beside it: told only where there are any."""
    kinds = {lane_kind(item) for item in row}
    words = {"bicycle": "bicycle_lane.present", "bus": "bus_lane.present", "hov": "hov_lane.present"}
    return {fact: True for kind, fact in words.items() if kind in kinds}


def _directions(road_map: RoadMap, row: list[Lane], traffic: list[Lane]) -> dict[str, Value]:
    """Facts of the whole roadway. Without an opposite lane beside it a road may be one-way or divided: only the map's own words tell."""
    leftmost = row[0]
    opposite = road_map.lanes.get(leftmost.left) if leftmost.left is not None and not leftmost.left_same_direction else None
    facts: dict[str, Value] = {}
    if (types := _types(row)) is not None:
        facts["road.types"] = frozenset(types)
    if opposite is None:
        return facts
    others = [road_map.lanes[name] for name in side_by_side(road_map.lanes, opposite.id)]
    opposing = [item for item in others if is_for_traffic(item)]
    facts |= {"road.two_way": True, "road.one_way": False, "road.lanes": float(len(traffic) + len(opposing))}
    facts["road.width"] = float(sum(item.widths.min() for item in (*row, *others)))
    if leftmost.left_marking in ON_CENTER:
        facts["lane.center_marking"] = ON_CENTER[leftmost.left_marking]
    if types is not None and len(traffic) == 1 and len(opposing) == 1:
        facts["road.types"] = frozenset((*types, "two_lane_undivided"))
    return facts


def _types(row: list[Lane]) -> set[str] | None:
    """Kinds of road that the lanes' kinds name; None where they name none."""
    kinds = frozenset().union(*(item.kinds for item in row))
    if not kinds & (PUBLIC | FREEWAY):
        return None
    types = {"highway"}
    if kinds & FREEWAY:
        types.add("freeway")
    if kinds & {"exit_ramp", "access_ramp"}:
        types.add("ramp")
    return types


def types_with_lanes(told: frozenset[str], facts: Mapping[str, Value]) -> frozenset[str]:
    """Kinds of road that the map tells, with `two_lane_undivided` corrected by the lanes that were counted."""
    if facts.get("road.divided") is True or facts.get("road.one_way") is True or facts.get("road.lanes", 2.0) != 2.0:
        return told - {"two_lane_undivided"}
    counted = facts.get("road.types")
    return told | {"two_lane_undivided"} if isinstance(counted, frozenset) and "two_lane_undivided" in counted else told


def target_facts(road_map: RoadMap, own: Lane, target: Lane | None, side: Side | None) -> dict[str, Value]:
    """What the move from one lane to another crosses and enters; without a target, none of both."""
    if target is None or side is None:
        return {"target_lane.kind": "none", "lane.crossed_marking": "none"}
    facts: dict[str, Value] = {}
    if (kind := lane_kind(target)) is not None:
        facts["target_lane.kind"] = kind
    marking = own.left_marking if side == "left" else own.right_marking
    if marking in CROSSED:
        facts["lane.crossed_marking"] = CROSSED[marking][0 if beside(road_map, own, side) is target else 1]
    return facts


def turn_facts(road_map: RoadMap, own: Lane, turn: Turn, told: Mapping[str, Value]) -> dict[str, Value]:
    """What the lane's markings and neighbours mean for a planned movement: `told` are the facts of the lane, `lane.turns` among them."""
    facts: dict[str, Value] = {}
    turns = told.get("lane.turns")
    if isinstance(turns, frozenset):
        facts["lane.turn_marked"] = turn not in turns
        facts["lane.designated_for_turn"] = turn in turns and turn != "straight" and "lane.turns" in own.facts
    side: Side | None = "right" if turn == "right" else "left" if turn in ("left", "u_turn") else None
    if side is None:
        return facts | {"bicycle_lane.beside_turn": False}
    next_to = beside(road_map, own, side)
    if next_to is not None and lane_kind(next_to) == "bicycle":
        facts["bicycle_lane.beside_turn"] = True
    elif "bicycle_lane.beside_turn" in told:
        facts["bicycle_lane.beside_turn"] = told["bicycle_lane.beside_turn"]
    return facts


def place_in_row(road_map: RoadMap, lane: Lane) -> str:
    """`rightmost`, `leftmost` or `other` among the lanes for traffic of its direction; a single lane is both, and so `none`."""
    traffic = [name for name in side_by_side(road_map.lanes, lane.id) if is_for_traffic(road_map.lanes[name])]
    if lane.id not in traffic or len(traffic) == 1:
        return "none"
    return "leftmost" if lane.id == traffic[0] else "rightmost" if lane.id == traffic[-1] else "other"
