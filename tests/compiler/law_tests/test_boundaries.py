"""Scenes around the numbers of the law: how they are made, what they show, what they cannot, and plans of several states."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from regdb_compiler.driver import Build
from regdb_compiler.law_tests import boundaries as module
from regdb_compiler.law_tests.boundaries import Boundary, boundaries
from regdb_compiler.law_tests.boundaries_text import boundaries_text
from regdb_compiler.law_tests.judge import judge_tests

from regdb import cli

Builder = Callable[..., Build]
Town = Callable[..., Path]
WHEN = ("sc/11.yaml", "condition: {text: Anywhere.}\n        result: at most 40", "condition: {text: T., when: %s}\n        result: at most 40")


def with_condition(built: Builder, when: str) -> Build:
    """The town where the limit of forty has a condition; its tests name no school."""
    return built((WHEN[0], WHEN[1], WHEN[2] % when))


def number(found: Build, what: str) -> Boundary:
    return next(item for item in boundaries(found).numbers if item.what == what)


def run(capsys: pytest.CaptureFixture[str], *arguments: str | Path) -> tuple[int, str]:
    with pytest.raises(SystemExit) as stop:
        cli.main(["test", *map(str, arguments)])
    return int(stop.value.code or 0), capsys.readouterr().out


def test_every_number_has_three_scenes_and_the_sides_tests_show(built: Builder) -> None:
    found = boundaries(built())
    assert {(item.regulation, item.what): item.missing for item in found.numbers} == {
        ("sc-11-a", "max_speed: 50 mph"): ("at", "above"),
        ("sc-11-a", "max_speed: 40 mph"): (),
        ("tc-1-a", "max_speed: 20 mph"): ("below",),
    }
    assert found.wrong == found.not_built == ()


@pytest.mark.parametrize(
    ("when", "what"),
    [
        ("plan.speed > 10 mph", "plan.speed > 10 mph"),
        ("school and plan.speed >= 10 mph", "plan.speed >= 10 mph"),
        ("school or plan.speed < 60 mph", "plan.speed < 60 mph"),
        ("not (stopped or plan.speed <= 10 mph)", "plan.speed <= 10 mph"),
        ("plan.speed == 45 mph and not school", "plan.speed == 45 mph"),
        ("10 mph < plan.speed", "10 mph < plan.speed"),
        ("2 * plan.speed > plan.speed + 10 mph", "2 * plan.speed > plan.speed + 10 mph"),
    ],
)
def test_the_number_is_let_decide_by_turning_the_rest(built: Builder, when: str, what: str) -> None:
    found = number(with_condition(built, when), what)
    assert (found.built, found.wrong) == (True, ())


def test_a_number_that_never_decides_has_no_scene(built: Builder) -> None:
    found = with_condition(built, "stopped and not stopped and plan.speed > 10 mph")
    assert not number(found, "plan.speed > 10 mph").built
    text = boundaries_text(boundaries(found))
    assert "no scene in which the number decides:\n  codes/sc/11.yaml:" in text
    assert all(len(line) <= 80 for line in text.splitlines())


def test_a_judge_who_takes_the_bound_for_unlawful_is_caught(built: Builder, monkeypatch: pytest.MonkeyPatch) -> None:
    class Strict(module.Judgement):
        def breaks(self, rule):
            beyond = [self.situation.value(item.fact) for item in rule.limits]
            bounds = [item.bound.constant for item in rule.limits]
            return any(a is not None and float(a) >= b for a, b in zip(beyond, bounds, strict=True))

    found = built()
    monkeypatch.setattr(module, "Judgement", Strict)
    assert {item.wrong for item in boundaries(found).wrong} == {("at: the number says false, the judge true",)}


def test_the_command(town: Town, capsys: pytest.CaptureFixture[str]) -> None:
    folder = town()
    code, out = run(capsys, "--codes", folder, "--boundaries")
    assert code == 0
    assert "  codes/tc/1.yaml:16: tc-1-a: max_speed: 20 mph: below\n" in out
    assert out.endswith("1 shown by law tests below, at and above\n")
    code, out = run(capsys, "--codes", folder, "--boundaries", folder / "tc", "--format", "json")
    data = json.loads(out)
    assert (code, data["numbers"], data["wrong"], data["not_built"]) == (0, 1, 0, 0)
    assert data["each"][0]["not_shown"] == ["below"]


def test_a_plan_of_several_states_stands_for_each_transition_between_them(built: Builder) -> None:
    plan = "{current: [stop, intersection_handling.go_straight], next: [go_straight, turn_right]}"
    once = "scene: {signal.color: red}, plan: {current: stop, next: go_straight}"
    found = built(("sc/10.yaml", once, f"scene: {{signal.color: red, stopped: false}}, plan: {plan}"))
    outcomes = [item for item in judge_tests(found, found.law_tests) if item.test.name == "through red"]
    assert {item.status for item in outcomes} == {"passed"}
    pairs = {(item.test.plan.current, item.test.plan.next) for item in outcomes if item.test.plan is not None}
    assert len(pairs) == len(outcomes) > 1
    assert all(b in found.corpus.machine.states[a].next for a, b in pairs)


@pytest.mark.parametrize(
    ("plan", "message"),
    [
        ("{current: stop, next: [go_straight, fly]}", "unknown state 'fly'"),
        ("{current: [turn_left], next: [turn_left, turn_right, go_straight]}", "no transition between these states with `turn_right`"),
    ],
)
def test_a_state_that_no_transition_has_is_told(built: Builder, plan: str, message: str) -> None:
    once = "plan: {current: stop, next: go_straight}, expect: {verdict: illegal"
    found = built(("sc/10.yaml", once, f"plan: {plan}, expect: {{verdict: illegal"))
    assert any(message in item.message for item in found.diagnostics), found.diagnostics
