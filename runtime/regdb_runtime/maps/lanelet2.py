"""Reads a Lanelet2 map (OSM XML) into a road map; see docs/reference/maps.md for what is taken over."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from regdb_runtime.maps.junctions import approaches, derive_junctions
from regdb_runtime.maps.lanelet2_rules import Rules, read_rules, speed_of
from regdb_runtime.maps.lines import paired, stations, without_repeats
from regdb_runtime.maps.osm_source import OsmMap, Relation, Tags, Way, read_osm
from regdb_runtime.maps.road_map import Control, Crosswalk, Floats, Lane, Marking, RoadJunction, RoadMap, Turn

MARKINGS: Mapping[str, Marking] = {
    "solid": "solid", "dashed": "dashed", "solid_solid": "double_solid", "dashed_dashed": "double_dashed", "solid_dashed": "solid_dashed",
    "dashed_solid": "dashed_solid",
}  # fmt: skip
BORDERS = frozenset(("curbstone", "road_border", "guard_rail", "wall", "fence", "jersey_barrier", "gate", "keepout"))
"""Types of line at which the roadway ends."""
KINDS: Mapping[str, str] = {
    "crosswalk": "crosswalk", "walkway": "sidewalk", "shared_walkway": "sidewalk", "stairs": "sidewalk", "bicycle_lane": "bicycle_lane",
    "bus_lane": "bus_lane", "emergency_lane": "shoulder", "road_shoulder": "shoulder", "highway": "highway", "play_street": "urban",
    "exit": "exit", "pedestrian_lane": "sidewalk",
}  # fmt: skip
USERS: Mapping[str, tuple[str, ...]] = {
    "road": ("vehicle", "bicycle"), "highway": ("vehicle",), "play_street": ("vehicle", "bicycle", "pedestrian"), "bus_lane": ("bus",),
    "bicycle_lane": ("bicycle",), "crosswalk": ("pedestrian",), "walkway": ("pedestrian",), "shared_walkway": ("pedestrian", "bicycle"),
    "stairs": ("pedestrian",), "emergency_lane": ("priority_vehicle",), "exit": ("vehicle", "bicycle"), "pedestrian_lane": ("pedestrian",),
}  # fmt: skip
"""Who may use a lanelet of a subtype where no `participant:` tag says it, by Lanelet2's own defaults."""
TURNS: Mapping[str, Turn] = {"straight": "straight", "left": "left", "right": "right"}


@dataclass(frozen=True)
class _Side:
    """One side of a lanelet: its way, whether the lane runs along the way's order, and its points in the lane's direction."""

    way: Way
    forward: bool
    line: Floats

    @property
    def ends(self) -> tuple[str, str]:
        first, last = self.way.nodes[0], self.way.nodes[-1]
        return (first, last) if self.forward else (last, first)


def read_lanelet2(path: str | Path, origin: tuple[float, float] | None = None) -> RoadMap:
    """The road map of a Lanelet2 file. `origin` (longitude, latitude) fixes (0, 0); by default see `read_osm`. MapError as the other readers."""
    osm = read_osm(path, origin)
    notes = list(osm.notes)
    relations = [item for item in osm.relations.values() if item.tags.get("type") == "lanelet"]
    if not relations:
        raise osm.fail("holds no relation of type lanelet")
    others = sorted({item.tags.get("type", "none") for item in osm.relations.values()} - {"lanelet", "regulatory_element"})
    notes.extend(f"relations of type {kind} are not read" for kind in others)
    sides = {item.id: _sides(osm, item) for item in relations}
    rules = read_rules(osm, relations, notes)
    lanes = {item.id: _lane(item, *sides[item.id], rules, notes) for item in relations}
    lanes = _with_neighbors(_linked(lanes, sides), sides)
    lanes, junctions = _with_junctions(lanes, relations, rules)
    return RoadMap(
        lanes=lanes,
        lights=rules.lights,
        signs=rules.signs,
        crosswalks=tuple(
            Crosswalk(lane.id, np.vstack((lane.left_line, lane.right_line[::-1]))) for lane in lanes.values() if "crosswalk" in lane.kinds
        ),
        origin=osm.origin,
        source=osm.file,
        junctions=junctions,
        notes=tuple(dict.fromkeys(notes)),
    )


