"""Reads the recorded obstacles and planning problems of CommonRoad XML, 2018b and 2020a."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from regdb_runtime.maps.commonroad import open_scenario
from regdb_runtime.maps.commonroad_lanes import read_point, references
from regdb_runtime.maps.recorded_traffic import PlanningProblem, RecordedGoal, RecordedObstacle, RecordedTraffic
from regdb_runtime.maps.road_map import Floats
from regdb_runtime.maps.xml_source import XmlNode
from regdb_runtime.observation import TrackKind, TurnSignal

KINDS: Mapping[str, TrackKind] = {
    "car": "car", "taxi": "car", "priorityVehicle": "car", "parkedVehicle": "car", "truck": "truck", "bus": "bus", "train": "truck",
    "motorcycle": "motorcycle", "bicycle": "bicycle", "pedestrian": "pedestrian",
}  # fmt: skip
"""Everything else that the format names (construction zones, pillars, unknown …) is an obstacle."""
STATE_READ = frozenset(("position", "orientation", "time", "velocity", "acceleration", "yawRate", "slipAngle"))
"""Yaw rate and slip are known and left out: the track's own is the difference of its headings, the same for every file."""


@dataclass(frozen=True, slots=True)
class _Shape:
    """Length, width, and where its middle and direction lie relative to the state's."""

    length: float
    width: float
    ahead: float = 0.0
    aside: float = 0.0
    turned: float = 0.0


def read_traffic(path: str | Path) -> RecordedTraffic:
    """The recorded traffic of a CommonRoad file. MapError where it cannot be read."""
    return traffic_of(open_scenario(path))


def traffic_of(root: XmlNode) -> RecordedTraffic:
    """The recorded traffic in an opened file."""
    notes: list[str] = []
    step = root.number_of("timeStepSize")
    if step <= 0:
        raise root.fail(f"has timeStepSize={step:g}; it must be above 0")
    obstacles = [_obstacle(node, static, notes) for node, static in _obstacle_nodes(root)]
    for tag in ("environmentObstacle", "phantomObstacle"):
        notes.extend(f"{node.where} is not read" for node in root.all(tag))
    problems = tuple(_problem(node, notes) for node in root.all("planningProblem"))
    return RecordedTraffic(root.attribute("benchmarkID"), step, tuple(obstacles), problems, root.file, tuple(dict.fromkeys(notes)))


def _obstacle_nodes(root: XmlNode) -> list[tuple[XmlNode, bool]]:
    found = []
    for node in root:
        if node.tag == "obstacle":
            role = node.need("role").text
            if role not in ("static", "dynamic"):
                raise node.fail(f"has the role {role!r}, which is neither 'static' nor 'dynamic'")
            found.append((node, role == "static"))
        elif node.tag in ("staticObstacle", "dynamicObstacle"):
            found.append((node, node.tag == "staticObstacle"))
    return found


def _obstacle(node: XmlNode, static: bool, notes: list[str]) -> RecordedObstacle:
    word = node.need("type").text
    states = [node.need("initialState")]
    trajectory = node.find("trajectory")
    if trajectory is not None:
        states += trajectory.all("state")
    if node.find("occupancySet") is not None:
        notes.append(f"<occupancySet> of {node.where} is not read; it is there at its first state alone")
    shape = _shape(node.need("shape"))
    rows = np.array([_state(state, shape, notes) for state in states])
    steps = rows[:, 0].astype(np.int64)
    if (np.diff(steps) <= 0).any():
        raise node.fail("has states that do not follow each other in time")
    signals = _signals(node, steps)
    return RecordedObstacle(
        node.attribute("id"), KINDS.get(word, "obstacle"), word, shape.length, shape.width, static, steps,
        rows[:, 1], rows[:, 2], rows[:, 3], rows[:, 4], rows[:, 5], *signals,
    )  # fmt: skip


def _shape(node: XmlNode) -> _Shape:
    """The rectangle; of a circle and a polygon the rectangle around them."""
    if len(list(node)) > 1:
        raise node.fail("holds several shapes; one is read")
    if (rectangle := node.find("rectangle")) is not None:
        center, turned, shift = (rectangle.find(tag) for tag in ("center", "orientation", "originXShift"))
        ahead, aside = (0.0, 0.0) if center is None else read_point(center)
        length, width = _lengths(rectangle, "length", "width")
        ahead -= 0.0 if shift is None else shift.number()
        return _Shape(length, width, ahead, aside, 0.0 if turned is None else turned.number())
    if (circle := node.find("circle")) is not None:
        center = circle.find("center")
        (radius,) = _lengths(circle, "radius")
        return _Shape(2 * radius, 2 * radius, *((0.0, 0.0) if center is None else read_point(center)))
    if (polygon := node.find("polygon")) is not None:
        points = np.array([read_point(point) for point in polygon.all("point")]).reshape(-1, 2)
        if len(points) < 3:
            raise polygon.fail(f"has {len(points)} points, a polygon needs three")
        low, high = points.min(axis=0), points.max(axis=0)
        return _Shape(float(high[0] - low[0]), float(high[1] - low[1]), float(high[0] + low[0]) / 2, float(high[1] + low[1]) / 2)
    raise node.fail("has no <rectangle>, <circle> or <polygon>")


def _lengths(node: XmlNode, *tags: str) -> tuple[float, ...]:
    values = tuple(node.need(tag).number() for tag in tags)
    if min(values) <= 0:
        raise node.fail(f"has a size of {min(values):g} m")
    return values


