"""Mutation of the law: which changes are made, which tests notice them, what cannot be told apart, and how it is reported."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from regdb_compiler.driver import Build, build
from regdb_compiler.mutation.change_condition import changes
from regdb_compiler.mutation.generate import generate
from regdb_compiler.mutation.report import mutation_data, mutation_text
from regdb_compiler.mutation.run import Mutation, chosen, judge_mutants
from regdb_compiler.parse_condition import parse_condition

from regdb import cli
from regdb.condition import Node
from regdb.condition_text import show
from regdb.vocabulary import Fact, Vocabulary

Builder = Callable[..., Build]
Town = Callable[..., Path]
WORDS = Vocabulary(
    [
        Fact("a", "boolean"), Fact("b", "boolean"), Fact("color", "enumeration", values=("none", "red", "green", "yellow")),
        Fact("types", "set", values=("highway", "alley")), Fact("speed", "quantity", unit="mph"), Fact("now", "time"), Fact("lanes", "count"),
    ]
)  # fmt: skip


def node(text: str) -> Node:
    found = parse_condition(text, WORDS).node
    assert found is not None
    return found


def changed(text: str) -> set[tuple[str, str]]:
    """Kinds and texts of every change of a condition."""
    return {(item.kind, show(item.node)) for item in changes(node(text), WORDS)}


def mutation(found: Build) -> Mutation:
    mutants = generate(found)
    return Mutation(tuple(judge_mutants(found, mutants)), len(mutants))


def survivors(found: Build) -> set[str]:
    return {str(item.mutant) for item in mutation(found).survivors}


def run(capsys: pytest.CaptureFixture[str], *arguments: str | Path) -> tuple[int, str, str]:
    with pytest.raises(SystemExit) as stop:
        cli.main(["test", *map(str, arguments)])
    told = capsys.readouterr()
    return int(stop.value.code or 0), told.out, told.err


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("a", {("part", "true"), ("negation", "not a")}),
        ("not a", {("part", "true"), ("negation", "a")}),
        ("a and b", {("part", "a"), ("part", "b"), ("negation", "not a and b"), ("negation", "a and not b")}),
        ("a or b", {("part", "a"), ("part", "b"), ("negation", "not a or b"), ("negation", "a or not b")}),
        ("color == red", {("part", "true"), ("negation", "color != red"), ("word", "color == green")}),
        ("color in {red, green}",
         {("part", "true"), ("negation", "not color in {green, red}"), ("word", "color == red"), ("word", "color == green")}),
        ("highway in types", {("part", "true"), ("negation", "not highway in types"), ("word", "alley in types")}),
        ("speed < 25 mph", {("part", "true"), ("negation", "not speed < 25 mph"), ("operator", "speed <= 25 mph"),
                            ("bound", "speed < 26 mph"), ("bound", "speed < 24 mph")}),
        ("speed >= 2.5 mph", {("part", "true"), ("negation", "not speed >= 2.5 mph"), ("operator", "speed > 2.5 mph"),
                              ("bound", "speed >= 2.6 mph"), ("bound", "speed >= 2.4 mph")}),
        ("lanes == 2", {("part", "true"), ("negation", "not lanes == 2"), ("operator", "lanes <= 2"), ("operator", "lanes >= 2"),
                        ("bound", "lanes == 3"), ("bound", "lanes == 1")}),
        ("now within 07:00..00:00",
         {("part", "true"), ("negation", "not now within 07:00..00:00"), ("bound", "now within 07:01..00:00"), ("bound", "now within 06:59..00:00"),
          ("bound", "now within 07:00..00:01"), ("bound", "now within 07:00..23:59")}),
        ("true", set()),
    ],
)  # fmt: skip
def test_every_single_change_of_a_condition(text: str, expected: set[tuple[str, str]]) -> None:
    assert changed(text) == expected


def test_a_change_deep_inside_leaves_the_rest() -> None:
    assert ("operator", "a and not (b or speed <= 25 mph)") in changed("a and not (b or speed < 25 mph)")


def test_what_no_test_notices_is_told_with_its_place(built: Builder) -> None:
    found = mutation(built())
    assert {(str(item.mutant), item.mutant.place.path, item.mutant.place.line) for item in found.survivors} == {
        ("SC 10: effective 2000-01-01 a day later", "codes/sc/10.yaml", 7),
        ("SC 10(a): states.current without intersection_handling, so any state", "codes/sc/10.yaml", 16),
        ("SC 10(b): without `stopped`", "codes/sc/10.yaml", 28),
        ("SC 10(b): states.current without stop, so any state", "codes/sc/10.yaml", 32),
        ("SC 11: until 2020-01-01 a day later", "codes/sc/11.yaml", 8),
        ("SC 11(a): a permission instead of the contrary", "codes/sc/11.yaml", 15),
        ("SC 11: effective 2020-01-01 a day later", "codes/sc/11.yaml", 19),
        ("SC 12: effective 2000-01-01 a day later", "codes/sc/12.yaml", 7),
        ("TC 1: effective 2021-01-01 a day later", "codes/tc/1.yaml", 7),
        ("TC 1: effective 2021-01-01 a day earlier", "codes/tc/1.yaml", 7),
        ("TC 1(a): no longer overrides sc-11-a", "codes/tc/1.yaml", 11),
    }


@pytest.mark.parametrize(
    ("change", "what"),
    [
        (("sc/10.yaml", "expect: {verdict: unknown, deciding: [a], unknown: [sign.no_turn]}", "expect: {verdict: unknown}"
          "\n          - {name: no stop, scene: {signal.color: red, stopped: false}, plan: {current: stop, next: turn_right}, expect: illegal}"),
         "SC 10(b): without `stopped`"),
        (("tc/1.yaml", "expect: {verdict: legal, limits: {max_speed: 20 mph}}}", "expect: legal}"
          "\n          - {name: new, on: 2021-01-01, scene: {school: true}, plan: {speed: 21 mph}, expect: illegal}"),
         "TC 1: effective 2021-01-01 a day later"),
        (("tc/1.yaml", "expect: {verdict: legal, limits: {max_speed: 20 mph}}}", "expect: legal}"
          "\n          - {name: fast, scene: {school: true}, plan: {speed: 45 mph}, expect: {verdict: illegal, deciding: [a]}}"),
         "TC 1(a): no longer overrides sc-11-a"),
    ],
)  # fmt: skip
def test_a_test_more_notices_more(built: Builder, change: tuple[str, str, str], what: str) -> None:
    assert what in survivors(built())
    assert what not in survivors(built(change))


@pytest.mark.parametrize(
    ("change", "what"),
    [
        (("tc/1.yaml", "expect: {verdict: legal, limits", "expect: {verdict: illegal, limits"), "TC 1(a): max_speed 20 mph -> 21 mph"),
        (("sc/12.yaml", "expect: {deciding: [a]}", "expect: {verdict: legal}"), ""),
        (("sc/10.yaml", "{name: through red, scene: {signal.color: red}", "{name: through red, scene: {signal.color: green, officer: true}"), ""),
    ],
)  # fmt: skip
def test_a_test_that_fails_or_lacks_the_edge_notices_nothing(built: Builder, change: tuple[str, str, str], what: str) -> None:
    before, after = survivors(built()), survivors(built(change))
    assert before <= after
    assert not what or what in after - before


def test_what_nothing_can_notice_is_not_counted(built: Builder) -> None:
    found = mutation(built(("sc/10.yaml", "when: stopped", "when: stopped or (stopped and officer)"),
                           ("sc/10.yaml", "current: [stop], next", "current: [stop, lane_change_left], next")))  # fmt: skip
    told = {str(item.mutant): item.equivalent for item in found.results if item.equivalent}
    assert told == {
        "SC 10(b): without `stopped and officer`": "no values of the facts tell them apart",
        "SC 10(b): without `officer`": "no values of the facts tell them apart",
        "SC 10(b): `officer` -> `not officer`": "no values of the facts tell them apart",
        "SC 10(b): states.current without lane_change_left": "the state machine has no transition that tells them apart",
    }
    count = found.count()
    assert count.equivalent == len(told)
    assert count.killed + len(found.survivors) == count.total == len(found.results) - len(told)


def test_a_definition_is_changed_once_wherever_it_is_used(built: Builder) -> None:
    found = built(
        ("sc/10.yaml", "    regulations:\n", "    definitions: [{name: waiting, when: stopped and school}]\n    regulations:\n"),
        ("sc/10.yaml", "when: signal.color == red", "when: signal.color == red and not waiting"),
        ("sc/10.yaml", "when: stopped\n", "when: waiting\n"),
    )
    inside = {item.what: item for item in generate(found) if item.subject == "SC 10 waiting"}
    assert set(inside) == {"without `stopped`", "without `school`", "`stopped` -> `not stopped`", "`school` -> `not school`"}
    assert all(item.ids == {"sc-10-a", "sc-10-b"} for item in inside.values())
    whens = {show(changed.when) for _, changed in inside["without `stopped`"].swaps}
    assert whens == {"signal.color == red and not school", "school"}
    assert "SC 10(b): without `waiting`" in {str(item) for item in generate(found)}


def test_dates_of_models_and_days_before_all_texts_are_no_law(built: Builder) -> None:
    moved = {str(item) for item in generate(built()) if item.kind == "date"}
    assert "SC 10: effective 2000-01-01 a day later" in moved
    assert "SC 10: effective 2000-01-01 a day earlier" not in moved
    assert "SC 11: effective 2020-01-01 a day earlier" in moved
    model = built(("jurisdictions.yaml", "kind: state, code: sc", "kind: model, status: model, code: sc"))
    assert not [item for item in generate(model) if item.kind == "date" and item.code == "sc"]


def test_samples_are_drawn_by_their_seed(built: Builder) -> None:
    mutants = generate(built())
    assert chosen(mutants, 0, 1) == chosen(mutants, len(mutants), 1) == mutants
    assert len(chosen(mutants, 7, 1)) == 7
    assert chosen(mutants, 7, 1) == chosen(mutants, 7, 1) != chosen(mutants, 7, 2)


def test_reports_count_alike(built: Builder) -> None:
    found = mutation(built())
    data = mutation_data(found)
    assert data["total"] == {"score": 76.09, "killed": 35, "counted": 46, "equivalent": 0}
    assert sum(item["killed"] for item in data["codes"].values()) == sum(item["killed"] for item in data["kinds"].values()) == 35
    assert len(data["survivors"]) == 11
    text = mutation_text(found, 0.1)
    assert all(len(line) <= 80 for line in text.splitlines())
    assert text.endswith("mutation score 76.1 %: 35 of 46 mutants noticed in 0.1 s\n")


def test_the_command(town: Town, capsys: pytest.CaptureFixture[str]) -> None:
    folder = town()
    code, out, err = run(capsys, "--codes", folder, "--mutate")
    assert (code, err) == (0, "")
    assert "  codes/tc/1.yaml:11: TC 1(a): no longer overrides sc-11-a\n" in out
    code, out, _ = run(capsys, "--codes", folder, "--mutate", folder / "tc", "--format", "json")
    assert {item["path"] for item in json.loads(out)["survivors"]} == {"codes/tc/1.yaml"}
    code, _, err = run(capsys, "--codes", folder, "--mutate", "--mutate-under", "90")
    assert (code, err) == (1, "the mutation score is 76.1 %, less than 90 %\n")
    code, out, _ = run(capsys, "--codes", folder, "--mutate", "--sample", "5", "--seed", "3")
    assert "(5 drawn of 46)" in out
    code, _, err = run(capsys, "--codes", folder, "--mutate", "--format", "junit")
    assert code == 2
    assert "text or json" in " ".join(err.split())


def test_the_shipped_codes_score_ninety(codes: Path) -> None:
    """A tenth of the mutants, so that the test stays quick; `regdb test --mutate` counts all."""
    found = build(codes)
    mutants = chosen(generate(found), 900, 1)
    assert Mutation(tuple(judge_mutants(found, mutants)), len(mutants)).count().score >= 88
