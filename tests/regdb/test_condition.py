"""The condition tree: its evaluator, and what it says of facts read and facts missing."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st
from random_law import PLAN, VOCABULARY, literals, situations, trees

from regdb.condition import (
    COMPARISONS,
    FALSE,
    OPPOSITE,
    TRUE,
    And,
    Compare,
    Const,
    Has,
    Is,
    Known,
    Linear,
    Node,
    Not,
    OneOf,
    Or,
    Within,
    all_of,
    evaluate,
    facts_of,
    linear_value,
    unknown_facts,
)
from regdb.condition import literals as literals_of
from regdb.situation import Scene, Situation
from regdb.truth import Truth, conjoin, disjoin, negate
from regdb.vocabulary import Value

SPEED = Linear(0.0, ((1.0, "ego.speed"),))


def _in(**facts: Value) -> Situation:
    return Situation(VOCABULARY, Scene({name.replace("__", "."): value for name, value in facts.items()}), PLAN)


@pytest.mark.parametrize(
    ("node", "facts", "truth"),
    [
        (Is("red"), {"red": True}, True), (Is("red"), {"red": False}, False), (Is("red"), {}, None),
        (OneOf("signal.color", ("green", "red")), {"signal__color": "red"}, True),
        (OneOf("signal.color", ("green",)), {"signal__color": "red"}, False),
        (Has("road.types", "ramp"), {"road__types": frozenset({"ramp"})}, True), (Has("road.types", "ramp"), {"road__types": frozenset()}, False),
        (Compare("<=", SPEED, Linear(10.0)), {"ego__speed": 10.0}, True), (Compare("<", SPEED, Linear(10.0)), {"ego__speed": 10.0}, False),
        (Compare("!=", SPEED, Linear(10.0)), {}, None), (Const(value=True), {}, True), (Not(Const(value=True)), {}, False),
        (Known("red"), {}, False), (Known("red"), {"red": False}, True), (Not(Known("red")), {}, True),
        (Is("engine.near"), {}, False), (Known("engine.near"), {}, False), (Is("engine.near"), {"engine__near": True}, True),
    ],
)  # fmt: skip
def test_literals(node: Node, facts: dict[str, Value], truth: Truth) -> None:
    assert evaluate(node, _in(**facts)) is truth


@pytest.mark.parametrize(
    ("start", "end", "inside", "outside"),
    [(7, 16, (7, 8, 15), (6, 16, 23)), (22, 5, (22, 23, 0, 4), (5, 12, 21)), (8, 8, (), (7, 8, 9))],
)
def test_an_interval_is_half_open_and_may_go_over_midnight(start: int, end: int, inside: tuple[int, ...], outside: tuple[int, ...]) -> None:
    node = Within("clock.time", start * 3600, end * 3600)
    assert [evaluate(node, _in(clock__time=hour * 3600)) for hour in inside] == [True] * len(inside)
    assert [evaluate(node, _in(clock__time=hour * 3600)) for hour in outside] == [False] * len(outside)


@given(trees(literals), trees(literals), situations())
def test_connectives_are_kleenes(a: Node, b: Node, situation: Situation) -> None:
    x, y = evaluate(a, situation), evaluate(b, situation)
    assert evaluate(And((a, b)), situation) is conjoin((x, y))
    assert evaluate(Or((a, b)), situation) is disjoin((x, y))
    assert evaluate(Not(a), situation) is negate(x)


@given(trees(literals), situations(), st.data())
def test_what_is_settled_stays_settled_when_more_is_known(node: Node, situation: Situation, data: st.DataObject) -> None:
    """Without `known`, which speaks of knowledge itself, and without assumptions, which observation may contradict."""
    if any(isinstance(item, Known) for item in literals_of(node)):
        return
    before = evaluate(node, situation)
    more = data.draw(situations())
    facts = {**more.scene.facts, **situation.scene.facts}
    after = evaluate(node, Situation(VOCABULARY, Scene(facts), PLAN))
    assert before is None or before is after


@given(trees(literals), situations())
def test_missing_facts_are_those_an_unknown_condition_hangs_on(node: Node, situation: Situation) -> None:
    missing = unknown_facts(node, situation)
    assert bool(missing) == (evaluate(node, situation) is None)
    assert set(missing) <= set(facts_of(node))
    assert all(situation.value(fact) is None for fact in missing)


@given(st.lists(st.one_of(trees(literals), st.sampled_from((TRUE, FALSE))), max_size=4), situations())
def test_all_of_means_and_and_is_flat(parts: list[Node], situation: Situation) -> None:
    joined = all_of(*parts)
    assert evaluate(joined, situation) is conjoin(evaluate(part, situation) for part in parts)
    assert not isinstance(joined, And) or not any(isinstance(part, And) or part == TRUE for part in joined.parts)


@given(st.sampled_from(sorted(OPPOSITE)), st.floats(-10, 10), st.floats(-10, 10))
def test_an_operators_opposite_is_its_negation(op: str, a: float, b: float) -> None:
    assert COMPARISONS[OPPOSITE[op]](a, b) is not COMPARISONS[op](a, b)


def test_linear_expressions_need_all_their_facts() -> None:
    expression = Linear(1.0, ((2.0, "ego.speed"), (-1.0, "posted.speed")))
    assert linear_value(expression, _in(ego__speed=5.0, posted__speed=3.0)) == 8.0
    assert linear_value(expression, _in(ego__speed=5.0)) is None
    assert linear_value(Linear(4.0), _in()) == 4.0


def test_facts_are_named_once_in_order() -> None:
    node = And((Is("red"), Or((Compare("<", SPEED, Linear(0.0, ((1.0, "posted.speed"),))), Not(Is("red")))), Known("officer")))
    assert facts_of(node) == ("red", "ego.speed", "posted.speed", "officer")
    assert len(list(literals_of(node))) == 4
