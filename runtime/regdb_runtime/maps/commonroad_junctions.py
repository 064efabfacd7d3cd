"""CommonRoad intersections: approaches, the lanes within, how each leads and how its entry is regulated."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from regdb_runtime.maps.commonroad_lanes import references
from regdb_runtime.maps.junctions import JunctionSettings, lanes_within, turn_of, turns_within
from regdb_runtime.maps.road_map import Approach, Control, Lane, RoadJunction, Sign, Turn
from regdb_runtime.maps.xml_source import XmlNode

TURNS: Mapping[str, Turn] = {"successorsRight": "right", "successorsStraight": "straight", "successorsLeft": "left"}
STOP_SIGNS = frozenset(("R1-1", "206", "r2"))
ALL_WAY_SIGNS = frozenset(("R1-3",))
"""CommonRoad writes R1-3 for the STOP sign of an all-way stop (its plaque in older editions of the MUTCD)."""
YIELD_SIGNS = frozenset(("R1-2", "205", "r1"))


def place_junctions(
    root: XmlNode, lanes: Mapping[str, Lane], signs: Mapping[str, Sign], notes: list[str]
) -> tuple[dict[str, Lane], dict[str, RoadJunction]]:
    """The lanes with `junction`, `turn` and `control` as the file's `<intersection>`s say, and the junctions."""
    settings = JunctionSettings()
    found, junctions = dict(lanes), {}
    for node in root.all("intersection"):
        turns: dict[str, Turn] = {}
        approaches = []
        for incoming in node.all("incoming"):
            entry = _lanes(incoming, "incomingLanelet", lanes)
            left_of = references(incoming, "isLeftOf")
            approaches.append(Approach(incoming.attribute("id"), entry, left_of[0] if left_of else None))
            for tag, turn in TURNS.items():
                turns.update(dict.fromkeys(_lanes(incoming, tag, lanes), turn))
        entries = [lane for approach in approaches for lane in approach.lanes]
        forgotten = {lane: turn_of(lanes[lane].center, settings) for entry in entries for lane in lanes[entry].successors if lane not in turns}
        begun: dict[str, Turn | None] = {**turns, **forgotten}
        inner = lanes_within(lanes, entries, begun, settings)
        name = node.attribute("id")
        controls = {lane: _control(lanes, lane, signs) for lane in begun}
        for lane, leads in turns_within(lanes, inner, begun).items():
            found[lane] = replace(found[lane], junction=name, turn=leads, control=controls.get(lane, "unknown"))
        junctions[name] = RoadJunction(name, inner, tuple(approaches))
        if node.find("crossing") is not None:
            notes.append(f"<crossing> of {node.where}: its lanelets are crosswalks by their kind alone")
    return found, junctions


def _lanes(node: XmlNode, tag: str, lanes: Mapping[str, Lane]) -> tuple[str, ...]:
    found = references(node, tag)
    for ref in found:
        if ref not in lanes:
            raise node.fail(f"names lanelet {ref} as {tag}, which the file does not define")
    return found


def _control(lanes: Mapping[str, Lane], inner: str, signs: Mapping[str, Sign]) -> Control:
    """How the entry into a lane within is regulated: by what the lanes before it carry; unknown where they carry nothing."""
    before = [lanes[name] for name in lanes[inner].predecessors]
    if any(lane.lights for lane in before):
        return "signal"
    carried = {ref for lane in before for ref in (*lane.signs, *(lane.stop_line.signs if lane.stop_line else ()))}
    codes = {signs[ref].code for ref in carried}
    for control, known in (("all_way_stop", ALL_WAY_SIGNS), ("stop", STOP_SIGNS), ("yield", YIELD_SIGNS)):
        if codes & known:
            return control  # type: ignore[return-value]
    return "unknown"
