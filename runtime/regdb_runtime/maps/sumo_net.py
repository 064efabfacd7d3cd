"""Reads a SUMO network (.net.xml) into a road map; see docs/reference/maps.md for what is taken over."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from regdb_runtime.maps.lines import offset, stations, without_repeats
from regdb_runtime.maps.road_map import Approach, Crosswalk, Floats, Lane, Marking, RoadJunction, RoadMap
from regdb_runtime.maps.sumo_links import TURNS, Link, control_of, read_links, read_signals
from regdb_runtime.maps.sumo_permissions import kinds_of, may_change, permitted
from regdb_runtime.maps.xml_source import XmlNode, open_xml

LANE_WIDTH = 3.2
"""Metres, where a lane names none (SUMO's own default)."""
OPPOSITE_REACH = 1.0
"""How far the edges of two opposite lanes may lie apart, metres, for the one to be the other's neighbour."""


@dataclass(frozen=True, slots=True)
class _Edge:
    """An edge: its lanes from right to left, and the junctions it joins."""

    id: str
    start: str
    end: str
    function: str
    lanes: tuple[XmlNode, ...]


def read_sumo(path: str | Path) -> RoadMap:
    """The road map of a SUMO network. MapError where the file cannot be read or contradicts itself."""
    root = open_xml(path, "net")
    notes: list[str] = []
    edges = {edge.id: edge for edge in _edges(root, notes)}
    lanes = {lane.id: lane for edge in edges.values() if edge.function in ("normal", "internal") for lane in _lanes(edge)}
    if not lanes:
        raise root.fail("holds no lanes")
    links = read_links(root, {edge.id: edge.function for edge in edges.values()}, {lane.attribute("id") for e in edges.values() for lane in e.lanes})
    lanes = _linked(lanes, links)
    lights, carried = read_signals(root, links, lanes, notes)
    lanes = {name: replace(lane, lights=carried.get(name, ())) for name, lane in lanes.items()}
    lanes, junctions = _with_junctions(root, lanes, edges, links)
    if root.element.get("lefthand") == "true":
        notes.append("the network drives on the left; lanes, sides and turns are taken as they are drawn")
    return RoadMap(
        lanes=_with_opposites(lanes, edges),
        lights=lights,
        crosswalks=tuple(Crosswalk(lane.attribute("id"), _outline(lane)) for e in edges.values() if e.function == "crossing" for lane in e.lanes),
        origin=_origin(root),
        source=root.file,
        junctions=junctions,
        notes=tuple(notes),
    )


def _edges(root: XmlNode, notes: list[str]) -> Iterator[_Edge]:
    for node in root.all("edge"):
        function = node.element.get("function", "normal")
        if function in ("walkingarea", "connector"):
            notes.append(f"{node.where} ({function}) is not read")
        lanes = sorted(node.all("lane"), key=lambda lane: lane.number_of("index"))
        if not lanes:
            raise node.fail("has no <lane>")
        yield _Edge(node.attribute("id"), node.element.get("from", ""), node.element.get("to", ""), function, tuple(lanes))


def read_shape(node: XmlNode) -> Floats:
    """The `shape` of a lane (n, 2); heights are left out."""
    points = []
    for text in node.attribute("shape").split():
        try:
            points.append(tuple(float(value) for value in text.split(",")[:2]))
        except ValueError:
            raise node.fail(f"has the point {text!r} in its shape, which is no x,y") from None
    line = np.array([point for point in points if len(point) == 2]).reshape(-1, 2)
    if len(line) != len(points) or not np.isfinite(line).all():
        raise node.fail("has a shape with a point that is no pair of finite numbers")
    if len(line) < 2 or stations(line)[-1] <= 0:
        raise node.fail("has a shape of less than two different points")
    return without_repeats(line)


def _lanes(edge: _Edge) -> Iterator[Lane]:
    names = [lane.attribute("id") for lane in edge.lanes]
    for place, node in enumerate(edge.lanes):
        center = read_shape(node)
        half = node.number_of("width", LANE_WIDTH) / 2
        if half <= 0:
            raise node.fail("has no width")
        left = edge.lanes[place + 1] if place + 1 < len(edge.lanes) else None
        right = edge.lanes[place - 1] if place else None
        yield Lane(
            id=names[place],
            left_line=offset(center, half),
            right_line=offset(center, -half),
            center=center,
            speed_limit=node.number_of("speed"),
            kinds=kinds_of(node, internal=edge.function == "internal"),
            users=permitted(node),
            left=None if left is None else names[place + 1],
            left_same_direction=left is not None,
            right=None if right is None else names[place - 1],
            right_same_direction=right is not None,
            left_marking=_marking(node, left, "changeLeft", "changeRight"),
            right_marking=_marking(node, right, "changeRight", "changeLeft"),
            road=edge.id,
        )


def _marking(node: XmlNode, other: XmlNode | None, ours: str, theirs: str) -> Marking:
    """The line to a neighbour, by who may change over it; SUMO has no markings of its own. Towards nothing, or no car's lane: unknown."""
    if other is None:
        return "unknown"
    if permitted(other) == {"pedestrian"}:
        return "curb"
    if "car" not in permitted(node) or "car" not in permitted(other):
        return "unknown"
    rights = may_change(node, ours), may_change(other, theirs)
    return {(True, True): "dashed", (True, False): "dashed_solid", (False, True): "solid_dashed", (False, False): "solid"}[rights]  # type: ignore[return-value]


def _linked(lanes: Mapping[str, Lane], links: list[Link]) -> dict[str, Lane]:
    """Lanes with those that follow and precede them: first the lane within the junction, where there is one."""
    successors: dict[str, list[str]] = {name: [] for name in lanes}
    predecessors: dict[str, list[str]] = {name: [] for name in lanes}
    for link in links:
        onward = link.via if link.via is not None and link.via in lanes else link.onto
        if link.start in lanes and onward in lanes and onward not in successors[link.start]:
            successors[link.start].append(onward)
            predecessors[onward].append(link.start)
    return {
        name: replace(lane, successors=tuple(successors[name]), predecessors=tuple(predecessors[name])) for name, lane in lanes.items()
    }


def _with_junctions(
    root: XmlNode, lanes: Mapping[str, Lane], edges: Mapping[str, _Edge], links: list[Link]
) -> tuple[dict[str, Lane], dict[str, RoadJunction]]:
    """Lanes within a junction with its id, their turn and control.

    A node without a signal that has less than three arms, or where all only merge or fork, is none.
    """
    major = frozenset(link.edge for link in links if link.state == "M")
    entered = {link.via: link for link in links if link.via is not None and edges[link.edge].function == "normal"}
    within: dict[str, list[str]] = {}
    into: dict[str, list[_Edge]] = {}
    out_of: dict[str, list[_Edge]] = {}
    for edge in edges.values():
        if edge.function == "internal":
            within.setdefault(edge.id[1:].rpartition("_")[0], []).extend(_names(edge))
        into.setdefault(edge.end, []).append(edge)
        out_of.setdefault(edge.start, []).append(edge)
    found, junctions = dict(lanes), {}
    for node in root.all("junction"):
        name = node.attribute("id")
        if node.element.get("type") in ("internal", "dead_end"):
            continue
        inner = within.get(name, [])
        ways = [entered[lane] for lane in inner if lane in entered]
        arms = {edge.start for edge in into.get(name, [])} | {edge.end for edge in out_of.get(name, [])}
        if not any(way.signal for way in ways) and (len(arms) < 3 or all(way.direction == "s" for way in ways)):
            continue
        for lane in inner:
            way = _entry(lane, lanes, entered)
            if way is not None:
                found[lane] = replace(lanes[lane], junction=name, turn=TURNS.get(way.direction, "straight"), control=control_of(way, major))
        approaches = tuple(Approach(edge.id, _names(edge)) for edge in into.get(name, []) if any(way.edge == edge.id for way in ways))
        junctions[name] = RoadJunction(name, tuple(lane for lane in inner if found[lane].junction), approaches)
    return found, junctions


def _names(edge: _Edge) -> tuple[str, ...]:
    return tuple(lane.attribute("id") for lane in edge.lanes)


def _entry(lane: str, lanes: Mapping[str, Lane], entered: Mapping[str, Link]) -> Link | None:
    """The link by which one came into a lane within a junction, through other such lanes too."""
    seen = {lane}
    while lane not in entered:
        before = [name for name in lanes[lane].predecessors if name not in seen]
        if not before:
            return None
        lane = before[0]
        seen.add(lane)
    return entered[lane]


def _with_opposites(lanes: dict[str, Lane], edges: Mapping[str, _Edge]) -> dict[str, Lane]:
    """The leftmost lane of an edge beside the leftmost of the edge back, where their sides meet."""
    back: dict[tuple[str, str], list[_Edge]] = {}
    for edge in edges.values():
        if edge.function == "normal":
            back.setdefault((edge.start, edge.end), []).append(edge)
    found = dict(lanes)
    for (start, end), group in back.items():
        for edge in group:
            here = lanes[_names(edge)[-1]]
            for other in back.get((end, start), []):
                there = lanes[_names(other)[-1]]
                apart = np.hypot(*(here.left_line[[0, -1]] - there.left_line[[-1, 0]]).T)
                if apart.max() <= OPPOSITE_REACH:
                    found[here.id] = replace(here, left=there.id)
    return found


def _outline(node: XmlNode) -> Floats:
    center, half = read_shape(node), node.number_of("width", 4.0) / 2
    return np.vstack((offset(center, half), offset(center, -half)[::-1]))


def _origin(root: XmlNode) -> tuple[float, float] | None:
    """Longitude and latitude of (0, 0), from the two boundaries that the file gives in both systems; None for a network without a place."""
    location = root.find("location")
    if location is None or location.element.get("projParameter", "!") in ("!", "-"):
        return None
    try:
        here = [float(value) for value in location.attribute("convBoundary").split(",")]
        there = [float(value) for value in location.attribute("origBoundary").split(",")]
    except ValueError:
        raise location.fail("has a boundary that is no four numbers") from None
    if len(here) != 4 or len(there) != 4:
        raise location.fail("has a boundary that is no four numbers")
    if here[2] <= here[0] or here[3] <= here[1] or max(map(abs, there)) > 180:
        return None
    longitude = there[0] - here[0] * (there[2] - there[0]) / (here[2] - here[0])
    latitude = there[1] - here[1] * (there[3] - there[1]) / (here[3] - here[1])
    return longitude, latitude
