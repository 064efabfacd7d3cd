"""The smallest change: it really turns the rule and the verdict it is for, and nothing smaller does."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import combinations, product

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from random_law import ASSUMED, BOOLEANS, PLAN, VOCABULARY, literals, rule_sets, situations, trees
from regdb_compiler.parse_condition import parse_condition

from regdb.condition import TRUE, And, Compare, Has, Is, Known, Linear, Node, Not, OneOf, Or, Within, evaluate, facts_of
from regdb.condition import literals as literals_of
from regdb.counterfactual import with_wishes
from regdb.explanation import explain
from regdb.meaning import Judgement
from regdb.regulation import Regulation
from regdb.situation import Plan, Scene, Situation
from regdb.turning import Change, changes, to_turn
from regdb.units import to_si
from regdb.vocabulary import Value

PLAIN = (*BOOLEANS, ASSUMED)


def rule(name: str, when: Node = TRUE, **more: object) -> Regulation:
    return Regulation(**{"id": name, "citation": f"T {name}", "jurisdiction": "state", "legality": False, "when": when, **more})  # type: ignore[arg-type]


def judged(rules: Iterable[Regulation], plan: Plan = PLAN, **facts: Value) -> Judgement:
    return Judgement(tuple(rules), Situation(VOCABULARY, Scene(facts), plan))


def applied(change: Iterable[Change], situation: Situation) -> Situation:
    """The situation after changes to boolean facts and to the plan's own numbers, as their text asks for them."""
    facts = {**situation.scene.facts, **situation.plan.facts}
    for item in change:
        node = parse_condition(item.want.replace(" is false", " == false").replace(" is true", " == true"), VOCABULARY).node
        assert node is not None
        facts.update(_meeting(node))
    plan = {name: facts.pop(name) for name in list(facts) if name.startswith("plan.")}
    return Situation(VOCABULARY, Scene(facts), Plan(situation.plan.current, situation.plan.next, plan))


def _meeting(node: Node) -> dict[str, Value]:
    """Values under which one wanted literal is true."""
    match node:
        case Is(fact):
            return {fact: True}
        case Not(Is(fact)):
            return {fact: False}
        case Compare("<=" | ">=", Linear(0.0, ((1.0, fact),)), Linear(number, ())):
            return {fact: number}
    raise AssertionError(f"no such change was to be expected: {node}")


@st.composite
def planned(draw: st.DrawFn) -> Situation:
    """Boolean facts, each true, false or unknown, and a plan with or without its numbers."""
    facts = {name: draw(st.booleans()) for name in PLAIN if draw(st.integers(0, 3))}
    numbers = {"plan.speed": to_si(float(draw(st.integers(1, 10))), "mph"), "plan.clearance": to_si(float(draw(st.integers(1, 10))), "ft")}
    plan = {name: number for name, number in numbers.items() if draw(st.integers(0, 3))}
    return Situation(VOCABULARY, Scene(facts), Plan(PLAN.current, PLAN.next, plan))


@settings(max_examples=150)
@given(trees(st.sampled_from(PLAIN).map(Is), 5), planned(), st.booleans())
def test_changes_make_a_read_once_condition_what_is_wanted_and_fewer_do_not(node: Node, situation: Situation, wanted: bool) -> None:
    mentioned = _leaves(node)
    assume(len(mentioned) == len(set(mentioned)))
    found = changes(node, situation, wanted)
    assert found is not None
    assert evaluate(node, applied(found, situation)) is wanted
    for fewer in combinations(facts_of(node), len(found) - 1) if found else ():
        for values in product((True, False), repeat=len(fewer)):
            scene = Scene({**situation.scene.facts, **dict(zip(fewer, values, strict=True))})
            assert evaluate(node, Situation(VOCABULARY, scene, situation.plan)) is not wanted


def _leaves(node: Node) -> list[str]:
    match node:
        case And(parts) | Or(parts):
            return [fact for part in parts for fact in _leaves(part)]
        case Not(part):
            return _leaves(part)
    return list(facts_of(node))


