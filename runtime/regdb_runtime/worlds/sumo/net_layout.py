"""A road map in SUMO's terms: edges of adjacent lanes, nodes where they meet, and the links across each node in SUMO's order."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Literal

from regdb_runtime.maps.road_map import Lane, RoadMap, Turn

Control = Literal["", "stop", "yield"]
UNDRIVEN = frozenset(("sidewalk", "crosswalk", "shoulder", "parking", "border", "restricted"))
"""Kinds of lanes that get no SUMO lane."""


@dataclass(frozen=True, slots=True)
class Edge:
    """Lanes side by side in one direction, the rightmost first, between two nodes."""

    id: str
    lanes: tuple[str, ...]
    start: str
    end: str


@dataclass(frozen=True, slots=True)
class Link:
    """One way across a node: from a lane to a lane, `inner` the junction lane between them (None: they meet), with its turn and the sign
    before it."""

    source: str
    target: str
    inner: str | None
    turn: Turn
    control: Control = ""


@dataclass(frozen=True, slots=True)
class Node:
    """Where edges meet: incoming lanes and links in SUMO's order; `lights` whether a light speaks to any of them."""

    id: str
    incoming: tuple[str, ...]
    links: tuple[Link, ...]
    lights: bool
    junction: str | None


@dataclass(frozen=True)
class Layout:
    """The whole net. `sumo_lane`: our lane id -> SUMO's; inner lanes included."""

    edges: tuple[Edge, ...]
    nodes: tuple[Node, ...]
    sumo_lane: dict[str, str] = field(default_factory=dict)

    def our_lane(self) -> dict[str, str]:
        """SUMO's lane id -> ours."""
        return {theirs: ours for ours, theirs in self.sumo_lane.items()}


def layout(road_map: RoadMap) -> Layout:
    """The layout of a map; ids keep its order, so that the same map gives the same net."""
    driven = {name: lane for name, lane in road_map.lanes.items() if not lane.kinds & UNDRIVEN}
    groups = list(_groups(driven))
    meeting = _Meeting(driven, groups)
    edges = tuple(Edge(f"e{k}", group, meeting.start(group), meeting.end(group)) for k, group in enumerate(groups))
    nodes = tuple(_node(road_map, driven, edges, node) for node in dict.fromkeys(end for edge in edges for end in (edge.start, edge.end)))
    lanes = {name: f"{edge.id}_{k}" for edge in edges for k, name in enumerate(edge.lanes)}
    for node in nodes:
        lanes |= {link.inner: f":{node.id}_{k}_0" for k, link in enumerate(node.links) if link.inner is not None}
    return Layout(edges, nodes, lanes)


def _groups(driven: dict[str, Lane]) -> Iterator[tuple[str, ...]]:
    """Sets of adjacent lanes of one direction outside junctions, each from right to left."""
    seen: set[str] = set()
    for name, lane in driven.items():
        if name in seen or lane.junction is not None:
            continue
        first = name
        while (right := _beside(driven, driven[first].right, driven[first].right_same_direction)) is not None and right != name:
            first = right
        group = [first]
        while (left := _beside(driven, driven[group[-1]].left, driven[group[-1]].left_same_direction)) is not None and left not in group:
            group.append(left)
        seen.update(group)
        yield tuple(group)


def _beside(driven: dict[str, Lane], name: str | None, same: bool) -> str | None:
    return name if same and name in driven and driven[name].junction is None else None


class _Meeting:
    """Which ends of edges are one node: those that a junction or a direct succession joins."""

    def __init__(self, driven: dict[str, Lane], groups: list[tuple[str, ...]]) -> None:
        self._root: dict[str, str] = {}
        self._of = {name: k for k, group in enumerate(groups) for name in group}
        for name, lane in driven.items():
            for after in lane.successors:
                if after in driven:
                    self._join(self._tail(driven, name), self._head(driven, after))

    def start(self, group: tuple[str, ...]) -> str:
        return self._name(f"s{self._of[group[0]]}")

    def end(self, group: tuple[str, ...]) -> str:
        return self._name(f"t{self._of[group[0]]}")

    def _tail(self, driven: dict[str, Lane], name: str) -> str:
        junction = driven[name].junction
        return f"j{junction}" if junction is not None else f"t{self._of[name]}"

    def _head(self, driven: dict[str, Lane], name: str) -> str:
        junction = driven[name].junction
        return f"j{junction}" if junction is not None else f"s{self._of[name]}"

    def _find(self, end: str) -> str:
        root = self._root.setdefault(end, end)
        if root != end:
            root = self._root[end] = self._find(root)
        return root

    def _join(self, one: str, other: str) -> None:
        first, second = sorted((self._find(one), self._find(other)))
        self._root[second] = first

    def _name(self, end: str) -> str:
        return "n" + "".join(c if c.isalnum() else "-" for c in self._find(end))


def _node(road_map: RoadMap, driven: dict[str, Lane], edges: tuple[Edge, ...], node: str) -> Node:
    incoming = tuple(name for edge in edges if edge.end == node for name in edge.lanes)
    links = tuple(link for name in incoming for link in _links(driven, driven[name], _control(road_map, driven[name])))
    inner = [driven[link.inner] for link in links if link.inner is not None]
    junction = next((lane.junction for lane in inner if lane.junction is not None), None)
    lights = any(lane.lights for lane in (*inner, *(driven[name] for name in incoming if any(link.source == name for link in links))))
    return Node(node, incoming, links, bool(lights) and bool(road_map.lights), junction)


def _control(road_map: RoadMap, lane: Lane) -> Control:
    """The sign at a lane's stop line, by its MUTCD code: R1-1 STOP, R1-2 YIELD."""
    names = () if lane.stop_line is None else lane.stop_line.signs
    codes = [road_map.signs[name].code for name in names if name in road_map.signs]
    return "stop" if any(code.startswith("R1-1") for code in codes) else "yield" if any(code.startswith("R1-2") for code in codes) else ""


def _links(driven: dict[str, Lane], lane: Lane, control: Control) -> Iterator[Link]:
    """Ways on from a lane, from the rightmost turn to the leftmost, as SUMO orders them."""
    order = {"right": 0, "straight": 1, "left": 2, "u_turn": 3}
    found = []
    for after in lane.successors:
        inner = driven.get(after)
        if inner is None:
            continue
        if inner.junction is None:
            found.append(Link(lane.id, after, None, "straight"))
        else:
            found += [Link(lane.id, target, after, inner.turn or "straight", control) for target in _beyond(driven, inner)]
    yield from sorted(found, key=lambda link: (order[link.turn], link.target))


def _beyond(driven: dict[str, Lane], inner: Lane) -> Iterator[str]:
    """The lanes outside the junction that an inner lane leads to; only the first of inner pieces is drawn where there are several."""
    for after in inner.successors:
        lane = driven.get(after)
        if lane is None:
            continue
        if lane.junction is None:
            yield after
        else:
            yield from _beyond(driven, lane)
