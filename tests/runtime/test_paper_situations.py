"""Every situation of the paper, from a map, road users and a drive instead of words: the same verdict, rules, limits and unknowns."""

from __future__ import annotations

import datetime
from pathlib import Path
from typing import Any

import pytest
import yaml
from regdb_runtime.observation import Indication
from regdb_runtime.scenes.stretch import Stretch
from regdb_runtime.worlds.road_spec import SignSpec, ZoneSpec
from small_worlds import LIGHT, Street, car, cross, law, quiet_eye, read, road

from regdb.situation import Plan, read_plan, read_scene

CASES = yaml.load((Path(__file__).resolve().parents[2] / "codes/cvc/cases/paper.yaml").read_text(), yaml.BaseLoader)["cases"]
MPH, FT = 0.44704, 0.3048
PLACE = "california"


def speed_limit(scene: dict[str, Any]) -> float | None:
    """The number on the case's sign, m/s."""
    return float(read({"posted.speed": scene["posted.speed"]})["posted.speed"]) if "posted.speed" in scene else None  # type: ignore[arg-type]


def freeway(scene: dict[str, Any]) -> Stretch:
    """One half of a divided freeway of eight lanes, with nothing posted."""
    facts = {"road.types": scene["road.types"], "road.divided": True, "road.lanes": 8}
    street = Street(road(forward=4, backward=0, limit=None, facts_of_road=facts, jurisdiction=PLACE), ("main.e.2",))
    street.see(50.0, 30.0)
    return street.first()


def cyclist(scene: dict[str, Any], plan: dict[str, Any], on: datetime.date) -> Stretch:
    """A cyclist rides at the edge ahead; a second lane is free, or there is none."""
    lanes = 2 if scene["lane.same_direction_available"] == "true" else 1
    street = Street(road(forward=lanes, backward=lanes, limit=speed_limit(scene), jurisdiction=PLACE), ("main.e.1",))
    edge = -3.5 * lanes
    street.see(50.0, 13.0, [car("rider", 75.0, edge + 0.4, speed=5.0, kind="bicycle")], clock=at(on))
    stretch = street.first(plan["current"], plan["next"], passes="rider", passing_side="left")
    assert stretch.roles["bicycle.ahead"] is True
    return stretch


def red_light(scene: dict[str, Any], plan: dict[str, Any], on: datetime.date) -> Stretch:
    """A drive up to a signal that shows red, with a full stop or without one, then the plan to turn right."""
    arrow = scene["signal.shape"] == "arrow"
    signs = (SignSpec("no_turn", "R10-11", "west", 190.0),) if scene.get("sign.no_turn_on_red") == "true" else ()
    spec = cross(arms={"west": {"arrows": ("right",)}} if arrow else {}, roads={"limit": speed_limit(scene)}, signs=signs, jurisdiction=PLACE)
    street = Street(spec, ("west.e.1", "x.e.right", "south.s.1"))
    if scene.get("sign.no_turn_on_red") == "unknown":
        street.eye.pop("sign.no_turn_on_red")
    lights = {LIGHT: (Indication("red"),)}
    if arrow:
        lights["x.e.right.light"] = (Indication("red", "right_arrow"),)
    seen = {"lights": lights, "signal": "right", "clock": at(on)}
    street.drive(140.0, 193.0, 6.0, **seen)
    street.see(194.0, 0.0 if scene["ego.stopped_at_line"] == "true" else 3.0, **seen)  # type: ignore[arg-type]
    street.see(194.1, 1.0, **seen)  # type: ignore[arg-type]
    stretch = street.first(plan["current"], plan["next"])
    assert stretch.stage == "approach"
    return stretch


def school(scene: dict[str, Any], on: datetime.date) -> Stretch:
    """A school beside the road: its zone on the map, its signs on the map, its children seen."""
    away = float(read({"school.distance": scene["school.distance"]})["school.distance"])  # type: ignore[arg-type]
    on_map = ("school.present", "school.zone", "school.local_act", "zone.posted_outside", "district.residence")
    facts = {name: scene[name] for name in on_map if name in scene}
    zone = ZoneSpec("school", "school", "main", 20.0, 380.0, facts=facts, distance_fact="school.distance", landmark=(60.0 + away, -1.75))
    codes = {"sign.school": "S1-1", "sign.school_limit": "S5-1", "sign.school_children_present": "S4-2P"}
    signs = tuple(SignSpec(code, code, "main", 10.0) for fact, code in codes.items() if scene.get(fact) == "true")
    street = Street(road(limit=speed_limit(scene), zones=(zone,), signs=signs, jurisdiction=PLACE), ("main.e.1",))
    street.eye["school.children_going"] = scene.get("school.children_going") == "true"
    for fact in codes:
        if scene.get(fact) == "unknown":
            street.eye.pop(fact)
    street.see(60.0, 10.0, clock=at(on))
    return street.first()


def at(on: datetime.date) -> datetime.datetime:
    return datetime.datetime.combine(on, datetime.time(12))


def build(case: dict[str, Any], current: str, following: str) -> Stretch:
    scene, on = case["scene"], datetime.date.fromisoformat(case["on"])
    plan = {"current": current, "next": following}
    if case["name"].startswith("Speed"):
        return freeway(scene)
    if case["name"].startswith("Cyclist"):
        return cyclist(scene, plan, on)
    return red_light(scene, plan, on) if case["name"].startswith("Right") else school(scene, on)


@pytest.mark.parametrize("case", CASES, ids=[case["name"] for case in CASES])
def test_situation(case: dict[str, Any]) -> None:
    vocabulary = law().vocabulary
    plan = read_plan(case["plan"], vocabulary, law().machine)
    by_hand = law().at(PLACE, case["on"]).judge(read_scene(case["scene"], vocabulary), plan)
    stretch = build(case, plan.current, plan.next)
    of_plan = {"plan.unsafe_pass": False, **plan.facts}  # measured over the pass by the assessment, not by the scene; quiet in the words too
    driven = stretch.view.judge(stretch.prepared, Plan(plan.current, plan.next, {**stretch.roles, **of_plan}))
    assert driven.verdict == by_hand.verdict
    assert [rule.id for rule in driven.deciding] == [rule.id for rule in by_hand.deciding]
    assert driven.missing == by_hand.missing
    bounds = {name: item.bound for name, item in by_hand.combined.items()}
    assert {name: item.bound for name, item in driven.combined.items()} == pytest.approx(bounds)


def test_no_situation_is_left_out() -> None:
    kinds = {case["name"].split(":")[0] for case in CASES}
    assert kinds == {"Speed", "Cyclist", "Right on red", "School road"}
    assert quiet_eye()["school.children_going"] is False
