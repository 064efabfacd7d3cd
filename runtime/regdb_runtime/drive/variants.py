"""Every variant of the paper's drive as data: what differs from the paper's scene, and what the law makes of it."""

from __future__ import annotations

import difflib
from dataclasses import dataclass, replace
from typing import Literal

from regdb_runtime.drive.paper_scene import PaperScene
from regdb_runtime.errors import RequestError

OVERTAKES = ("overtaking_begins", "back_in_lane")
TURNS_ON_RED = ("stopped", "released")
SLOWS = ("zone_detected", "reduced_speed")


@dataclass(frozen=True)
class Expectation:
    """What a drive must show.

    `events`: exactly these, in order. `sections`: citations among those that decided. `zone_limit`: m/s that no tick in the zone exceeds.
    `passes`: from which lane the cyclist is passed, empty when it is not. `crosses`: what the light shows as the line is crossed. `ends`: how the
    drive ends; a `standstill` is an end where the law cannot be known to allow going on, and says so.
    """

    says: str
    events: tuple[str, ...] = ()
    sections: tuple[str, ...] = ()
    zone_limit: float | None = None
    passes: Literal["", "same_lane", "next_lane"] = ""
    crosses: Literal["", "red", "green"] = ""
    ends: Literal["destination", "standstill"] = "destination"


@dataclass(frozen=True)
class Variant:
    """One drive: its scene, what must happen, and `codes`, the folder of codes added for it (of this package; empty: none)."""

    name: str
    scene: PaperScene
    expects: Expectation
    codes: str = ""


_MPH = 0.44704
_WHOLE = PaperScene()
_CYCLIST = PaperScene(part="cyclist")
_RED = PaperScene(part="red")
_SCHOOL = PaperScene(part="school")
_WIDE = replace(_CYCLIST, width=4.6, beside=False)
_ONE_LANE = replace(_CYCLIST, lanes=1)
_2022, _2023, _2031 = "2022-12-30T07:40:00", "2023-01-02T07:40:00", "2031-02-03T07:40:00"

_FOLLOWS = "stays behind the cyclist until it turns off"
_WAITS = "stops at the line and waits for green"

