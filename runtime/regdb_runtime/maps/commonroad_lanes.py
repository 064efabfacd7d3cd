"""CommonRoad lanelets, 2018b and 2020a, into lanes: sides, neighbours, markings, kinds, users, stop lines."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from regdb_runtime.maps.lines import paired, stations
from regdb_runtime.maps.road_map import Floats, Lane, Marking, StopLine
from regdb_runtime.maps.xml_source import XmlNode

MARKINGS: Mapping[str, Marking] = {
    "dashed": "dashed", "solid": "solid", "broad_dashed": "dashed", "broad_solid": "solid", "no_marking": "none", "unknown": "unknown",
    "solid_solid": "double_solid", "dashed_dashed": "double_dashed", "solid_dashed": "solid_dashed", "dashed_solid": "dashed_solid",
    "curb": "curb", "lowered_curb": "curb",
}  # fmt: skip
MIRRORED: Mapping[Marking, Marking] = {"solid_dashed": "dashed_solid", "dashed_solid": "solid_dashed"}
"""A line of two unlike halves as it looks from its other side."""
READ = frozenset(
    ("leftBound", "rightBound", "predecessor", "successor", "adjacentLeft", "adjacentRight", "stopLine", "speedLimit", "laneletType",
     "userOneWay", "userBidirectional", "trafficSignRef", "trafficLightRef")
)  # fmt: skip


def read_point(node: XmlNode) -> tuple[float, float]:
    """The (x, y) of a `<point>` or `<center>`; a height is left out."""
    return node.need("x").number(), node.need("y").number()


def read_line(node: XmlNode) -> Floats:
    """The points of a bound (n, 2), at least two, not all on one spot."""
    points = node.all("point")
    if len(points) < 2:
        raise node.fail(f"has {len(points)} points, a line needs two")
    line = np.array([read_point(point) for point in points])
    if stations(line)[-1] <= 0:
        raise node.fail("has all its points on one spot")
    return line


def read_lanelets(root: XmlNode, notes: list[str]) -> dict[str, Lane]:
    """Every `<lanelet>` by id; speed limits of 2018b on the lane itself, those of signs are added by the caller."""
    lanes: dict[str, Lane] = {}
    for node in root.all("lanelet"):
        lane = _lanelet(node, notes)
        if lane.id in lanes:
            raise node.fail("is there twice")
        lanes[lane.id] = lane
    if not lanes:
        raise root.fail("holds no <lanelet>")
    for node in root.all("lanelet"):
        _check_references(node, lanes)
    return {name: _shared_markings(lane, lanes) for name, lane in lanes.items()}


def _lanelet(node: XmlNode, notes: list[str]) -> Lane:
    left_node, right_node = node.need("leftBound"), node.need("rightBound")
    left, right = read_line(left_node), read_line(right_node)
    if len(left) != len(right):
        notes.append(f"{node.where} has {len(left)} points on the left and {len(right)} on the right; both sides were given the points of both")
        left, right = paired(left, right)
    notes.extend(f"<{tag}> of {node.where} is not read" for tag in sorted({child.tag for child in node} - READ))
    limit = node.find("speedLimit")
    return Lane(
        id=node.attribute("id"),
        left_line=left,
        right_line=right,
        center=(left + right) / 2,
        speed_limit=None if limit is None else limit.number(),
        kinds=frozenset(snake_case(kind.text) for kind in node.all("laneletType")) - {"unknown"},
        users=frozenset(snake_case(user.text) for user in node.all("userOneWay")),
        users_both_ways=frozenset(snake_case(user.text) for user in node.all("userBidirectional")),
        left=_neighbor(node, "adjacentLeft"),
        left_same_direction=_same_direction(node, "adjacentLeft"),
        right=_neighbor(node, "adjacentRight"),
        right_same_direction=_same_direction(node, "adjacentRight"),
        left_marking=_marking(left_node, on_left=True),
        right_marking=_marking(right_node, on_left=False),
        predecessors=references(node, "predecessor"),
        successors=references(node, "successor"),
        stop_line=_stop_line(node, left, right),
        lights=references(node, "trafficLightRef"),
        signs=references(node, "trafficSignRef"),
    )


def snake_case(word: str) -> str:
    """`busLane` -> `bus_lane`, as the contract names kinds and users."""
    return re.sub(r"(?<=[a-z])([A-Z])", lambda found: "_" + found[1].lower(), word)


def references(node: XmlNode, tag: str) -> tuple[str, ...]:
    """The `ref` of every child of this name, in the file's order, each once."""
    return tuple(dict.fromkeys(child.attribute("ref") for child in node.all(tag)))


def _neighbor(node: XmlNode, tag: str) -> str | None:
    found = node.find(tag)
    return None if found is None else found.attribute("ref")


def _same_direction(node: XmlNode, tag: str) -> bool:
    found = node.find(tag)
    if found is None:
        return False
    direction = found.attribute("drivingDir")
    if direction not in ("same", "opposite"):
        raise found.fail(f"has drivingDir={direction!r}, which is neither 'same' nor 'opposite'")
    return direction == "same"


def _marking(bound: XmlNode, *, on_left: bool) -> Marking:
    """The bound's marking, own side first: CommonRoad names a double line from left to right."""
    node = bound.find("lineMarking")
    if node is None:
        return "unknown"
    if node.text not in MARKINGS:
        raise node.fail(f"is {node.text!r}, which is no marking of the format")
    marking = MARKINGS[node.text]
    return MIRRORED.get(marking, marking) if on_left else marking


def _stop_line(node: XmlNode, left: Floats, right: Floats) -> StopLine | None:
    """The stop line where it says it is, without points at the lane's end."""
    found = node.find("stopLine")
    if found is None:
        return None
    points = [read_point(point) for point in found.all("point")]
    if len(points) not in (0, 2):
        raise found.fail(f"has {len(points)} points, a stop line has two or none")
    start, end = points or ((float(left[-1, 0]), float(left[-1, 1])), (float(right[-1, 0]), float(right[-1, 1])))
    marking = found.find("lineMarking")
    marked = marking is None or marking.text != "no_marking"
    lights, signs = references(found, "trafficLightRef"), references(found, "trafficSignRef")
    return StopLine(f"stop line of {node.attribute('id')}", start, end, marked, lights, signs)


def _check_references(node: XmlNode, lanes: Mapping[str, Lane]) -> None:
    for tag in ("predecessor", "successor", "adjacentLeft", "adjacentRight"):
        for ref in references(node, tag):
            if ref not in lanes:
                raise node.fail(f"names lanelet {ref} as {tag}, which the file does not define")


def _shared_markings(lane: Lane, lanes: Mapping[str, Lane]) -> Lane:
    """A line marked for one of the two lanes that share it is marked for both."""
    changes: dict[str, Marking] = {}
    if lane.left_marking == "unknown" and lane.left is not None:
        changes["left_marking"] = _seen_from_there(lanes[lane.left], lane.id, across="right" if lane.left_same_direction else "left")
    if lane.right_marking == "unknown" and lane.right is not None:
        changes["right_marking"] = _seen_from_there(lanes[lane.right], lane.id, across="left" if lane.right_same_direction else "right")
    return replace(lane, **changes) if changes else lane  # type: ignore[arg-type]


def _seen_from_there(other: Lane, here: str, across: str) -> Marking:
    """The marking of the neighbour's side towards `here`, as seen from here."""
    marking, neighbor = (other.left_marking, other.left) if across == "left" else (other.right_marking, other.right)
    return MIRRORED.get(marking, marking) if neighbor == here else "unknown"
