"""The matcher's statements in the words of an outside labelling: 65 keys of what a description of a driving scene states."""

from __future__ import annotations

import re
from functools import lru_cache

from regdb_runtime.database import RegulationDatabase
from regdb_runtime.perception.evidence import Reading, Span, Statement
from regdb_runtime.perception.matcher import Matcher

from regdb.front import database

PRESENT: dict[str, tuple[str, ...]] = {
    "stop_sign": ("sign.stop",), "stop_here_on_red": ("sign.stop_here_on_red",), "yield_sign": ("sign.yield",),
    "no_turn_on_red": ("sign.no_turn_on_red",), "no_left_turn": ("sign.no_left_turn",), "no_right_turn": ("sign.no_right_turn",),
    "no_u_turn": ("sign.no_u_turn",), "do_not_enter": ("sign.do_not_enter",), "wrong_way": ("sign.wrong_way",), "one_way": ("road.one_way",),
    "road_closed": ("road.closed", "sign.street_closed"), "no_parking": ("sign.no_parking",), "no_passing": ("sign.no_passing",),
    "left_turn_only": ("sign.left_turn_only",), "right_turn_only": ("sign.right_turn_only",), "keep_left": ("sign.keep_left",),
    "keep_right": ("sign.keep_right",), "no_trucks": ("sign.no_trucks",), "no_bicycles": ("sign.no_bicycles",),
    "no_pedestrians": ("sign.no_pedestrians",), "school_zone": ("school.zone", "sign.school", "sign.school_limit"),
    "end_school_zone": ("sign.end_school_zone",), "road_work": ("work_zone.present", "sign.road_work"), "end_road_work": ("sign.end_road_work",),
    "residential": ("district.residence",), "parking_lot": ("place.parking_lot",), "bus_stop": ("place.bus_stop",),
    "intersection": ("intersection.present",), "roundabout": ("intersection.roundabout",), "railroad_crossing": ("rail.crossing_ahead",),
    "crosswalk": ("crosswalk.present", "crosswalk.marked", "sign.pedestrian_crossing"),
    "bicycle_lane": ("bicycle_lane.present", "sign.bicycle_lane"), "bus_lane": ("bus_lane.present",), "hov_lane": ("hov_lane.present",),
    "two_way": ("road.two_way",), "stop_line": ("stop_line.present",), "lane_ends": ("lane.ends",), "speed_bump": ("road.speed_bump",),
    "curve": ("road.curve_ahead",), "traffic_cones": ("traffic_cones.present",), "barrier": ("barrier.present",),
    "pedestrian": ("pedestrian.present",), "pedestrian_crossing": ("pedestrian.on_roadway", "pedestrian.in_crosswalk"),
    "cyclist": ("bicycle.present",), "motorcyclist": ("motorcycle.present",), "lead_vehicle": ("lead.present",),
    "oncoming_vehicle": ("oncoming.meeting",), "parked_vehicle": ("parked_vehicle.present",), "lane_blocked": ("obstruction.ahead",),
    "emergency_vehicle": ("emergency_vehicle.present",), "school_bus": ("school_bus.present",), "worker": ("work_zone.workers_near",),
    "traffic_director": ("director.present",),
}  # fmt: skip
"""Key -> the boolean facts (or facts with a value other than none) that make it hold."""

VALUES: dict[tuple[str, str], tuple[str, str | bool]] = {
    ("road.types", "freeway"): ("highway", True), ("lane.center_marking", "double_solid_yellow"): ("double_yellow", True),
    ("lane.center_marking", "broken_yellow"): ("dashed_line", True), ("lane.center_marking", "solid_on_left"): ("dashed_line", True),
    ("lane.center_marking", "solid_on_right"): ("solid_line", True), ("lane.crossed_marking", "broken_white"): ("dashed_line", True),
    ("lane.crossed_marking", "broken_yellow"): ("dashed_line", True), ("lane.crossed_marking", "solid_white"): ("solid_line", True),
    ("lane.crossed_marking", "double_solid_white"): ("solid_line", True), ("lane.crossed_marking", "solid_yellow"): ("solid_line", True),
    ("lane.crossed_marking", "double_solid_yellow"): ("double_yellow", True),
    **{("weather.conditions", word): ("weather", word) for word in ("clear", "cloudy", "rain", "snow", "fog")},
    **{("road.surface", word): ("surface", word) for word in ("dry", "wet", "snowy_icy")},
    **{("scene.daylight", word): ("time", word) for word in ("day", "dusk", "night")},
}  # fmt: skip
"""(fact, value) -> (key, its value)."""

