"""Junctions found from the lanes' geometry, for maps that name none: lanes that cross, with the turns their courses make."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from regdb_runtime.maps.lines import crossing, turned
from regdb_runtime.maps.road_map import Approach, Floats, Lane, RoadJunction, Turn


@dataclass(frozen=True, slots=True)
class JunctionSettings:
    """When a lane turns and when two lanes cross. Radians and metres; the values agree with the turns
    named in the recorded maps at hand, save where a road itself bends in its junction."""

    turn_from: float = math.radians(35)
    u_turn_from: float = math.radians(150)
    cross_from: float = math.radians(15)
    clear_of_ends: float = 0.5
    """Crossings nearer than this to a lane's end are two lanes that meet, not two that cross."""
    longest: float = 80.0
    """A junction's lanes begin within this distance from its entrance."""
    longest_head: float = 40.0
    """The first crossing lies within this distance from the entrance."""


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

    Two lanes that share neither neighbour nor link and whose centres cross at an angle lie within one junction. Back from there it begins
    where the lanes side by side lead apart; see `lanes_within` for how far it goes. Merges and forks alone are none.
    """
    settings = settings or JunctionSettings()
    junctions: dict[str, RoadJunction] = {}
    found = dict(lanes)
    for group in _groups(crossing_pairs(lanes, sorted(lanes), settings)):
        entries = _entries(lanes, group, settings)
        begun = list(dict.fromkeys(lane for entry in entries for lane in lanes[entry].successors))
        inner = lanes_within(lanes, entries, begun, settings)
        turns = turns_within(lanes, inner, {lane: _turn_from(lanes, lane, inner, settings) for lane in begun if lane in inner})
        name = f"junction of {min(group)}"
        for lane in inner:
            found[lane] = replace(lanes[lane], junction=name, turn=turns[lane])
        junctions[name] = RoadJunction(name, tuple(inner), approaches(lanes, inner), derived=True)
    return found, junctions


def lanes_within(lanes: Mapping[str, Lane], entries: Collection[str], begun: Iterable[str], settings: JunctionSettings) -> tuple[str, ...]:
    """The lanes within a junction, from those with which it begins (`begun`, after the approaches `entries`) to its exits.

    Exits are the lanes beside the approaches in the other direction, and those that follow a lane which crosses no other (a right turn),
    with all lanes beside them. A way that comes to none ends with its last crossing.
    """
    begun = list(dict.fromkeys(begun))
    reached = _reached(lanes, begun, settings.longest)
    crossed = {lane for pair in crossing_pairs(lanes, sorted(reached), settings) for lane in pair}
    leading = _leading(lanes, reached, crossed)
    exits = {lane for entry in entries for lane in _oncoming(lanes, entry)}
    exits |= {beside for lane in begun if lane not in leading for after in lanes[lane].successors for beside in side_by_side(lanes, after)}
    exits -= {*begun, *crossed}
    ending = _leading(lanes, reached, {lane for lane in reached if set(lanes[lane].successors) & exits}, stop=exits)
    inner: dict[str, None] = {}
    waiting = list(reversed(begun))
    while waiting:
        lane = waiting.pop()
        if lane in inner or lane in exits or not (lane in begun or lane in leading or lane in ending):
            continue
        inner[lane] = None
        waiting.extend(name for name in reversed(lanes[lane].successors) if name in reached)
    return tuple(inner)


def turns_within(lanes: Mapping[str, Lane], inner: Collection[str], begun: Mapping[str, Turn | None]) -> dict[str, Turn | None]:
    """How each lane within leads: as the lane with which its way began; None where ways of different turns share it."""
    found: dict[str, set[Turn | None]] = {lane: set() for lane in inner}
    for first, turn in begun.items():
        for lane in _reached(lanes, [first], math.inf, within=inner):
            found[lane].add(turn)
    return {lane: begun[lane] if lane in begun else next(iter(turns)) if len(turns) == 1 else None for lane, turns in found.items()}


def turn_along(lanes: Mapping[str, Lane], way: Sequence[str], settings: JunctionSettings | None = None) -> Turn:
    """How consecutive lanes within a junction lead: as the map says of the first, else by how far they turn together."""
    said = lanes[way[0]].turn
    return said if said is not None else turn_of(np.vstack([lanes[lane].center for lane in way]), settings or JunctionSettings())


def _turn_from(lanes: Mapping[str, Lane], first: str, inner: Collection[str], settings: JunctionSettings) -> Turn | None:
    """The turn of all ways from a lane through the junction, None where they differ."""
    turns = {turn_of(np.vstack([lanes[lane].center for lane in way]), settings) for way in _ways(lanes, first, inner)}
    return next(iter(turns)) if len(turns) == 1 else None


def _ways(lanes: Mapping[str, Lane], first: str, inner: Collection[str]) -> Iterator[tuple[str, ...]]:
    """Every way from a lane to the junction's exits; one that ends within it only where no other leaves."""
    whole: list[tuple[str, ...]] = []
    cut: list[tuple[str, ...]] = []
    waiting: list[tuple[str, ...]] = [(first,)]
    while waiting:
        way = waiting.pop()
        onward = [lane for lane in lanes[way[-1]].successors if lane in inner and lane not in way]
        waiting.extend((*way, lane) for lane in onward)
        if not onward:
            (whole if lanes[way[-1]].successors else cut).append(way)
    yield from sorted(whole or cut)


