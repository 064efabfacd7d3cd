"""Lanelet2's regulatory elements: lights, signs, speed limits, right of way and stop lines, by the lanelets they bind."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import TypeVar

import numpy as np

from regdb.units import to_si
from regdb_runtime.maps.osm_source import OsmMap, Relation, Tags
from regdb_runtime.maps.road_map import Control, Floats, Light, Sign, StopLine

Item = TypeVar("Item")
READ = frozenset(("traffic_light", "traffic_sign", "speed_limit", "right_of_way", "all_way_stop"))
STOP_CODES = frozenset(("R1-1", "206"))
YIELD_CODES = frozenset(("R1-2", "205"))
COUNTRY = re.compile(r"^(us|de|fr|es|it|be|nl|at|ch|jp)[:_]?(?=[A-Z0-9])")
SPEED = re.compile(r"^\s*([0-9]+(?:\.[0-9]+)?)\s*(mph|km/h|kmh|kph|m/s)?\s*$")
GERMAN_LIMIT = re.compile(r"^274-([0-9]+)$")


@dataclass
class Rules:
    """What binds which lanelet, filled while the file is read."""

    lights: dict[str, Light] = field(default_factory=dict)
    signs: dict[str, Sign] = field(default_factory=dict)
    lane_lights: dict[str, list[str]] = field(default_factory=dict)
    lane_signs: dict[str, list[str]] = field(default_factory=dict)
    limits: dict[str, list[float]] = field(default_factory=dict)
    stop_lines: dict[str, StopLine] = field(default_factory=dict)
    controls: dict[str, Control] = field(default_factory=dict)


def speed_of(text: str) -> float | None:
    """A speed limit's text in m/s: `30 mph`, `50 km/h`, a bare number in km/h as OSM means it; None for anything else (`de:urban`)."""
    found = SPEED.match(text)
    if found is None:
        return None
    unit = {"mph": "mph", "m/s": "m/s"}.get(found[2] or "", "km/h")
    return float(to_si(float(found[1]), unit))


def read_rules(osm: OsmMap, lanelets: list[Relation], notes: list[str]) -> Rules:
    """Every regulatory element that a lanelet names, of the kinds in READ; others are noted."""
    rules = Rules()
    for lanelet in lanelets:
        for ref in lanelet.refs("regulatory_element", "relation"):
            element = osm.relations[ref]
            kind = element.tags.get("subtype", "none")
            if kind not in READ:
                notes.append(f"regulatory elements of subtype {kind} are not read")
                continue
            _bind(osm, rules, lanelet, element, kind)
    return rules


def _bind(osm: OsmMap, rules: Rules, lanelet: Relation, element: Relation, kind: str) -> None:
    lane = lanelet.id
    lights: tuple[str, ...] = ()
    signs: tuple[str, ...] = ()
    if kind == "traffic_light":
        lights = tuple(_light(osm, rules, ref) for ref in element.refs("refers", "way"))
        _extend(rules.lane_lights, lane, lights)
    if kind in ("traffic_sign", "speed_limit", "right_of_way", "all_way_stop"):
        signs = tuple(_sign(osm, rules, ref) for ref in element.refs("refers", "way"))
        _extend(rules.lane_signs, lane, signs)
    speeds = [speed for name in signs if (speed := rules.signs[name].speed) is not None]
    if kind == "speed_limit" and (stated := speed_of(element.tags.get("sign_type", ""))) is not None:
        speeds.append(stated)
    _extend(rules.limits, lane, tuple(speeds))
    control = _control(rules, element, kind, lane, signs)
    if control is not None:
        rules.controls[lane] = control
    _stop_line(osm, rules, element, kind, lane, lights, signs)


def _extend(table: dict[str, list[Item]], key: str, items: tuple[Item, ...]) -> None:
    for item in items:
        if item not in table.setdefault(key, []):
            table[key].append(item)


def _light(osm: OsmMap, rules: Rules, way: str) -> str:
    """The light drawn as this way; the format has no cycle, and no direction beside the bulbs' arrows."""
    if way not in rules.lights:
        x, y = osm.line(way).mean(axis=0)
        rules.lights[way] = Light(way, (float(x), float(y)))
    return way


def _sign(osm: OsmMap, rules: Rules, way: str) -> str:
    """The sign drawn as this way; its code without the country, `us` ones being those of the MUTCD."""
    if way not in rules.signs:
        tags = osm.ways[way].tags
        x, y = osm.line(way).mean(axis=0)
        code = COUNTRY.sub("", tags.get("subtype", "") or tags.get("traffic_sign_type", ""))
        values = tuple(tags[key] for key in ("value", "speed_limit") if key in tags)
        rules.signs[way] = Sign(way, code, (float(x), float(y)), values, _printed_speed(code, tags))
    return way


def _printed_speed(code: str, tags: Tags) -> float | None:
    """The maximum speed that a sign prints: MUTCD R2-1 in miles per hour, German 274 in kilometres per hour."""
    german = GERMAN_LIMIT.match(code)
    if german is not None:
        return speed_of(german[1])
    text = tags.get("speed_limit", tags.get("value", ""))
    if code == "274":
        return speed_of(text)
    if code == "R2-1":
        return speed_of(text if not text.strip().isdigit() else f"{text} mph")
    return None


def _control(rules: Rules, element: Relation, kind: str, lane: str, signs: tuple[str, ...]) -> Control | None:
    """How the element regulates the lanelet's way into the junction; a sign says more than the element it stands in."""
    codes = {rules.signs[name].code for name in signs}
    if kind == "all_way_stop":
        return "all_way_stop"
    if kind == "right_of_way" and lane in element.refs("right_of_way"):
        return "none"
    if codes & STOP_CODES:
        return "stop"
    if codes & YIELD_CODES or (kind == "right_of_way" and lane in element.refs("yield")):
        return "yield"
    return None


def _stop_line(osm: OsmMap, rules: Rules, element: Relation, kind: str, lane: str, lights: tuple[str, ...], signs: tuple[str, ...]) -> None:
    """The line the element refers to, of several the one nearest to the lanelet's ends; none for those who have the right of way."""
    lines = element.refs("ref_line", "way")
    if not lines or (kind == "right_of_way" and lane in element.refs("right_of_way")):
        return
    ends = _ends(osm, lane)
    name = min(lines, key=lambda way: (float(np.hypot(*(ends - osm.line(way).mean(axis=0)).T).min()), way))
    line, earlier = osm.line(name), rules.stop_lines.get(lane)
    if earlier is not None and earlier.id == name:
        lights, signs = (*earlier.lights, *lights), (*earlier.signs, *signs)
    elif earlier is not None and earlier.lights:
        return
    (x1, y1), (x2, y2) = line[0], line[-1]
    marked = osm.ways[name].tags.get("type") == "stop_line"
    rules.stop_lines[lane] = StopLine(name, (float(x1), float(y1)), (float(x2), float(y2)), marked, lights, signs)


def _ends(osm: OsmMap, lane: str) -> Floats:
    """The middles of the lanelet's two ends, whichever way its sides are drawn (2, 2)."""
    left, right = (osm.line(osm.relations[lane].refs(role, "way")[0]) for role in ("left", "right"))
    if np.hypot(*(left[0] - right[0])) > np.hypot(*(left[0] - right[-1])):
        right = right[::-1]
    return np.array([(left[0] + right[0]) / 2, (left[-1] + right[-1]) / 2])