SPEEDS = {"posted.speed": "speed_limit", "posted.advisory_speed": "advisory_speed", "posted.minimum_speed": "minimum_speed"}
_OF_FACT: dict[str, tuple[str, ...]] = {}
for _key, _facts in PRESENT.items():
    for _fact in _facts:
        _OF_FACT[_fact] = (*_OF_FACT.get(_fact, ()), _key)
_WRITTEN = re.compile(r"(mph|mi/h|miles|km|kilomet|kph)", re.IGNORECASE)
_MPH, _KMH = 0.44704, 1 / 3.6

Answer = bool | list[str | bool]


@lru_cache(maxsize=1)
def matcher() -> Matcher:
    """The matcher of the shipped codes."""
    return Matcher(RegulationDatabase.open(database()).vocabulary)


def facts(text: str) -> dict[str, Answer]:
    """What the text states, in the keys of the labelling."""
    return keys_of(matcher().read(text))


def keys_of(reading: Reading) -> dict[str, Answer]:
    """Asserted statements as keys; hedged ones are left out, a denial gives False where nothing asserts."""
    found: dict[str, Answer] = {}
    denied: set[str] = set()
    sure = [item for item in reading.statements if item.certainty == "asserted"]
    for item in sure:
        if item.value is False:
            denied.update(_OF_FACT.get(item.fact, ()))
            if item.fact == "signal.present":
                denied.add("traffic_light")
        elif item.fact in _OF_FACT and item.value != "none":
            found.update(dict.fromkeys(_OF_FACT[item.fact], True))
        elif item.fact in SPEEDS:
            _add(found, SPEEDS[item.fact], _speed(reading.text, item))
        else:
            for word in item.value if isinstance(item.value, frozenset) else (item.value,):
                key, value = VALUES.get((item.fact, str(word)), ("", ""))
                if key:
                    _add(found, key, value)
    _lights(sure, found)
    return dict.fromkeys(denied - set(found), False) | found


def _add(found: dict[str, Answer], key: str, value: str | bool) -> None:
    if value is True:
        found[key] = True
        return
    held = found.setdefault(key, [])
    if isinstance(held, list) and value not in held:
        held.append(value)


def _speed(text: str, item: Statement) -> str:
    """The number in the unit written, bare where none is."""
    assert isinstance(item.value, (int, float))
    unit = next((match[0].lower() for span in item.spans if (match := _WRITTEN.search(text[span.start : span.end]))), "")
    if unit.startswith("k") or (not unit and abs(item.value / _MPH - round(item.value / _MPH)) > 0.01):
        return f"{round(item.value / _KMH, 1):g} km/h"
    return f"{round(item.value / _MPH, 1):g}{' mph' if unit else ''}"


def _lights(sure: list[Statement], found: dict[str, Answer]) -> None:
    """Colours by shape; a light that is there and of which no colour is said is `unknown`."""
    arrows = {item.spans for item in sure if item.fact == "signal.shape" and item.value == "arrow"}
    flashing = [span for item in sure if item.fact == "signal.flashing" and item.value is True for span in item.spans]
    for item in sure:
        if item.fact == "signal.color" and item.value != "none":
            blinks = "flashing_" if any(_overlap(span, other) for span in item.spans for other in flashing) else ""
            _add(found, "arrow_light" if item.spans in arrows else "traffic_light", f"{blinks}{item.value}")
        elif item.fact == "signal.inoperative" and item.value is True:
            _add(found, "traffic_light", "off")
    if "traffic_light" not in found and "arrow_light" not in found and any(item.fact == "signal.present" and item.value is True for item in sure):
        found["traffic_light"] = ["unknown"]


def _overlap(one: Span, other: Span) -> bool:
    return one.start < other.end and other.start < one.end
