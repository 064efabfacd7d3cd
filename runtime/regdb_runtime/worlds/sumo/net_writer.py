"""A road map as a SUMO net (`.net.xml`): geometry as it stands, right of way from where the paths across a node cross.

SUMO's own network builder is not needed. Lights get one phase, all red: whoever runs the simulation sets their state. Format: SUMO's
documentation, "SUMO Road Networks" (edges, lanes, junctions with requests, connections).
"""

from __future__ import annotations

from collections.abc import Iterator
from xml.sax.saxutils import quoteattr

import numpy as np

from regdb_runtime.maps.lines import at_stations, crossing, project, stations, without_repeats
from regdb_runtime.maps.road_map import Floats, Lane, RoadMap
from regdb_runtime.worlds.sumo.net_layout import Edge, Layout, Link, Node, layout

DEFAULT_SPEED = 13.89
"""m/s for lanes without a limit on the map (50 km/h, SUMO's own default)."""
LEAST_CUT = 0.5
"""A stop line nearer than this to an end of its lane, metres, does not cut it."""
_DIRECTIONS = {"right": "r", "straight": "s", "left": "l", "u_turn": "t"}
_YIELDS = {"straight": 0, "right": 1, "left": 2, "u_turn": 3}
"""Order of right of way among crossing links without signs: a lower number goes first."""


def net_xml(road_map: RoadMap, laid: Layout | None = None) -> str:
    """The net as text. Coordinates are the map's own, no offset."""
    laid = laid or layout(road_map)
    points = np.concatenate([lane.center for lane in road_map.lanes.values()])
    low, high = points.min(axis=0), points.max(axis=0)
    bounds = f"{low[0]:.2f},{low[1]:.2f},{high[0]:.2f},{high[1]:.2f}"
    lines = [
        '<?xml version="1.0" encoding="UTF-8"?>',
        '<net version="1.20" junctionCornerDetail="5" limitTurnSpeed="5.50">',
        f'    <location netOffset="0.00,0.00" convBoundary="{bounds}" origBoundary="{bounds}" projParameter="!"/>',
    ]
    for node in laid.nodes:
        lines += _inner_edges(road_map, node)
    for edge in laid.edges:
        lines += _edge(road_map, edge)
    lines += [line for node in laid.nodes if node.lights for line in _light(node)]
    for node in laid.nodes:
        lines += _junction(road_map, laid, node)
    for node in laid.nodes:
        lines += _connections(laid, node)
    return "\n".join([*lines, "</net>", ""])


def _edge(road_map: RoadMap, edge: Edge) -> Iterator[str]:
    yield f'    <edge id="{edge.id}" from="{edge.start}" to="{edge.end}" priority="1">'
    for index, name in enumerate(edge.lanes):
        lane = road_map.lanes[name]
        yield f"        {_lane(lane, f'{edge.id}_{index}', index, _to_stop_line(lane)[0])}"
    yield "    </edge>"


def _inner_edges(road_map: RoadMap, node: Node) -> Iterator[str]:
    for index, link in enumerate(node.links):
        if link.inner is not None:
            yield f'    <edge id=":{node.id}_{index}" function="internal">'
            lane = road_map.lanes[link.inner]
            beyond = _to_stop_line(road_map.lanes[link.source])[1]
            whole = lane.center if beyond is None else without_repeats(np.concatenate((beyond, lane.center)))
            yield f"        {_lane(lane, f':{node.id}_{index}_0', 0, whole)}"
            yield "    </edge>"


def _to_stop_line(lane: Lane) -> tuple[Floats, Floats | None]:
    """A lane's centre up to its stop line, and what lies beyond; SUMO's drivers stop at a lane's end, so it must end where the line is."""
    if lane.stop_line is None:
        return lane.center, None
    (station,), _ = project(np.mean([[lane.stop_line.start, lane.stop_line.end]], axis=1), lane.center)
    along = stations(lane.center)
    if not LEAST_CUT < station < along[-1] - LEAST_CUT:
        return lane.center, None
    at = at_stations(lane.center, np.array([station]))
    return np.concatenate((lane.center[along < station], at)), np.concatenate((at, lane.center[along > station]))


def _lane(lane: Lane, name: str, index: int, center: Floats) -> str:
    speed = DEFAULT_SPEED if lane.speed_limit is None else lane.speed_limit
    allow = ' allow="bicycle"' if "bicycle_lane" in lane.kinds else ""
    width = float(lane.widths.mean())
    sizes = f'speed="{speed:.4f}" length="{stations(center)[-1]:.3f}" width="{width:.2f}"'
    return f'<lane id="{name}" index="{index}"{allow} {sizes} shape={_shape(center)}/>'


def _shape(points: Floats) -> str:
    return quoteattr(" ".join(f"{x:.3f},{y:.3f}" for x, y in points))


