"""Time one verdict: the compiled index against the reference evaluator and the paper's way (pandas filter and keyword search).

Rule sets of 1,000, 10,000 and 100,000 regulations, 1-6 predicates over 60 facts, 1-4 current and next states, flat (one
jurisdiction) or in a tree (a state, 9 counties, 90 cities). Answers are checked equal first; times are interleaved medians on
one core. Run as `.venv/bin/python bench/decide.py [--quick]`; writes out/bench/decide.json.
"""

# ruff: noqa: T201  # a script whose result is what it prints
from __future__ import annotations

import json
import platform
import random
import statistics
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pandas as pd
from regdb_runtime.database import RegulationDatabase

from regdb.condition import And, Compare, Is, Linear, Node, Not, OneOf
from regdb.condition_text import show
from regdb.jurisdiction import Jurisdiction, JurisdictionTree
from regdb.meaning import decide, governing
from regdb.regulation import Limit, Regulation
from regdb.situation import Plan, Scene, Situation
from regdb.states import State, StateMachine, SuperState
from regdb.units import to_si
from regdb.vocabulary import Attribute, Fact, Vocabulary

OUT = Path("out/bench/decide.json")
STATES = tuple(f"drive.s{i}" for i in range(24))
WORDS = ("w0", "w1", "w2", "w3", "w4", "w5")
ROADS = ("highway", "residential", "school", "rural", "alley")
MARKS = {("1000", "tree"): (3.0, 400), ("100000", "tree"): (15.0, 1000)}


def vocabulary() -> Vocabulary:
    facts = [Fact(f"b{i}", "boolean") for i in range(28)]
    facts += [Fact(f"e{i}", "enumeration", values=WORDS) for i in range(16)]
    facts += [Fact(f"q{i}", "quantity", unit="mph") for i in range(14)]
    facts += [Fact("road", "enumeration", values=ROADS), Fact("plan.speed", "quantity", unit="mph", source="plan")]
    return Vocabulary(facts, [Attribute("max_speed", "limit", "plan.speed", "max")])


def machine() -> StateMachine:
    return StateMachine([SuperState("drive")], [State("drive", name[6:], next=STATES) for name in STATES], "drive")


def tree() -> JurisdictionTree:
    counties = [Jurisdiction(f"county{i}", f"County {i}", "county", "state") for i in range(9)]
    cities = [Jurisdiction(f"city{i}", f"City {i}", "city", f"county{i % 9}") for i in range(90)]
    return JurisdictionTree([Jurisdiction("state", "State"), *counties, *cities])


def predicate(dice: random.Random) -> Node:
    kind = dice.random()
    if kind < 0.45:
        node: Node = Is(f"b{dice.randrange(28)}")
        return node if dice.random() < 0.7 else Not(node)
    if kind < 0.7:
        return OneOf(f"e{dice.randrange(16)}", tuple(sorted(dice.sample(WORDS, dice.randint(1, 3)))))
    if kind < 0.75:
        return OneOf("road", (dice.choice(ROADS),))
    fact = Linear(0.0, ((1.0, f"q{dice.randrange(14)}"),))
    return Compare(dice.choice(("<", "<=", ">", ">=")), fact, Linear(to_si(dice.randrange(5, 80, 5), "mph")), "quantity", "mph")


def regulations(count: int, places: tuple[str, ...], seed: int) -> list[Regulation]:
    dice = random.Random(seed)
    some = lambda: frozenset(dice.sample(STATES, dice.randint(1, 4)))  # noqa: E731
    found = []
    for index in range(count):
        parts = tuple(dict.fromkeys(predicate(dice) for _ in range(dice.randint(1, 6))))
        limits = ()
        if dice.random() < 0.2:
            limits = (Limit("max_speed", "plan.speed", "max", Linear(to_si(dice.randrange(15, 75, 5), "mph")), "mph"),)
        targets = (f"r{dice.randrange(index):06}",) if index and dice.random() < 0.1 else ()
        when = parts[0] if len(parts) == 1 else And(parts)
        place = places[index % len(places)]
        legality = bool(targets) and not limits
        found.append(
            Regulation(f"r{index:06}", f"VC {index}", place, legality, when=when, limits=limits, force="absolute" if limits else "",
                       current=some(), next=some(), targets=targets, condition=show(when))
        )  # fmt: skip
    return found


def scenes(count: int, words: Vocabulary, seed: int) -> list[tuple[Scene, Plan]]:
    dice = random.Random(seed)
    found = []
    for _ in range(count):
        facts: dict[str, Any] = {}
        for fact in words:
            if fact.name != "plan.speed" and dice.random() < 0.95:
                facts[fact.name] = (
                    dice.random() < 0.4 if fact.kind == "boolean" else dice.choice(fact.values) if fact.values else dice.random() * 35
                )
        found.append((Scene(facts), Plan(dice.choice(STATES), dice.choice(STATES), {"plan.speed": dice.random() * 35})))
    return found


