"""Explanations: the literals shown are those behind the verdict, and what stands near it."""

from __future__ import annotations

from collections.abc import Iterable

from hypothesis import given, settings
from random_law import ASSUMED, PLAN, VOCABULARY, clearance, literals, rule_sets, situations, speed_limit, trees
from regdb_compiler.parse_condition import parse_condition

from regdb.condition import TRUE, And, Is, Node, Not, OneOf, evaluate, facts_of
from regdb.explanation import Evidence, evidence, explain, first_failing, show_bound
from regdb.meaning import Judgement
from regdb.regulation import Regulation
from regdb.situation import Plan, Scene, Situation
from regdb.units import to_si
from regdb.vocabulary import Value


def rule(name: str, when: Node = TRUE, **more: object) -> Regulation:
    return Regulation(**{"id": name, "citation": f"T {name}", "jurisdiction": "state", "legality": False, "when": when, **more})  # type: ignore[arg-type]


def judged(rules: Iterable[Regulation], plan: Plan = PLAN, **facts: Value) -> Judgement:
    return Judgement(tuple(rules), Situation(VOCABULARY, Scene(facts), plan))


@settings(max_examples=120)
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


@settings(max_examples=120)
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


def test_near_misses_are_prohibitions_one_literal_away() -> None:
    rules = [rule("a", And((Is("red"), Not(Is("stopped"))))), rule("b", And((Is("officer"), Is("sign.seen"))))]
    found = explain(judged(rules, red=True, stopped=True, officer=False, **{"sign.seen": False}))
    assert found.verdict == "legal"
    assert [(reason.regulation.id, str(reason.smallest_change[0])) for reason in found.near_misses] == [("a", "stopped is false (now true)")]


def test_an_assumption_behind_a_literal_is_said() -> None:
    shown = evidence(Not(Is(ASSUMED)), judged([]).situation, wanted=True)
    assert [str(item) for item in shown] == [f"{ASSUMED}: false ({ASSUMED} is false (assumed))"]


def test_a_bound_is_shown_in_the_laws_own_unit() -> None:
    limit = speed_limit(25)
    assert show_bound(limit.bound.constant, limit) == "25 mph"
