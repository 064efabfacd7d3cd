"""Tests that cannot be read: each finding has its code, its exact place and what would be right."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from regdb_compiler.diagnostics import split_lines
from regdb_compiler.driver import Build
from regdb_compiler.law_tests.judge import judge_tests

AT_GREEN = "{name: at green, scene: {signal.color: green}, plan: {current: stop, next: go_straight}, expect: legal}"


@pytest.mark.parametrize(
    ("file", "old", "new", "code", "marked", "message", "note"),
    [
        ("sc/10.yaml", AT_GREEN, AT_GREEN.replace("signal.color", "signal.colour"),
         "R801", "signal.colour", "unknown fact", "did you mean signal.color"),
        ("sc/10.yaml", AT_GREEN, AT_GREEN.replace("green}", "gren}"), "R801", "gren", "cannot be 'gren'", "did you mean green"),
        ("sc/10.yaml", AT_GREEN, AT_GREEN.replace("go_straight", "go_strait"), "R801", "go_strait", "unknown state", "did you mean go_straight"),
        ("sc/10.yaml", AT_GREEN, AT_GREEN.replace("next: go_straight", "next: go_straight, sped: 3 mph"), "R801", "sped", "unknown fact", ""),
        ("sc/10.yaml", AT_GREEN, AT_GREEN.replace("next: go_straight", "next: go_straight, speed: 3"), "R801", "3", "unit of speed", ""),
        ("sc/cases/red.yaml", "in: town", "in: tow", "R801", "tow", "unknown jurisdiction", "known: state, town"),
        ("sc/cases/red.yaml", "like: quiet", "like: loud", "R801", "loud", "unknown base scene", "there is: quiet"),
        ("sc/10.yaml", "deciding: [b], assumed", "deciding: [bb], assumed", "R802", "bb", "no regulation has the id", "did you mean sc-10-b"),
        ("sc/10.yaml", "unknown: [sign.no_turn]", "unknown: [sign.no_tern]", "R802", "sign.no_tern", "unknown fact", "did you mean sign.no_turn"),
        ("sc/cases/red.yaml", "{max_speed: 40 mph}", "{max_sped: 40 mph}", "R802", "max_sped", "is no limit", "limits: max_speed"),
        ("sc/cases/red.yaml", "{max_speed: 40 mph}", "{max_speed: 40 ft}", "R802", "40 ft", "unit of speed", ""),
        ("sc/cases/red.yaml", "deciding: [sc-10-b]", "deciding: [b]", "R802", "b", "no regulation has the id", ""),
        ("sc/10.yaml", AT_GREEN, AT_GREEN.replace("expect: legal", "expect: {}"), "R802", "{}", "expects nothing", "write `expect"),
    ],
)  # fmt: skip
def test_what_is_not_there_is_found_at_its_place(
    built: Callable[..., Build], file: str, old: str, new: str, code: str, marked: str, message: str, note: str
) -> None:
    found = built((file, old, new))
    [finding] = found.diagnostics
    assert finding.code == code
    assert message in finding.message
    assert note in finding.note
    line = split_lines(found.corpus.texts[finding.place.path])[finding.place.line - 1]
    assert line[finding.place.column - 1 : finding.place.end_column - 1] == marked
    broken = [item for item in judge_tests(found, found.law_tests) if item.status == "broken"]
    assert len(broken) == 1
    assert f"{finding.place}" in broken[0].reasons[0]


def test_every_problem_of_a_test_is_found(built: Callable[..., Build]) -> None:
    wrong = AT_GREEN.replace("signal.color: green", "signal.color: gren, stoped: true").replace("legal", "{deciding: [zz], unknown: [yy]}")
    assert sorted(item.code for item in built(("sc/10.yaml", AT_GREEN, wrong)).diagnostics) == ["R801", "R801", "R802", "R802"]


def test_findings_cite_the_law(built: Callable[..., Build]) -> None:
    [finding] = built(("sc/10.yaml", AT_GREEN, AT_GREEN.replace("green}", "gren}"))).diagnostics
    assert finding.law == "SC 10(a)"
