"""What holds across passes on the shipped codes: order changes nothing, dates are half-open, the index answers as the meaning does."""

from __future__ import annotations

import contextlib
import csv
import datetime
import io
import json
import random
import shutil
import sqlite3
from collections.abc import Iterator
from contextlib import closing
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
import yaml
from regdb_compiler.driver import Build, build
from regdb_compiler.emit.outputs import write_outputs
from regdb_compiler.emit.to_sqlite import write_database
from regdb_compiler.parse import to_data
from regdb_compiler.source import read_source
from regdb_runtime.database import RegulationDatabase

from regdb.cli import main
from regdb.content_hash import read_tables
from regdb.meaning import decide, governing
from regdb.situation import Plan, Scene, Situation, quiet_facts
from regdb.vocabulary import Fact, Value, Vocabulary

SHUFFLED_LISTS = frozenset({"regulations", "tests", "cases", "definitions", "delegates"})
"""Lists whose order means nothing. Versions stand oldest first, and the order of states and words is the author's."""

SCENES = 2000
GROUPS = 40
"""Places, days and transitions the scenes are spread over; each group's decision is compiled once."""

DUMPER = getattr(yaml, "CSafeDumper", yaml.SafeDumper)
DAYS = ("1995-06-01", "2014-09-16", "2022-12-31", "2023-01-01", "2026-03-02")


