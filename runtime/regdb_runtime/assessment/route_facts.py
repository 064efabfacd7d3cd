"""Facts of a manoeuvre that all its plans share: the turn it makes or prepares, the lanes from and into which, and why it would stop."""

from __future__ import annotations

from collections.abc import Mapping

from regdb.vocabulary import Value
from regdb_runtime.assessment.cross_section import Roads, Strip
from regdb_runtime.maneuver import Junction, LanePath, Maneuver
from regdb_runtime.maps.road_map import Lane

PREPARES: Mapping[str, str] = {"left": "left", "right": "right", "u_turn": "u_turn"}
NO_LANE_FOR_CARS: frozenset[str] = frozenset(("bicycle_lane", "parking", "bus_lane", "tram", "sidewalk", "shoulder", "border", "crosswalk"))
"""Kinds of lane that do not count when it is asked which lane is the outermost (vocabulary, ego.lane_from_right)."""


def shared_facts(maneuver: Maneuver, roads: Roads | None) -> dict[str, Value]:
    """Facts of the plan that do not depend on its motion."""
    facts: dict[str, Value] = {"plan.stop_reason": _stop_reason(maneuver), "plan.turn_purpose": "none", "plan.prepares_turn": "none"}
    junction = maneuver.junction
    if junction is None or junction.turn == "straight":
        return facts
    facts["plan.prepares_turn"] = PREPARES[junction.turn]
    if turns(maneuver):
        facts["plan.turn_purpose"] = "u_turn" if junction.turn == "u_turn" else "intersection"
        if roads is not None:
            facts |= _lanes(maneuver.lane_path, junction, roads)
    return facts


def turns(maneuver: Maneuver) -> bool:
    """Whether the manoeuvre itself is the turn, by the last word of the state it goes to (`turn_left`, `turn_right`, `u_turn`)."""
    return "turn" in maneuver.next.rpartition(".")[2].split("_")


def _stop_reason(maneuver: Maneuver) -> str:
    if maneuver.goal.stop is not None:
        return "required_by_law"
    return "avoid_harm" if maneuver.goal.follow is not None else "none"


def _lanes(lane_path: LanePath, junction: Junction, roads: Roads) -> dict[str, Value]:
    """The lanes that the turn leads from and into, where the path and the map say them."""
    found: dict[str, Value] = {}
    lanes = roads.road_map.lanes
    for fact, station in (("plan.turn_lane", junction.entrance - 0.5), ("plan.exit_lane", junction.exit + 0.5)):
        if lane_path.path.start <= station <= lane_path.spans[-1].end:
            lane = lanes.get(lane_path.lane_at(station).lane)
            if lane is not None and lane.junction is None:
                found[fact] = outermost(lane, roads.strips(lane), to_right=junction.turn == "right")
    return found


def outermost(lane: Lane, strips: tuple[Strip, ...], *, to_right: bool) -> str:
    """`rightmost`, `leftmost` or `other`, among the lanes for cars of its direction; the only lane is what the turn asks for."""
    ours = [strip.lane.id for strip in strips if strip.same_direction and (strip.lane is lane or not strip.lane.kinds & NO_LANE_FOR_CARS)]
    words = {"rightmost": ours[0] == lane.id, "leftmost": ours[-1] == lane.id}
    for asked in ("rightmost", "leftmost") if to_right else ("leftmost", "rightmost"):
        if words[asked]:
            return asked
    return "other"
