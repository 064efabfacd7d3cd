"""CommonRoad signs and lights: sign ids of every country as they stand, speeds in m/s, light directions, nominal cycles."""

from __future__ import annotations

from collections.abc import Mapping

from regdb_runtime.maps.commonroad_lanes import read_point
from regdb_runtime.maps.road_map import Light, Phase, Sign, SignalDirection
from regdb_runtime.maps.xml_source import XmlNode

SPEED_SIGNS = frozenset(("R2-1", "274", "274.1", "r301", "3.24", "R15", "C43", "B14", "114", "C11", "323", "c55"))
"""Codes of signs that print a maximum speed: MUTCD, Germany (and zones), Spain, Russia, Argentina, Belgium, France, Greece, Italy, Japan …"""
DIRECTIONS: Mapping[str, SignalDirection] = {
    "right": "right", "straight": "straight", "left": "left", "leftStraight": "left_straight", "straightRight": "straight_right",
    "leftRight": "left_right", "all": "all",
}  # fmt: skip
COLORS: Mapping[str, str] = {"red": "red", "yellow": "yellow", "redYellow": "red_yellow", "green": "green", "inactive": "inactive"}
ARROWS: frozenset[SignalDirection] = frozenset(("left", "straight", "right"))
"""A light for one movement alone is taken for an arrow; the format has no field for the lens."""


def read_signs(root: XmlNode, notes: list[str]) -> dict[str, tuple[Sign, ...]]:
    """Every `<trafficSign>`: its id -> one Sign per plate (the first keeps the post's id, further ones add `/2`, `/3`)."""
    return {node.attribute("id"): _plates(node, notes) for node in root.all("trafficSign")}


def _plates(node: XmlNode, notes: list[str]) -> tuple[Sign, ...]:
    plates = node.all("trafficSignElement")
    if not plates:
        raise node.fail("has no <trafficSignElement>")
    spot = node.find("position")
    point = None if spot is None else spot.find("point")
    position = None if point is None else read_point(point)
    post = node.attribute("id")
    found = []
    for place, plate in enumerate(plates):
        code = plate.need("trafficSignID").text
        values = tuple(value.text for value in plate.all("additionalValue"))
        speed = None
        if code in SPEED_SIGNS:
            if values:
                speed = plate.all("additionalValue")[0].number()
            else:
                notes.append(f"{node.where} is a speed limit without a value")
        found.append(Sign(post if place == 0 else f"{post}/{place + 1}", code, position, values, speed))
    return tuple(found)


def read_lights(root: XmlNode, time_step: float, notes: list[str]) -> dict[str, Light]:
    """Every `<trafficLight>`; cycles count time steps in the file and seconds here."""
    lights = {node.attribute("id"): _light(node, time_step) for node in root.all("trafficLight")}
    if lights:
        notes.append("light cycles are a nominal plan; they are no truth about any moment")
    return lights


def _light(node: XmlNode, time_step: float) -> Light:
    spot, active, direction, cycle = node.find("position"), node.find("active"), node.find("direction"), node.find("cycle")
    point = None if spot is None else spot.find("point")
    if direction is not None and direction.text not in DIRECTIONS:
        raise direction.fail(f"is {direction.text!r}, which is no direction of the format")
    if active is not None and active.text not in ("true", "false"):
        raise active.fail(f"is {active.text!r}, which is neither 'true' nor 'false'")
    speaks_to: SignalDirection = "all" if direction is None else DIRECTIONS[direction.text]
    phases, offset = ((), 0.0) if cycle is None else _cycle(cycle, time_step)
    return Light(
        id=node.attribute("id"),
        position=None if point is None else read_point(point),
        direction=speaks_to,
        active=active is None or active.text == "true",
        cycle=phases,
        offset=offset,
        arrow=speaks_to in ARROWS,
    )


def _cycle(node: XmlNode, time_step: float) -> tuple[tuple[Phase, ...], float]:
    phases = []
    for element in node.all("cycleElement"):
        color, duration = element.need("color"), element.need("duration").number()
        if color.text not in COLORS:
            raise color.fail(f"is {color.text!r}, which is no colour of the format")
        if duration <= 0:
            raise element.fail(f"lasts {duration:g} time steps")
        phases.append(Phase(COLORS[color.text], duration * time_step))
    offset = node.find("timeOffset")
    return tuple(phases), 0.0 if offset is None else offset.number() * time_step