def _reached(lanes: Mapping[str, Lane], begun: Iterable[str], longest: float, within: Collection[str] | None = None) -> dict[str, float]:
    """Lanes that follow within so many metres of the junction's begin, with how far off each begins."""
    found = dict.fromkeys(begun, 0.0)
    waiting = list(found)
    for lane in waiting:
        beyond = found[lane] + lanes[lane].length
        for onward in lanes[lane].successors:
            if onward not in found and beyond < longest and (within is None or onward in within):
                found[onward] = beyond
                waiting.append(onward)
    return found


def _leading(lanes: Mapping[str, Lane], reached: Collection[str], targets: set[str], stop: Collection[str] = ()) -> set[str]:
    """The lanes from which a target is reached without passing a lane of `stop`; the targets too."""
    found = set(targets)
    waiting = sorted(targets)
    for lane in waiting:
        for before in lanes[lane].predecessors:
            if before in reached and before not in found and before not in stop:
                found.add(before)
                waiting.append(before)
    return found


def _oncoming(lanes: Mapping[str, Lane], lane: str) -> tuple[str, ...]:
    """The lanes of the other direction on the road of this lane, all in a row; empty where the map names none."""
    edge = lanes[side_by_side(lanes, lane)[0]]
    return () if edge.left is None or edge.left not in lanes else side_by_side(lanes, edge.left)


def _entries(lanes: Mapping[str, Lane], group: list[str], settings: JunctionSettings) -> tuple[str, ...]:
    """The lanes before a junction, in rows, found back from its crossings."""
    entries: dict[str, None] = {}
    for crossed in group:
        for lane in lanes[crossed].predecessors:
            if lane not in group:
                entries.update(dict.fromkeys(_row_before(lanes, lane, group, settings)))
    return tuple(lane for lane in entries if lane not in group)


def _row_before(lanes: Mapping[str, Lane], lane: str, group: list[str], settings: JunctionSettings) -> tuple[str, ...]:
    """The farthest row back from here whose lanes lead apart (not all onto one road side by side, as where a turn lane opens)."""
    found, distance = side_by_side(lanes, lane), 0.0
    while distance < settings.longest_head:
        row = side_by_side(lanes, lane)
        onward = [after for name in row for after in lanes[name].successors]
        if lane not in group and onward and not set(onward) <= set(side_by_side(lanes, onward[0])):
            found = row
        distance += lanes[lane].length
        if len(lanes[lane].predecessors) != 1:
            break
        (lane,) = lanes[lane].predecessors
    return found


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


def crossing_pairs(lanes: Mapping[str, Lane], among: Iterable[str], settings: JunctionSettings) -> list[tuple[str, str]]:
    """Pairs of lanes that cross each other."""
    names = [name for name in among if not lanes[name].kinds & {"crosswalk", "sidewalk"}]
    boxes = np.array([(*lanes[name].center.min(axis=0), *lanes[name].center.max(axis=0)) for name in names]).reshape(-1, 4)
    pairs = []
    for place, first in enumerate(names):
        low, high, later = boxes[place, :2], boxes[place, 2:], boxes[place + 1 :]
        near = (later[:, :2] <= high).all(axis=1) & (later[:, 2:] >= low).all(axis=1)
        seconds = (names[place + 1 + row] for row in np.flatnonzero(near))
        pairs += [(first, second) for second in seconds if _cross(lanes[first], lanes[second], settings)]
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


def _groups(pairs: list[tuple[str, str]]) -> list[list[str]]:
    """Lanes joined by crossings."""
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
    return [group for _, group in sorted(groups.items())]