@pytest.fixture(scope="module")
def copied(codes: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The shipped codes as they are at one moment, whoever is writing them."""
    return shutil.copytree(codes, tmp_path_factory.mktemp("copied") / "codes")


@pytest.fixture(scope="module")
def law(copied: Path) -> Build:
    """The shipped codes; errors in a section that is being written are another test's matter."""
    return replace(build(copied), diagnostics=())


@pytest.fixture(scope="module")
def database(law: Build, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("law") / "law.sqlite"
    write_database(law, path)
    return path


@pytest.fixture(scope="module")
def opened(database: Path) -> RegulationDatabase:
    return RegulationDatabase.open(database)


def shuffled(value: Any, chance: random.Random, name: str = "") -> Any:
    """The same data with the keys of every mapping, and the lists whose order means nothing, in another order."""
    if isinstance(value, dict):
        return {key: shuffled(value[key], chance, key) for key in chance.sample(list(value), len(value))}
    if isinstance(value, list):
        items = [shuffled(item, chance) for item in value]
        return chance.sample(items, len(items)) if name in SHUFFLED_LISTS else items
    return value


def rewrite(codes: Path, target: Path, seed: int) -> None:
    """Write a codes folder anew, every file shuffled."""
    chance = random.Random(seed)
    for path in sorted(codes.rglob("*.yaml")):
        file = read_source(path, codes)
        there = target / path.relative_to(codes)
        there.parent.mkdir(parents=True, exist_ok=True)
        if file.root is None or path.name == "states.yaml":  # of states that share a name the machine means the first
            there.write_text(file.text, "utf-8")
            continue
        data = shuffled(to_data(file.root), chance)
        there.write_text(yaml.dump(data, sort_keys=False, allow_unicode=True, Dumper=DUMPER), "utf-8")


@pytest.fixture(scope="module", params=[1, 2])
def other(request: pytest.FixtureRequest, copied: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A database of the codes written in another order."""
    folder = tmp_path_factory.mktemp("shuffled")
    rewrite(copied, folder / "codes", request.param)
    path = folder / "law.sqlite"
    write_database(replace(build(folder / "codes"), diagnostics=()), path)
    return path


def contents(path: Path) -> dict[str, list[tuple[Any, ...]]]:
    """Table -> its rows in some fixed order, without what tells of the files themselves."""
    with closing(sqlite3.connect(path)) as connection:
        tables = read_tables(connection)
    kept = {name: table for name, table in tables.items() if name != "regdb_meta"}
    return {name: sorted(zip(*table.columns.values(), strict=True), key=repr) for name, table in kept.items()}


def test_order_of_files_keys_and_regulations_does_not_change_the_database(database: Path, other: Path) -> None:
    ours, theirs = contents(database), contents(other)
    assert list(ours) == list(theirs)
    differing = {name: [pair for pair in zip(ours[name], theirs[name], strict=False) if pair[0] != pair[1]][:1] for name in ours}
    assert {name: pairs for name, pairs in differing.items() if pairs} == {}
    assert {name: len(rows) for name, rows in ours.items()} == {name: len(rows) for name, rows in theirs.items()}


def test_order_of_files_keys_and_regulations_does_not_change_verdicts(opened: RegulationDatabase, other: Path) -> None:
    second = RegulationDatabase.open(other)
    for place, day, plan, scene in questions(opened, 200, 20, seed=5):
        one, two = opened.at(place, day).judge(scene, plan), second.at(place, day).judge(scene, plan)
        assert told(one) == told(two)


def value_of(fact: Fact, chance: random.Random) -> Value:
    """A value the fact can have, often the one at an edge that law speaks of."""
    if fact.kind == "boolean":
        return chance.random() < 0.3
    if fact.kind == "enumeration":
        return chance.choice(fact.values)
    if fact.kind == "set":
        return frozenset(chance.sample(fact.values, chance.randint(0, min(3, len(fact.values)))))
    if fact.kind == "count":
        return chance.randint(0, 4)
    if fact.kind == "time":
        return chance.choice((0, 7 * 3600, 12 * 3600, 16 * 3600, 22 * 3600, 86399))
    if fact.kind == "date":
        return chance.randint(730000, 740000)
    read = fact.read(f"{chance.choice((0, 1, 2.9, 3, 15, 20, 25, 30, 55, 65, 65.1, 100, 300, 500))} {fact.unit}")
    assert read is not None
    return read


def scene_of(vocabulary: Vocabulary, chance: random.Random) -> tuple[Scene, dict[str, Value]]:
    """A scene near the quiet one: some facts as anything they can be, some unknown; and the plan's facts."""
    facts, planned = quiet_facts(vocabulary), {}
    for fact in vocabulary:
        dice = chance.random()
        if fact.source == "plan":
            facts.pop(fact.name, None)
            if dice < 0.8:
                planned[fact.name] = value_of(fact, chance)
        elif dice < 0.15:
            facts[fact.name] = value_of(fact, chance)
        elif dice < 0.2:
            facts.pop(fact.name, None)
    return Scene(facts, frozenset({"perception"} if chance.random() < 0.1 else ())), planned


def questions(found: RegulationDatabase, count: int, groups: int, seed: int) -> Iterator[tuple[str, str, Plan, Scene]]:
    """Place, day, plan and scene, over all jurisdictions, several days and some of the machine's transitions."""
    chance = random.Random(seed)
    places = [item.id for item in found.tree]
    for number in range(groups):
        place, day = places[number % len(places)], chance.choice(DAYS)
        current = chance.choice(list(found.machine.states.values()))
        following = chance.choice(current.next)
        for _ in range(count // groups):
            scene, planned = scene_of(found.vocabulary, chance)
            yield place, day, Plan(current.id, following, planned), scene


def told(answer: Any) -> tuple[Any, ...]:
    """A verdict or a decision as plain data."""
    bounds = [[(item.regulation.id, item.limit.attribute, item.bound) for item in group] for group in (answer.limits, answer.possible)]
    return answer.verdict, [rule.id for rule in answer.deciding], bounds, sorted(answer.missing), sorted(answer.assumed)


def test_the_runtime_answers_as_the_meaning_does(law: Build, opened: RegulationDatabase) -> None:
    verdicts: dict[str, int] = {}
    tree, in_force = law.corpus.tree, {}
    for place, day, plan, scene in questions(opened, SCENES, GROUPS, seed=11):
        view = opened.at(place, day)
        rules = in_force.get((place, day))
        if rules is None:
            number = datetime.date.fromisoformat(day).toordinal()
            rules = in_force[place, day] = governing(law.regulations, tree, place, number)
        want = decide(rules, Situation(law.corpus.vocabulary, scene, plan))
        assert told(view.judge(scene, plan)) == told(want)
        verdicts[want.verdict] = verdicts.get(want.verdict, 0) + 1
    assert set(verdicts) == {"legal", "illegal", "unknown"}, verdicts
    assert sum(verdicts.values()) == SCENES


def test_the_table_reads_back_as_the_database_has_it(law: Build, tmp_path: Path) -> None:
    write_outputs(law, tmp_path)
    with (tmp_path / "regulations.csv").open(encoding="utf-8", newline="") as file:
        lines = list(csv.DictReader(file))
    found = RegulationDatabase.open(tmp_path / "regulations.sqlite").regulations
    assert len(lines) == len(found) == len(law.regulations)
    iso = {(line["id"], line["effective"]): line for line in lines}
    for rule in found:
        line = iso[rule.id, _iso(rule.effective)]
        assert (line["citation"], line["result"], line["quote"]) == (rule.citation, rule.result, rule.quote)
        assert (line["legality"] == "TRUE", line["until"]) == (rule.legality, _iso(rule.until))


def _iso(day: int | None) -> str:
    return "" if day is None else datetime.date.fromordinal(day).isoformat()


def check(database: Path, on: str, *facts: str) -> tuple[set[str], set[str]]:
    """Ids that decide, and ids whose limits are in force, by `regdb check` on a day."""
    words = [part for fact in facts for part in ("--fact", fact)]
    state = "overtaking.go_straight"
    output = io.StringIO()
    with contextlib.redirect_stdout(output), pytest.raises(SystemExit):
        main(["check", "--db", str(database), "--in", "california", "--on", on, "--current", state, "--next", state, *words, "--format", "json"])
    data = json.loads(output.getvalue())
    assert data["date"] == on
    return {rule["id"] for rule in data["deciding"]}, {item["id"] for item in data["limits"]}


@pytest.mark.parametrize(("day", "in_force"), [("2014-09-15", False), ("2014-09-16", True), ("2014-09-17", True)])
def test_a_section_begins_on_its_day(database: Path, day: str, in_force: bool) -> None:
    deciding, limits = check(
        database, day, "plan.passes=bicycle", "plan.clearance=2.9 ft", "plan.no_room_for_three_feet=false", "bicycle.endangered_by_pass=false"
    )
    assert ("cvc-21760-c" in deciding) is in_force
    assert ("cvc-21760-c" in limits) is in_force


@pytest.mark.parametrize(("day", "in_force"), [("2022-12-31", False), ("2023-01-01", True), ("2023-01-02", True)])
def test_a_version_ends_when_the_next_begins(database: Path, day: str, in_force: bool) -> None:
    facts = ("plan.passes=bicycle", "plan.clearance=4 ft", "plan.passes_in_same_lane=true", "lane.same_direction_available=true")
    deciding, limits = check(database, day, *facts, "plan.no_room_for_three_feet=false", "bicycle.endangered_by_pass=false")
    assert ("cvc-21760-c-lane" in deciding) is in_force
    assert "cvc-21760-c" in limits


def test_of_every_regulation_one_version_at_most_is_in_force_on_any_day_around_a_change(opened: RegulationDatabase) -> None:
    days = {day for rule in opened.regulations for day in (rule.effective, rule.until) if day is not None}
    for day in sorted({one + step for one in days for step in (-1, 0, 1)}):
        ids = [rule.id for rule in opened.regulations if rule.in_force(day)]
        assert len(ids) == len(set(ids)), day