VARIANTS: tuple[Variant, ...] = (
    Variant("paper", _WHOLE, Expectation(
        "passes the cyclist from the second lane, turns right on red after a full stop, keeps 25 mph past the school",
        (*OVERTAKES, *TURNS_ON_RED, *SLOWS), ("CVC 21760(c)", "CVC 21453(a)", "CVC 21453(b)", "CVC 22352(b)(2)"), 25 * _MPH, "next_lane", "red",
    )),
    Variant("cyclist", _CYCLIST, Expectation("passes from the second lane and comes back", OVERTAKES, ("CVC 21760(c)",), passes="next_lane")),
    Variant("cyclist-2022", replace(_WIDE, start=_2022), Expectation(
        "may pass within the lane, at three feet or more: the older text of 21760", OVERTAKES, ("CVC 21760(c)",), passes="same_lane",
    )),
    Variant("cyclist-2023", replace(_WIDE, start=_2023), Expectation(
        "must change lanes to pass: 21760(c) as of 2023-01-01", OVERTAKES, ("CVC 21760(c)",), passes="next_lane",
    )),
    Variant("solid-line", replace(_CYCLIST, divider="double_solid", width=3.4, beside=False), Expectation(
        f"{_FOLLOWS}: the double line may not be crossed, the lane leaves no three feet", (), ("CVC 21460(b)", "CVC 21760(c)"),
    )),
    Variant("lane-3.4m", replace(_ONE_LANE, width=3.4), Expectation(
        f"{_FOLLOWS}: one lane, too narrow for three feet", (), ("CVC 21760(c)",),
    )),
    Variant("lane-3.5m", replace(_ONE_LANE, width=3.5), Expectation(
        "passes within the lane, just wide enough for three feet", OVERTAKES, ("CVC 21760(c)",), passes="same_lane",
    )),
    Variant("red", _RED, Expectation(
        "stops, looks, turns right on red", TURNS_ON_RED, ("CVC 21453(a)", "CVC 21453(b)"), crosses="red",
    )),
    Variant("no-turn-sign", replace(_RED, no_turn_sign=True), Expectation(
        f"{_WAITS}: a sign forbids the turn on red", TURNS_ON_RED, ("CVC 21453(a)",), crosses="green",
    )),
    Variant("red-arrow", replace(_RED, light="red_arrow"), Expectation(
        f"{_WAITS}: no turning on a red arrow", TURNS_ON_RED, ("CVC 21453(c)",), crosses="green",
    )),
    Variant("pedestrian", replace(_RED, pedestrian=True), Expectation(
        "lets the pedestrian cross before it turns on red", TURNS_ON_RED, ("CVC 21453(a)",), crosses="red",
    )),
    Variant("cross-traffic", replace(_RED, cross_traffic=True), Expectation(
        "waits for a gap in the crossing traffic before it turns on red", TURNS_ON_RED, ("CVC 21453(a)",), crosses="red",
    )),
    Variant("green", replace(_RED, light="green"), Expectation("turns without stopping", (), (), crosses="green")),
    Variant("no-right-on-red", replace(_RED, jurisdiction="new_york_city"), Expectation(
        f"{_WAITS}: this city's law has no right on red", TURNS_ON_RED, ("RCNY 4-03(a)(3)",), crosses="green",
    ), "added_codes"),
    Variant("right-on-red-upstate", replace(_RED, jurisdiction="new_york"), Expectation(
        "stops, looks, turns right on red: the same scene under the State's law", TURNS_ON_RED, ("NYVTL 1111(d)(1)", "NYVTL 1111(d)(2)(a)"),
        crosses="red",
    ), "added_codes"),
    Variant("school", _SCHOOL, Expectation("keeps 25 mph past the school", SLOWS, ("CVC 22352(b)(2)",), 25 * _MPH)),
    Variant("school-no-children", replace(_SCHOOL, children=False), Expectation("drives on: no children go to school", (), (), 35 * _MPH)),
    Variant("school-no-sign", replace(_SCHOOL, school="no_sign"), Expectation("drives on: no sign, no limit", (), (), 35 * _MPH)),
    Variant("school-20", replace(_SCHOOL, school="limit_20"), Expectation(
        "keeps 20 mph by the city's act and its sign", SLOWS, ("CVC 22352.5(a)",), 20 * _MPH,
    )),
    Variant("school-2031", replace(_SCHOOL, start=_2031), Expectation(
        "drives on: as of 2031 the SCHOOL sign alone sets no limit", (), (), 35 * _MPH,
    )),
    Variant("school-2031-sign", replace(_SCHOOL, school="children_sign", start=_2031), Expectation(
        "keeps 20 mph: as of 2031, under a sign that says when children are present", SLOWS, ("CVC 22352(b)(2)",), 20 * _MPH,
    )),
    Variant("school-band", replace(_SCHOOL, school="band"), Expectation(
        "keeps 25 mph in the band before the school zone that the paper quotes, on a road posted 30", SLOWS, ("CVC 22358.4(b)(1)(B)",), 25 * _MPH,
    )),
    Variant("vlm-silent", replace(_RED, misses=("sign.no_turn_on_red",)), Expectation(
        f"{_WAITS}: whether a sign forbids the turn is not known", TURNS_ON_RED, ("CVC 21453(a)",), crosses="green",
    )),
    Variant("school-silent", replace(_SCHOOL, misses=("school.children_going",)), Expectation(
        "keeps 25 mph: whether children go to school is not known", SLOWS, (), 25 * _MPH,
    )),
    Variant("no-eye", replace(_WHOLE, eye="none"), Expectation(
        "is blind to signs and people who direct traffic: drives on where that leaves nothing weightier open, and stays at the light",
        (*OVERTAKES, "stopped"), ("CVC 21760(c)", "CVC 21453(a)"), passes="same_lane", ends="standstill",
    )),
)  # fmt: skip
"""In the order in which they are listed and driven."""


def variant(name: str) -> Variant:
    """The variant of that name. Raises RequestError with the nearest one there is."""
    for item in VARIANTS:
        if item.name == name:
            return item
    near = difflib.get_close_matches(name, [item.name for item in VARIANTS], 1)
    hint = f"did you mean {near[0]}?" if near else f"there are: {', '.join(item.name for item in VARIANTS)}"
    raise RequestError(f"there is no variant {name!r} of the drive; {hint}")