def _state(node: XmlNode, shape: _Shape, notes: list[str]) -> tuple[float, float, float, float, float, float]:
    """Step, x, y, heading, speed, acceleration of the middle of the shape."""
    notes.extend(f"<{child.tag}> of recorded states is not read" for child in node if child.tag not in STATE_READ)
    x, y = _position(node.need("position"), notes)
    heading = _value(node.need("orientation"), notes)
    cos, sin = math.cos(heading), math.sin(heading)
    speed, acceleration = (math.nan if (found := node.find(tag)) is None else _value(found, notes) for tag in ("velocity", "acceleration"))
    return (
        _value(node.need("time"), notes), x + shape.ahead * cos - shape.aside * sin, y + shape.ahead * sin + shape.aside * cos,
        heading + shape.turned, speed, acceleration,
    )  # fmt: skip


def _position(node: XmlNode, notes: list[str]) -> tuple[float, float]:
    point = node.find("point")
    if point is not None:
        return read_point(point)
    for tag in ("rectangle", "circle"):
        area = node.find(tag)
        if area is not None:
            notes.append(f"positions given as a <{tag}> are taken at its centre")
            center = area.find("center")
            return (0.0, 0.0) if center is None else read_point(center)
    raise node.fail("has no <point>, <rectangle> or <circle>")


def _value(node: XmlNode, notes: list[str]) -> float:
    """An exact value, or the middle of an interval."""
    exact = node.find("exact")
    if exact is not None:
        return exact.number()
    start, end = _interval(node)
    if start != end:
        notes.append(f"a <{node.tag}> given as an interval is taken at its middle")
    return (start + end) / 2


def _interval(node: XmlNode) -> tuple[float, float]:
    exact = node.find("exact")
    if exact is not None:
        return exact.number(), exact.number()
    return node.need("intervalStart").number(), node.need("intervalEnd").number()


def _signals(node: XmlNode, steps: NDArray[np.int64]) -> tuple[tuple[TurnSignal | None, ...], tuple[str, ...]]:
    """Turn signals and warning lights per state; empty where the file has none. Each holds until the next is given."""
    series = node.find("signalSeries")
    given = ([first] if (first := node.find("initialSignalState")) is not None else []) + ([] if series is None else series.all("signalState"))
    if not given:
        return (), ()
    at = {int(steps[0]) if (time := state.find("time")) is None else round(_value(time, [])): state for state in given}
    turns: list[TurnSignal | None] = []
    warnings: list[str] = []
    turn: TurnSignal | None = None
    warning = "none"
    for step in steps:
        if (state := at.get(int(step))) is not None:
            turn = _turn_signal(state)
            warning = "emergency_lights" if _is_on(state, "flashingBlueLights") else "hazard_lights" if turn == "hazard" else "none"
        turns.append(turn)
        warnings.append(warning)
    return tuple(turns), tuple(warnings)


def _turn_signal(node: XmlNode) -> TurnSignal:
    left, right = _is_on(node, "indicatorLeft"), _is_on(node, "indicatorRight")
    if _is_on(node, "hazardWarningLights") or (left and right):
        return "hazard"
    return "left" if left else "right" if right else "off"


def _is_on(node: XmlNode, tag: str) -> bool:
    found = node.find(tag)
    return found is not None and found.text == "true"


def _problem(node: XmlNode, notes: list[str]) -> PlanningProblem:
    state = node.need("initialState")
    x, y = _position(state.need("position"), notes)
    return PlanningProblem(
        node.attribute("id"), round(_value(state.need("time"), notes)), x, y, _value(state.need("orientation"), notes),
        _value(state.need("velocity"), notes), tuple(_goal(goal, notes) for goal in node.all("goalState")),
    )  # fmt: skip


def _goal(node: XmlNode, notes: list[str]) -> RecordedGoal:
    bounds = {tag: None if (found := node.find(tag)) is None else _interval(found) for tag in ("time", "velocity", "orientation")}
    steps, place = bounds["time"], node.find("position")
    lanes: tuple[str, ...] = ()
    areas: tuple[Floats, ...] = ()
    if place is not None:
        lanes = references(place, "lanelet")
        areas = tuple(_area(child) for child in place if child.tag in ("rectangle", "polygon", "circle"))
        if place.find("point") is not None:
            notes.append(f"the goal of {node.where} is a point, which is not read")
    return RecordedGoal(None if steps is None else (round(steps[0]), round(steps[1])), bounds["velocity"], bounds["orientation"], lanes, areas)


def _area(node: XmlNode) -> Floats:
    """The outline (n, 2) of a rectangle, polygon or circle (of which 24 corners)."""
    if node.tag == "polygon":
        return np.array([read_point(point) for point in node.all("point")]).reshape(-1, 2)
    center, turned = node.find("center"), node.find("orientation")
    middle = np.array((0.0, 0.0) if center is None else read_point(center))
    if node.tag == "circle":
        angles = np.linspace(0.0, 2 * np.pi, 24, endpoint=False)
        outline: Floats = middle + node.need("radius").number() * np.column_stack((np.cos(angles), np.sin(angles)))
        return outline
    length, width = _lengths(node, "length", "width")
    direction = 0.0 if turned is None else turned.number()
    cos, sin = math.cos(direction), math.sin(direction)
    corners = np.array([(length, width), (-length, width), (-length, -width), (length, -width)]) / 2
    placed: Floats = middle + corners @ np.array([(cos, sin), (-sin, cos)])
    return placed