def _sides(osm: OsmMap, relation: Relation) -> tuple[_Side, _Side]:
    """Left and right, both in the direction in which the left one lies on the left."""
    ways = []
    for role in ("left", "right"):
        refs = relation.refs(role, "way")
        if len(refs) != 1:
            raise osm.fail(f"lanelet {relation.id} has {len(refs)} ways as its {role} side, it needs one")
        line = osm.line(refs[0])
        if len(line) < 2 or stations(line)[-1] <= 0:
            raise osm.fail(f"way {refs[0]}, the {role} side of lanelet {relation.id}, has less than two different points")
        ways.append((osm.ways[refs[0]], line))
    (left_way, left), (right_way, right) = ways
    along = np.hypot(*(left[0] - right[0])) + np.hypot(*(left[-1] - right[-1]))
    against = np.hypot(*(left[0] - right[-1])) + np.hypot(*(left[-1] - right[0]))
    same = bool(along <= against)
    if not same:
        right = right[::-1]
    forward = _area(np.vstack((left, right[::-1]))) <= 0
    if not forward:
        left, right = left[::-1], right[::-1]
    return _Side(left_way, forward, without_repeats(left)), _Side(right_way, forward == same, without_repeats(right))


def _area(polygon: Floats) -> float:
    """Twice the signed area, positive anticlockwise."""
    x, y = polygon.T
    return float(np.dot(x, np.roll(y, -1)) - np.dot(np.roll(x, -1), y))


def _lane(relation: Relation, left: _Side, right: _Side, rules: Rules, notes: list[str]) -> Lane:
    tags, subtype = relation.tags, relation.tags.get("subtype", "")
    if not subtype:
        notes.append(f"lanelet {relation.id} has no subtype")
    left_line, right_line = paired(left.line, right.line)
    users = _users(tags)
    kinds = {KINDS[subtype]} if subtype in KINDS else set()
    if subtype == "road" and tags.get("location") == "urban":
        kinds.add("urban")
    limits = [speed for text in (tags.get("speed_limit"),) if text and (speed := speed_of(text)) is not None]
    limits += rules.limits.get(relation.id, [])
    if tags.get("speed_limit") and not limits:
        notes.append(f"speed_limit={tags['speed_limit']!r} of lanelet {relation.id} is not read")
    return Lane(
        id=relation.id,
        left_line=left_line,
        right_line=right_line,
        center=(left_line + right_line) / 2,
        speed_limit=min(limits, default=None),
        kinds=frozenset(kinds),
        users=users,
        users_both_ways=users if tags.get("one_way") == "no" else frozenset(),
        left_marking=_marking(left, on_left=True),
        right_marking=_marking(right, on_left=False),
        stop_line=rules.stop_lines.get(relation.id),
        lights=tuple(rules.lane_lights.get(relation.id, ())),
        signs=tuple(rules.lane_signs.get(relation.id, ())),
        road=tags.get("road_id"),
    )


def _users(tags: Tags) -> frozenset[str]:
    named = {key.split(":")[-1]: value for key, value in tags.items() if key.startswith("participant:")}
    if not named:
        return frozenset(USERS.get(tags.get("subtype", ""), ()))
    return frozenset(user for user, value in named.items() if value == "yes")


def _marking(side: _Side, *, on_left: bool) -> Marking:
    """The side's marking, own side first: Lanelet2 names a double line from the left to the right of its way."""
    kind, subtype = side.way.tags.get("type", ""), side.way.tags.get("subtype", "")
    if kind in BORDERS:
        return "curb"
    if kind == "virtual":
        return "none"
    marking: Marking = MARKINGS.get(subtype, "unknown") if kind in ("line_thin", "line_thick") else "unknown"
    own_is_left = on_left != side.forward
    if marking in ("solid_dashed", "dashed_solid") and not own_is_left:
        return "dashed_solid" if marking == "solid_dashed" else "solid_dashed"
    return marking


