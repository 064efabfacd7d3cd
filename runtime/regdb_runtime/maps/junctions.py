"""Junctions found from the lanes' geometry, for maps that name none: lanes that cross, with the turns their courses make."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from regdb_runtime.maps.lines import crossing, turned
from regdb_runtime.maps.road_map import Approach, Floats, Lane, RoadJunction, Turn


@dataclass(frozen=True, slots=True)
class JunctionSettings:
    """When a lane turns and when two lanes cross. Radians and metres; the values agree with every turn named in the recorded maps at hand."""

    turn_from: float = math.radians(35)
    u_turn_from: float = math.radians(150)
    cross_from: float = math.radians(15)
    clear_of_ends: float = 0.5
    """Crossings nearer than this to a lane's end are two lanes that meet, not two that cross."""


def turn_of(center: Floats, settings: JunctionSettings) -> Turn:
    """How a centre line (n, 2) leads, by how far it turns between its ends."""
    angle = turned(center)
    if abs(angle) >= settings.u_turn_from:
        return "u_turn" if angle > 0 else "right"
    if abs(angle) < settings.turn_from:
        return "straight"
    return "left" if angle > 0 else "right"


def derive_junctions(lanes: Mapping[str, Lane], settings: JunctionSettings | None = None) -> tuple[dict[str, Lane], dict[str, RoadJunction]]:
    """The lanes with `junction` and `turn` where lanes cross each other, and the junctions they form.

    Two lanes that share neither neighbour nor link and whose centres cross at an angle lie within one junction; lanes that branch from
    the same lane as such a one, or end in the same, lie in it too, where both begin and end like it. Merges and forks alone are none.
    """
    settings = settings or JunctionSettings()
    groups = _groups(lanes, _crossings(lanes, settings))
    junctions: dict[str, RoadJunction] = {}
    found = dict(lanes)
    for group in groups:
        name = f"junction of {group[0]}"
        for lane in group:
            found[lane] = replace(lanes[lane], junction=name, turn=turn_of(lanes[lane].center, settings))
        junctions[name] = RoadJunction(name, tuple(group), approaches(lanes, group), derived=True)
    return found, junctions


def approaches(lanes: Mapping[str, Lane], inner: Iterable[str]) -> tuple[Approach, ...]:
    """The lanes that lead into a junction, side by side ones together."""
    within = set(inner)
    entries = sorted({lane for name in within for lane in lanes[name].predecessors if lane not in within})
    grouped: list[Approach] = []
    taken: set[str] = set()
    for lane in entries:
        if lane in taken:
            continue
        beside = [name for name in side_by_side(lanes, lane) if name in entries]
        taken.update(beside)
        grouped.append(Approach(beside[0], tuple(beside)))
    return tuple(grouped)


def side_by_side(lanes: Mapping[str, Lane], lane: str) -> tuple[str, ...]:
    """All lanes beside a lane in its own direction, with itself, from left to right."""
    row = [lane]
    while (left := lanes[row[0]].left) is not None and lanes[row[0]].left_same_direction and left in lanes and left not in row:
        row.insert(0, left)
    while (right := lanes[row[-1]].right) is not None and lanes[row[-1]].right_same_direction and right in lanes and right not in row:
        row.append(right)
    return tuple(row)


def _crossings(lanes: Mapping[str, Lane], settings: JunctionSettings) -> list[tuple[str, str]]:
    names = sorted(name for name, lane in lanes.items() if not lane.kinds & {"crosswalk", "sidewalk"})
    boxes = {name: np.concatenate((lanes[name].center.min(axis=0), lanes[name].center.max(axis=0))) for name in names}
    pairs = []
    for place, first in enumerate(names):
        for second in names[place + 1 :]:
            a, b = boxes[first], boxes[second]
            if (a[:2] <= b[2:]).all() and (b[:2] <= a[2:]).all() and _cross(lanes[first], lanes[second], settings):
                pairs.append((first, second))
    return pairs


def _cross(first: Lane, second: Lane, settings: JunctionSettings) -> bool:
    links = {first.left, first.right, *first.predecessors, *first.successors}
    if second.id in links or set(first.predecessors) & set(second.predecessors) or set(first.successors) & set(second.successors):
        return False
    place = crossing(first.center, second.center)
    if place is None:
        return False
    for lane, station in zip((first, second), place, strict=True):
        if not settings.clear_of_ends < station < lane.length - settings.clear_of_ends:
            return False
    angle = _heading(first, place[0]) - _heading(second, place[1])
    return abs(math.sin(angle)) > math.sin(settings.cross_from)


def _heading(lane: Lane, station: float) -> float:
    row = int(np.clip(np.searchsorted(lane.stations, station) - 1, 0, len(lane.center) - 2))
    dx, dy = lane.center[row + 1] - lane.center[row]
    return math.atan2(dy, dx)


def _groups(lanes: Mapping[str, Lane], pairs: list[tuple[str, str]]) -> list[list[str]]:
    """Lanes joined by crossings, with those that run from an approach to an exit of the same junction."""
    leader: dict[str, str] = {}

    def find(name: str) -> str:
        while leader[name] != name:
            name = leader[name]
        return name

    for first, second in pairs:
        for name in (first, second):
            leader.setdefault(name, name)
        one, other = sorted((find(first), find(second)))
        leader[other] = one
    groups: dict[str, list[str]] = {}
    for name in sorted(leader):
        groups.setdefault(find(name), []).append(name)
    return [_completed(lanes, group) for _, group in sorted(groups.items())]


def _completed(lanes: Mapping[str, Lane], group: list[str]) -> list[str]:
    entries = {lane for name in group for lane in lanes[name].predecessors}
    exits = {lane for name in group for lane in lanes[name].successors}
    entries |= {beside for lane in entries for beside in side_by_side(lanes, lane)}
    exits |= {beside for lane in exits for beside in side_by_side(lanes, lane)}
    more = {name for lane in entries for name in lanes[lane].successors if set(lanes[name].successors) & exits and name not in exits}
    return sorted(set(group) | more)