@settings(max_examples=200)
@given(rule_sets(), planned())
def test_the_smallest_change_turns_the_rule_it_is_for(rules: tuple[Regulation, ...], situation: Situation) -> None:
    judgement = Judgement(rules, situation)
    for item in judgement.decision.deciding if judgement.decision.verdict != "legal" else ():
        turn = to_turn(item, judgement)
        if turn is not None:
            assert Judgement(rules, applied(turn, situation)).breaks(item) is False, (item, turn)


@settings(max_examples=200)
@given(rule_sets(), planned())
def test_the_smallest_change_turns_the_verdict_and_none_of_it_can_be_left_out(rules: tuple[Regulation, ...], situation: Situation) -> None:
    judgement = Judgement(rules, situation)
    before = judgement.decision.verdict
    assume(before != "legal")
    turn = explain(judgement).turn
    if turn:
        assert _turned(before, rules, applied(turn, situation)), turn
        for change in turn:
            assert not _turned(before, rules, applied([other for other in turn if other is not change], situation)), (turn, change)


def _turned(before: str, rules: tuple[Regulation, ...], situation: Situation) -> bool:
    """An unlawful plan is no longer unlawful; an unsettled one is lawful."""
    after = Judgement(rules, situation).decision.verdict
    return after == "legal" or (before == "illegal" and after != "illegal")


@settings(max_examples=150)
@given(rule_sets(most=3), planned())
def test_one_change_is_found_where_one_is_enough(rules: tuple[Regulation, ...], situation: Situation) -> None:
    """Among the boolean facts that conditions read; a prohibition without a condition leaves nothing to change."""
    judgement = Judgement(rules, situation)
    before = judgement.decision.verdict
    facts = {fact for item in rules for fact in item.facts if fact in PLAIN}
    possible = [
        (fact, value)
        for fact, value in product(sorted(facts), (True, False))
        if _turned(before, rules, Situation(VOCABULARY, Scene({**situation.scene.facts, fact: value}), situation.plan))
    ]
    if before != "legal" and len(judgement.decision.deciding) == 1 and possible:
        assert explain(judgement).turn, possible


def test_an_exception_that_is_itself_a_prohibition_is_no_way_out() -> None:
    rules = [rule("a", Is("red")), rule("b", Is("stopped"), targets=("a",))]
    assert [change.want for change in explain(judged(rules, red=True, stopped=False)).turn] == ["red is false"]


@settings(max_examples=120)
@given(rule_sets(literals, most=3), situations())
def test_a_turn_over_all_kinds_of_literals_turns_the_verdict(rules: tuple[Regulation, ...], situation: Situation) -> None:
    judgement = Judgement(rules, situation)
    turn = explain(judgement).turn
    assert not turn or judgement.decision.verdict != "legal"
    after = with_wishes(situation, [(change.literal, change.truth) for change in turn])
    assert after is not None
    for change in turn:
        wanted = parse_condition(change.want.replace(" is false", " == false").replace(" is true", " == true"), VOCABULARY).node
        assert wanted == (change.literal if change.truth else Not(change.literal)) or change.literal in literals_of(wanted)
    assert not turn or _turned(judgement.decision.verdict, rules, after)


@pytest.mark.parametrize(
    ("node", "facts", "want"),
    [
        (Compare("<", Linear(0.0, ((1.0, "ego.speed"),)), Linear(to_si(25, "mph")), "quantity", "mph"), {"ego.speed": 1.0}, "ego.speed >= 25 mph"),
        (OneOf("signal.color", ("red",)), {"signal.color": "red"}, "signal.color != red"),
        (Has("road.types", "ramp"), {"road.types": frozenset({"ramp"})}, "not ramp in road.types"),
        (Within("clock.time", 25200, 57600), {"clock.time": 30000}, "not clock.time within 07:00..16:00"),
        (Known("red"), {"red": True}, "not known(red)"),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_a_change_is_worded_as_a_condition(node: Node, facts: dict[str, Value], want: str) -> None:
    found = changes(node, judged([], **facts).situation, wanted=False)
    assert found is not None
    assert [item.want for item in found] == [want]