def _linked(lanes: Mapping[str, Lane], sides: Mapping[str, tuple[_Side, _Side]]) -> dict[str, Lane]:
    """A lanelet follows another where both its sides begin at the nodes where the other's end."""
    begins: dict[tuple[str, str], list[str]] = {}
    ends: dict[tuple[str, str], list[str]] = {}
    for name, (left, right) in sides.items():
        begins.setdefault((left.ends[0], right.ends[0]), []).append(name)
        ends.setdefault((left.ends[1], right.ends[1]), []).append(name)
    found = {}
    for name, (left, right) in sides.items():
        after = tuple(begins.get((left.ends[1], right.ends[1]), ()))
        before = tuple(ends.get((left.ends[0], right.ends[0]), ()))
        found[name] = replace(lanes[name], successors=after, predecessors=before)
    return found


def _with_neighbors(lanes: dict[str, Lane], sides: Mapping[str, tuple[_Side, _Side]]) -> dict[str, Lane]:
    """Lanelets that share a way lie beside each other, in the same direction where one has it left and the other right."""
    users: dict[str, list[tuple[str, bool, bool]]] = {}
    for name, (left, right) in sides.items():
        users.setdefault(left.way.id, []).append((name, True, left.forward))
        users.setdefault(right.way.id, []).append((name, False, right.forward))
    found = dict(lanes)
    for name, (left, right) in sides.items():
        for side, on_left in ((left, True), (right, False)):
            for other, their_left, forward in users[side.way.id]:
                if other == name or "crosswalk" in lanes[other].kinds | lanes[name].kinds:
                    continue
                same = their_left != on_left and forward == side.forward
                opposite = their_left == on_left and forward != side.forward
                if same or opposite:
                    changes = {"left": other, "left_same_direction": same} if on_left else {"right": other, "right_same_direction": same}
                    found[name] = replace(found[name], **changes)  # type: ignore[arg-type]
    return found


def _with_junctions(
    lanes: dict[str, Lane], relations: list[Relation], rules: Rules
) -> tuple[dict[str, Lane], dict[str, RoadJunction]]:
    """Junctions from geometry; a `turn_direction` says that a lanelet lies in one and how it leads."""
    lanes, junctions = derive_junctions(lanes)
    for relation in relations:
        turn = TURNS.get(relation.tags.get("turn_direction", ""))
        if turn is None:
            continue
        lane = lanes[relation.id]
        name = lane.junction or _junction_beside(lane, lanes) or f"junction of {lane.id}"
        lanes[lane.id] = replace(lane, junction=name, turn=turn)
    for name in sorted({lane.junction for lane in lanes.values() if lane.junction is not None}):
        inner = tuple(lane.id for lane in lanes.values() if lane.junction == name)
        junctions[name] = RoadJunction(name, inner, approaches(lanes, inner), derived=True)
        for lane_id in inner:
            lanes[lane_id] = replace(lanes[lane_id], control=_control(lanes, lane_id, rules))
    return lanes, junctions


def _junction_beside(lane: Lane, lanes: Mapping[str, Lane]) -> str | None:
    """The junction of a lane that branches off with this one or ends with it."""
    beside = [name for before in lane.predecessors for name in lanes[before].successors]
    beside += [name for after in lane.successors for name in lanes[after].predecessors]
    return min((found for name in beside if (found := lanes[name].junction) is not None), default=None)


def _control(lanes: Mapping[str, Lane], inner: str, rules: Rules) -> Control:
    """By the rules on the lane itself or on those before it."""
    carrying = (inner, *lanes[inner].predecessors)
    if any(lanes[name].lights for name in carrying):
        return "signal"
    return next((rules.controls[name] for name in carrying if name in rules.controls), "unknown")
