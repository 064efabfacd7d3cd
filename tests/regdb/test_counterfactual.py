"""A literal made true or false by changing facts: any literal, in any situation, unless nothing can."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from random_law import PLAN, VOCABULARY, literals, situations, speed_comparisons

from regdb.condition import FALSE, TRUE, Compare, Has, Is, Known, Linear, Literal, Not, OneOf, Within, evaluate, literal_facts
from regdb.counterfactual import with_wishes
from regdb.situation import Plan, Scene, Situation


@settings(max_examples=300)
@given(literals, st.booleans(), situations())
def test_a_wish_comes_true_and_touches_only_its_own_facts(literal: Literal, truth: bool, situation: Situation) -> None:
    after = with_wishes(situation, [(literal, truth)])
    if after is None:
        assert isinstance(literal, (Within, Compare, OneOf))
        return
    assert evaluate(literal if truth else Not(literal), after) is True
    for fact in VOCABULARY.facts:
        if fact not in literal_facts(literal):
            assert after.observed(fact) == situation.observed(fact)


@given(speed_comparisons(), st.booleans(), situations())
def test_a_comparison_can_be_turned_unless_its_facts_cancel_out(literal: Compare, truth: bool, situation: Situation) -> None:
    if with_wishes(situation, [(literal, truth)]) is None:
        sums: dict[str, float] = {}
        for sign, side in ((1, literal.left), (-1, literal.right)):
            for coefficient, fact in side.terms:
                sums[fact] = sums.get(fact, 0.0) + sign * coefficient
        assert not any(sums.values()) or literal.op in {"==", "!="}


def test_later_wishes_build_on_earlier_ones() -> None:
    situation = Situation(VOCABULARY, Scene(), PLAN)
    after = with_wishes(situation, [(Has("road.types", "ramp"), True), (Has("road.types", "alley"), True), (Has("road.types", "ramp"), False)])
    assert after is not None
    assert after.value("road.types") == frozenset({"alley"})


@pytest.mark.parametrize(("literal", "truth"), [(TRUE, False), (FALSE, True), (Within("clock.time", 8, 8), True)])
def test_what_cannot_be_is_not_granted(literal: Literal, truth: bool) -> None:
    assert with_wishes(Situation(VOCABULARY, Scene(), PLAN), [(literal, truth)]) is None


def test_the_plans_own_numbers_stay_in_the_plan() -> None:
    within = Compare("<=", Linear(0.0, ((1.0, "plan.speed"),)), Linear(10.0), "quantity", "mph")
    situation = Situation(VOCABULARY, Scene({"red": True}), Plan("a", "b", {"plan.speed": 12.0}))
    after = with_wishes(situation, [(within, True), (Is("red"), False), (Known("red"), False)])
    assert after is not None
    assert after.plan.facts == {"plan.speed": 10.0}
    assert after.scene.facts == {}