def _light(node: Node) -> Iterator[str]:
    yield f'    <tlLogic id="{node.id}" type="static" programID="0" offset="0">'
    yield f'        <phase duration="3600" state="{"r" * len(node.links)}"/>'
    yield "    </tlLogic>"


def _junction(road_map: RoadMap, laid: Layout, node: Node) -> Iterator[str]:
    ends = [road_map.lanes[name].center[-1] for name in node.incoming]
    ends += [road_map.lanes[name].center[0] for edge in laid.edges if edge.start == node.id for name in edge.lanes]
    x, y = np.mean(ends, axis=0)
    kind = _junction_type(node)
    incoming = " ".join(laid.sumo_lane[name] for name in node.incoming)
    inner = " ".join(laid.sumo_lane[link.inner] for link in node.links if link.inner is not None)
    shape = _shape(_outline(road_map, laid, node))
    head = f'    <junction id="{node.id}" type="{kind}" x="{x:.2f}" y="{y:.2f}" incLanes="{incoming}" intLanes="{inner}" shape={shape}'
    if not node.links:
        yield f"{head}/>"
        return
    yield f"{head}>"
    foes = _foes(road_map, node.links)
    for index, link in enumerate(node.links):
        other = ["1" if foes[index][k] else "0" for k in range(len(node.links))]
        gives_way = ["1" if foes[index][k] and _gives_way(link, node.links[k], road_map) else "0" for k in range(len(node.links))]
        yield f'        <request index="{index}" response="{"".join(reversed(gives_way))}" foes="{"".join(reversed(other))}" cont="0"/>'
    yield "    </junction>"


def _junction_type(node: Node) -> str:
    signs = {link.control for link in node.links}
    if not node.links:
        return "dead_end"
    return "traffic_light" if node.lights else "allway_stop" if signs == {"stop"} else "priority_stop" if "stop" in signs else "priority"


def _outline(road_map: RoadMap, laid: Layout, node: Node) -> Floats:
    """The area between the ends of the roads: their corners in order around the middle."""
    corners = [line[-1] for name in node.incoming for line in (road_map.lanes[name].left_line, road_map.lanes[name].right_line)]
    for edge in laid.edges:
        if edge.start == node.id:
            corners += [line[0] for name in edge.lanes for line in (road_map.lanes[name].left_line, road_map.lanes[name].right_line)]
    points = np.unique(np.round(np.array(corners), 2), axis=0)
    middle = points.mean(axis=0)
    order = np.argsort(np.arctan2(*(points - middle).T[::-1]), kind="stable")
    found: Floats = points[order]
    return found


def _foes(road_map: RoadMap, links: tuple[Link, ...]) -> list[list[bool]]:
    """Which links meet: those of different lanes that end in the same lane or whose paths cross."""

    def meet(one: Link, other: Link) -> bool:
        if one.source == other.source:
            return False
        if one.target == other.target:
            return True
        if one.inner is None or other.inner is None:
            return False
        return crossing(road_map.lanes[one.inner].center, road_map.lanes[other.inner].center) is not None

    return [[meet(one, other) for other in links] for one in links]


def _side(a: Floats, b: Floats, c: Floats) -> float:
    return float((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))


def _gives_way(link: Link, other: Link, road_map: RoadMap) -> bool:
    """Those before a sign give way to those without, turns to those that go on straight, equals to the one that comes from the right."""
    if bool(link.control) != bool(other.control):
        return bool(link.control)
    mine, theirs = _YIELDS[link.turn], _YIELDS[other.turn]
    if mine != theirs:
        return mine > theirs
    before, end = road_map.lanes[link.source].center[-2:]
    return _side(before, end, road_map.lanes[other.source].center[-2]) < 0


def _connections(laid: Layout, node: Node) -> Iterator[str]:
    for index, link in enumerate(node.links):
        source, target = _place(laid.sumo_lane[link.source]), _place(laid.sumo_lane[link.target])
        ends = f'from="{source[0]}" to="{target[0]}" fromLane="{source[1]}" toLane="{target[1]}"'
        via = f' via=":{node.id}_{index}_0"' if link.inner is not None else ""
        light = f' tl="{node.id}" linkIndex="{index}" state="o"' if node.lights else f' state="{_state(node, link)}"'
        turn = f'dir="{_DIRECTIONS[link.turn]}"'
        yield f"    <connection {ends}{via} {turn}{light}/>"
        if link.inner is not None:
            yield f'    <connection from=":{node.id}_{index}" to="{target[0]}" fromLane="0" toLane="{target[1]}" {turn} state="M"/>'


def _state(node: Node, link: Link) -> str:
    """SUMO's letter for how a link gives way: `w` all-way stop, `s` stop, `m` minor, `M` major."""
    if link.control == "stop":
        return "w" if _junction_type(node) == "allway_stop" else "s"
    return "M" if link.turn == "straight" and not link.control else "m"


def _place(sumo_lane: str) -> tuple[str, str]:
    edge, _, index = sumo_lane.rpartition("_")
    return edge, index