class PapersWay:
    """The paper's table in a DataFrame: its fields for place, date, states, road and speed filtered by one expression, then the
    Condition column searched for the scene's keywords. (What it finds is candidates: it knows no exceptions, no unknowns.)"""

    def __init__(self, rules: list[Regulation]) -> None:
        self.frame = pd.DataFrame(
            {
                "Condition": [rule.condition for rule in rules],
                "Jurisdiction": [rule.jurisdiction for rule in rules],
                "Effective": ["2000-01-01"] * len(rules),
                "Attribute: Road Type": [road_of(rule) for rule in rules],
                "Attribute: Max Speed": [rule.limits[0].bound.constant if rule.limits else float("nan") for rule in rules],
                "Possible Current States": [", ".join(sorted(rule.current or ())) for rule in rules],
                "Possible Next States": [", ".join(sorted(rule.next or ())) for rule in rules],
            }
        )

    def judge(self, places: frozenset[str], scene: Scene, plan: Plan) -> Any:
        frame = self.frame
        road, speed = frame["Attribute: Road Type"], frame["Attribute: Max Speed"]
        here = frame[
            frame["Jurisdiction"].isin(places)
            & (frame["Effective"] <= "2026-03-02")
            & ((road == "") | (road == scene.facts.get("road", "")))
            & (speed.isna() | (speed < plan.facts["plan.speed"]))
            & frame["Possible Current States"].str.contains(plan.current, regex=False)
            & frame["Possible Next States"].str.contains(plan.next, regex=False)
        ]
        keywords = "|".join(name for name, value in scene.facts.items() if value is True)
        return here[here["Condition"].str.contains(keywords, regex=True)]


def road_of(rule: Regulation) -> str:
    """The one kind of road a rule speaks of, or nothing."""
    parts = rule.when.parts if isinstance(rule.when, And) else (rule.when,)
    return next((part.words[0] for part in parts if isinstance(part, OneOf) and part.fact == "road"), "")


def clock(run: Callable[[], object], repeats: int) -> float:
    """Microseconds per call of one batch."""
    start = time.perf_counter()
    for _ in range(repeats):
        run()
    return (time.perf_counter() - start) / repeats * 1e6


def measure(count: int, shape: str, rounds: int) -> dict[str, Any]:
    words, place = vocabulary(), "city7" if shape == "tree" else "state"
    jurisdictions = tree()
    places = tuple(item.id for item in jurisdictions) if shape == "tree" else ("state",)
    rules = regulations(count, places, seed=count)
    start = time.perf_counter()
    database = RegulationDatabase(words, machine(), jurisdictions, rules)
    view = database.at(place, "2026-03-02")
    ready = time.perf_counter() - start
    cases = scenes(40, words, seed=1)
    here = governing(rules, jurisdictions, place, 739000)
    check(view, here, words, cases)
    sizes = [len(view.concerned(plan.current, plan.next)) for _, plan in cases]
    prepared = [(view.prepare(scene), plan) for scene, plan in cases]
    paper, path = PapersWay(rules), frozenset(item.id for item in jurisdictions.path(place))
    few = cases[:5]
    ways: dict[str, Callable[[], object]] = {
        "index": lambda: [view.judge(scene, plan) for scene, plan in prepared],
        "index, scene encoded anew": lambda: [view.judge(scene, plan) for scene, plan in cases],
        "reference": lambda: [decide(here, Situation(words, scene, plan)) for scene, plan in few],
        "paper (pandas)": lambda: [paper.judge(path, scene, plan) for scene, plan in few],
    }
    batch = {"index": (50, 40), "index, scene encoded anew": (20, 40), "reference": (1, 5), "paper (pandas)": (1, 5)}
    times: dict[str, list[float]] = {name: [] for name in ways}
    for _ in range(rounds):
        for name, run in ways.items():
            repeats, per = batch[name]
            times[name].append(clock(run, repeats) / per)
    medians = {name: statistics.median(found) for name, found in times.items()}
    warm = clock(lambda: RegulationDatabase(words, machine(), jurisdictions, rules).at(place, 739000).concerned(*STATES[:2]), 1) / 1000
    return {
        "rules": count, "shape": shape, "rules per transition": statistics.mean(sizes), "microseconds": medians,
        "ratio to the paper's way": medians["paper (pandas)"] / medians["index"],
        "ratio to the reference": medians["reference"] / medians["index"], "ready seconds": ready, "first bucket ms": warm,
    }  # fmt: skip


def check(view: Any, here: Any, words: Vocabulary, cases: list[tuple[Scene, Plan]]) -> None:
    """Every answer equal to the reference's, before anything is timed."""
    for scene, plan in cases:
        got, want = view.judge(scene, plan), decide(here, Situation(words, scene, plan))
        same = (got.verdict, got.deciding, [x.bound for x in got.limits]) == (want.verdict, want.deciding, [x.bound for x in want.limits])
        if not same:
            raise SystemExit(f"the index and the reference disagree: {got} / {want.verdict}")


def report(found: list[dict[str, Any]]) -> None:
    print(f"{'rules':>8} {'shape':5} {'in play':>8} {'index us':>9} {'anew us':>8} {'reference':>10} {'paper us':>10} {'x paper':>8}  mark")
    for row in found:
        us = row["microseconds"]
        mark = MARKS.get((str(row["rules"]), row["shape"]))
        told = ""
        if mark:
            met = us["index"] <= mark[0] and row["ratio to the paper's way"] >= mark[1]
            told = f"{mark[0]:g} us, {mark[1]} x: {'met' if met else 'MISSED'}"
        print(
            f"{row['rules']:>8,} {row['shape']:5} {row['rules per transition']:>8.1f} {us['index']:>9.2f} "
            f"{us['index, scene encoded anew']:>8.2f} {us['reference']:>10.0f} {us['paper (pandas)']:>10.0f} "
            f"{row['ratio to the paper' + chr(39) + 's way']:>8.0f}  {told}"
        )


def main() -> None:
    counts = (1000, 10000) if "--quick" in sys.argv else (1000, 10000, 100000)
    found = [measure(count, shape, 7 if count < 100000 else 5) for count in counts for shape in ("flat", "tree")]
    report(found)
    OUT.parent.mkdir(parents=True, exist_ok=True)
    OUT.write_text(json.dumps({"python": platform.python_version(), "machine": platform.machine(), "results": found}, indent=1) + "\n")
    print(f"written: {OUT}")


if __name__ == "__main__":
    main()
