"""Law tests judged: what takes part, what is compared, what a test leaves out."""

from __future__ import annotations

from collections.abc import Callable
from datetime import date

import pytest
from regdb_compiler.driver import Build
from regdb_compiler.law_tests.judge import judge_tests
from regdb_compiler.law_tests.outcome import Outcome, tally
from regdb_compiler.law_tests.take_part import Law

Builder = Callable[..., Build]


def over(limits: str) -> tuple[str, str, str]:
    """The test over the limit with another expectation."""
    return "sc/11.yaml", "deciding: [a], limits: {max_speed: 40 mph}", limits


def outcomes(found: Build) -> dict[str, Outcome]:
    return {item.test.name: item for item in judge_tests(found, found.law_tests)}


def test_all_pass_as_written(built: Builder) -> None:
    found = built()
    assert found.diagnostics == ()
    counted = tally(tuple(judge_tests(found, found.law_tests)))
    assert (counted.passed, counted.failed, counted.broken, counted.regulations, counted.cases) == (13, 0, 0, 6, 1)
    assert counted.ok


def test_beside_a_regulation_its_targets_and_what_displaces_either_take_part(built: Builder) -> None:
    found = built()
    law = Law(found.regulations, found.corpus.tree)
    assert law.connected("sc-10-b") == {"sc-10-a", "sc-10-b", "sc-12-a"}
    assert law.connected("sc-12-a") == {"sc-10-a", "sc-10-b", "sc-12-a"}
    assert law.connected("sc-11-a") == {"sc-11-a", "tc-1-a"}
    day = date(2026, 3, 2).toordinal()
    assert [rule.id for rule in law.beside("sc-11-a", "state", day)] == ["sc-11-a"]
    assert [rule.id for rule in law.beside("sc-11-a", "town", day)] == ["sc-11-a", "tc-1-a"]
    assert len(law.everything("town", day)) == 5


def test_other_targets_of_a_displacer_stay_out(built: Builder) -> None:
    """An officer displaces red lights and speed limits; a test of red lights need not speak of speed."""
    law = Law(built(("sc/12.yaml", "exception_to: [sc-10-a]", "exception_to: [sc-10-a, sc-11-a]")).regulations, built().corpus.tree)
    assert "sc-11-a" not in law.connected("sc-10-a")
    assert "sc-11-a" in law.connected("sc-12-a")


@pytest.mark.parametrize(
    ("name", "change", "key", "expected", "got"),
    [
        ("at green", ("sc/10.yaml", "expect: legal", "expect: illegal"), "verdict", "illegal", "legal"),
        ("through red", ("sc/10.yaml", "{verdict: illegal, deciding: [a]}", "{verdict: illegal, deciding: [b]}"), "deciding", "sc-10-b", "sc-10-a"),
        ("over the limit", over("limits: {max_speed: 41 mph}"), "max_speed", "41 mph", "40 mph (sc-11-a)"),
        ("over the limit", over("limits: {}"), "limits", "none", "max_speed: 40 mph"),
        ("over the limit", over("limits: {max_speed: none}"), "max_speed", "none", "40 mph (sc-11-a)"),
        ("right with the sign unseen", ("sc/10.yaml", "unknown: [sign.no_turn]", "unknown: [stopped]"), "unknown", "stopped", "sign.no_turn"),
        ("right after stopping", ("sc/10.yaml", "assumed: [officer]", "assumed: []"), "assumed", "none", "officer"),
    ],
)  # fmt: skip
def test_each_key_that_is_written_is_compared(
    built: Builder, name: str, change: tuple[str, str, str], key: str, expected: str, got: str
) -> None:
    found = outcomes(built(change))
    assert [item.test.name for item in found.values() if item.status != "passed"] == [name]
    assert [(d.key, d.expected, d.got) for d in found[name].differences] == [(key, expected, got)]


def test_limits_are_compared_in_si(built: Builder) -> None:
    found = outcomes(built(over("limits: {max_speed: 64.37376 km/h}")))
    assert found["over the limit"].status == "passed"


def test_a_test_without_next_takes_the_first_transition_of_its_regulation(built: Builder) -> None:
    plan = outcomes(built())["right after stopping"].test.plan
    assert plan is not None
    assert (plan.current, plan.next) == ("intersection_handling.stop", "intersection_handling.turn_right")
    scene = "scene: {signal.color: red, stopped: true}\n"
    plan = outcomes(built(("sc/10.yaml", scene, f"{scene}            plan: {{current: turn_right}}\n")))["right with the sign unseen"].test.plan
    assert plan is not None
    assert (plan.current, plan.next) == ("intersection_handling.turn_right", "intersection_handling.turn_right")


def test_the_day_is_the_sources_or_the_first_day_of_a_text_that_has_ended(built: Builder) -> None:
    found = outcomes(built())
    assert found["over the limit"].test.day == date(2026, 5, 5).toordinal()
    assert found["the old limit"].test.day == date(2000, 1, 1).toordinal()
    assert found["the day before the change"].test.day == date(2019, 12, 31).toordinal()


def test_a_case_without_a_day_takes_the_day_its_code_was_last_checked(built: Builder) -> None:
    found = outcomes(built(("sc/cases/red.yaml", "    on: 2026-03-02\n", "")))
    assert found["Right on red in town after a stop"].test.day == date(2026, 5, 5).toordinal()


def test_a_test_of_a_regulation_that_cannot_be_read_is_broken(built: Builder) -> None:
    found = outcomes(built(("sc/12.yaml", "when: officer", "when: officer_")))
    assert found["against red"].status == "broken"
    assert "`regdb lint`" in found["against red"].reasons[0]
