"""Explanations: the literals shown are those that matter, and the smallest change really turns the verdict, by nothing smaller."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import combinations, product

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from random_law import ASSUMED, BOOLEANS, PLAN, VOCABULARY, clearance, literals, rule_sets, situations, speed_limit, trees
from regdb_compiler.parse_condition import parse_condition

from regdb.condition import TRUE, And, Compare, Has, Is, Known, Linear, Node, Not, OneOf, Or, Within, evaluate, facts_of
from regdb.condition import literals as literals_of
from regdb.counterfactual import with_wishes
from regdb.explanation import Evidence, evidence, explain, first_failing, show_bound
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


@settings(max_examples=300)
@given(trees(st.sampled_from(PLAIN).map(Is), 5), planned(), st.booleans())
def test_changes_make_a_read_once_condition_what_is_wanted_and_fewer_do_not(node: Node, situation: Situation, wanted: bool) -> None:
    mentioned = [fact for literal in _leaves(node) for fact in (literal,)]
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


@settings(max_examples=400)
@given(rule_sets(), planned())
def test_the_smallest_change_turns_the_rule_it_is_for(rules: tuple[Regulation, ...], situation: Situation) -> None:
    judgement = Judgement(rules, situation)
    for item in judgement.decision.deciding if judgement.decision.verdict != "legal" else ():
        turn = to_turn(item, judgement)
        if turn is not None:
            assert Judgement(rules, applied(turn, situation)).breaks(item) is False, (item, turn)


@settings(max_examples=400)
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


@settings(max_examples=300)
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


@settings(max_examples=200)
@given(trees(literals), situations())
def test_evidence_is_of_the_condition_and_as_true_as_it_says(node: Node, situation: Situation) -> None:
    truth = evaluate(node, situation)
    shown = evidence(node, situation, truth)
    assert shown
    for item in shown:
        assert {fact for fact, _ in item.values} <= set(facts_of(node))
        literal = parse_condition(item.literal, VOCABULARY).node
        assert literal is not None
        assert evaluate(literal, situation) is item.truth


@settings(max_examples=200)
@given(rule_sets(), situations())
def test_a_rule_that_does_not_hold_says_why(rules: tuple[Regulation, ...], situation: Situation) -> None:
    judgement = Judgement(rules, situation)
    for item in rules:
        assert bool(first_failing(item, situation)) == (judgement.holds(item) is not True)


def test_a_broken_prohibition_is_taken_apart() -> None:
    when = And((OneOf("signal.color", ("red",)), Not(Is("officer")), Is("engine.near")))
    rules = [rule("a", when), rule("b", Is("stopped"), legality=True, targets=("a",), unless=Is("sign.seen"))]
    found = explain(judged(rules, **{"signal.color": "red", "officer": False, "engine.near": True, "stopped": False, "sign.seen": False}))
    assert found.verdict == "illegal"
    assert [str(item) for item in found.because[0].evidence] == [
        "signal.color == red: true (signal.color is red)", "officer: false (officer is false)", "engine.near: true (engine.near is true)",
    ]  # fmt: skip
    assert [reason.regulation.id for reason in found.unless] == ["b"]
    assert [str(change) for change in found.turn] == ["stopped is true (now false)"]


def test_a_limit_is_turned_by_keeping_it() -> None:
    plan = Plan(PLAN.current, PLAN.next, {"plan.speed": to_si(30, "mph"), "plan.clearance": to_si(5, "ft")})
    found = explain(judged([rule("a", limits=(speed_limit(25), clearance(3)), force="absolute")], plan))
    assert [str(change) for change in found.turn] == ["plan.speed <= 25 mph (now 30 mph)"]
    assert found.because[0].evidence[-1] == Evidence("plan.clearance >= 3 ft", truth=True, values=(("plan.clearance", "5 ft"),))


def test_an_exception_that_is_itself_a_prohibition_is_no_way_out() -> None:
    rules = [rule("a", Is("red")), rule("b", Is("stopped"), targets=("a",))]
    assert [change.want for change in explain(judged(rules, red=True, stopped=False)).turn] == ["red is false"]


@settings(max_examples=200)
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


def test_near_misses_are_prohibitions_one_literal_away() -> None:
    rules = [rule("a", And((Is("red"), Not(Is("stopped"))))), rule("b", And((Is("officer"), Is("sign.seen"))))]
    found = explain(judged(rules, red=True, stopped=True, officer=False, **{"sign.seen": False}))
    assert found.verdict == "legal"
    assert [(reason.regulation.id, str(reason.smallest_change[0])) for reason in found.near_misses] == [("a", "stopped is false (now true)")]


def test_an_assumption_behind_a_literal_is_said() -> None:
    shown = evidence(Not(Is(ASSUMED)), judged([]).situation, wanted=True)
    assert [str(item) for item in shown] == [f"{ASSUMED}: false ({ASSUMED} is false (assumed))"]


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


def test_a_bound_is_shown_in_the_laws_own_unit() -> None:
    limit = speed_limit(25)
    assert show_bound(limit.bound.constant, limit) == "25 mph"
