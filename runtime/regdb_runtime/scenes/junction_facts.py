"""What the map says of the junction ahead, before its line, past it, and where there is none."""

from __future__ import annotations

from collections.abc import Mapping

from regdb.vocabulary import Value
from regdb_runtime.maps.junctions import side_by_side
from regdb_runtime.maps.lane_path import Junction
from regdb_runtime.maps.road_map import Lane, RoadMap, Turn
from regdb_runtime.scenes.crossing import Way
from regdb_runtime.scenes.light_facts import NO_SIGNAL
from regdb_runtime.scenes.stretch import Stage

CONTROL: Mapping[str, str] = {"signal": "signal", "stop": "stop_ego", "all_way_stop": "stop_all", "yield": "yield_ego", "none": "none"}
"""A map's control of one entry as the vehicle sees it; of `none` the crossing entries may say more."""
NO_SIGNS: Mapping[str, Value] = {"sign.stop": False, "sign.yield": False, "sign.all_way": False, "stop_line.present": False}
"""Where nothing makes anybody stop: the map has its stop lines and entries at junctions."""
NO_JUNCTION: Mapping[str, Value] = {
    "intersection.present": False, "ego.in_intersection": False, "signal.present": False, "signal.place": "none", **NO_SIGNS, **NO_SIGNAL,
}  # fmt: skip


def junction_facts(
    road_map: RoadMap, junction: Junction, inner: Lane, approach: Lane | None, ways: tuple[Way, ...], stage: Stage
) -> dict[str, Value]:
    """Facts of a junction on a stage of the way through it. `inner`: the planned lane within; `ways`: those that meet it.

    Past the line its lights and signs no longer face the vehicle.
    """
    if stage == "road":
        return dict(NO_JUNCTION)
    shape = _shape(road_map, inner, approach, ways)
    own = {name: value for name, value in inner.facts.items() if name.startswith("intersection.")}
    crosses = inner.junction is not None  # a signal between junctions has no lane within one
    facts: dict[str, Value] = {"intersection.present": crosses, **shape, **_control(road_map, junction, ways), **own}
    if stage == "inside":
        past = {**NO_SIGNS, **NO_SIGNAL, "signal.present": False, "signal.place": "none"}
        return facts | past | {"ego.in_intersection": crosses, "intersection.distance": 0.0}
    facts |= {"ego.in_intersection": False, "stop_line.present": junction.stop_line_marked}
    if junction.control != "unknown":
        facts |= {
            "sign.stop": junction.control in ("stop", "all_way_stop"), "sign.all_way": junction.control == "all_way_stop",
            "sign.yield": junction.control == "yield",
        }  # fmt: skip
    if junction.control == "signal" or junction.lights:
        facts |= {"signal.present": True, "signal.place": "intersection" if crosses else "midblock"}
    elif junction.control != "unknown":
        facts |= {"signal.present": False, "signal.place": "none", **NO_SIGNAL}
    return facts


def _control(road_map: RoadMap, junction: Junction, ways: tuple[Way, ...]) -> dict[str, Value]:
    word = CONTROL.get(junction.control)
    if word is None:
        return {}
    if word == "none":
        crossing = {road_map.lanes[way.lane].control for way in ways if way.comes_from == "cross"}
        if crossing & {"stop"}:
            word = "stop_cross"
        elif crossing & {"yield"}:
            word = "yield_cross"
        elif "unknown" in crossing:
            return {}
    return {"intersection.control": word}


def _shape(road_map: RoadMap, inner: Lane, approach: Lane | None, ways: tuple[Way, ...]) -> dict[str, Value]:
    """Whether the vehicle's own highway, or the crossing one, ends here: nobody from it can go straight on."""
    if approach is None or inner.turn is None:
        return {}
    own = {road_map.lanes[name].turn for lane in side_by_side(road_map.lanes, approach.id) for name in road_map.lanes[lane].successors}
    facts: dict[str, Value] = {"intersection.highway_terminates": "straight" not in own}
    crossing = {way.entry for way in ways if way.comes_from == "cross" and way.entry}
    turns = {
        road_map.lanes[name].turn
        for entry in crossing for lane in side_by_side(road_map.lanes, entry) for name in road_map.lanes[lane].successors
    }  # fmt: skip
    if crossing:
        facts["intersection.crossing_highway_terminates"] = "straight" not in turns
    return facts


def destination_facts(facts_of_exit: Mapping[str, Value], turn: Turn) -> dict[str, Value]:
    """Whether the road that a turn leads into is one-way."""
    one_way = facts_of_exit.get("road.one_way")
    return {"plan.destination_one_way": one_way} if turn != "straight" and isinstance(one_way, bool) else {}
