"""Kleene's logic: the laws that hold, and the one that does not."""

from __future__ import annotations

from itertools import permutations, product

import pytest
from hypothesis import given
from hypothesis import strategies as st

from regdb.truth import Truth, conjoin, disjoin, negate, spell

ALL: tuple[Truth, ...] = (True, False, None)
TRUTHS = st.sampled_from(ALL)


def _order(value: Truth) -> int:
    """false < unknown < true."""
    return {False: 0, None: 1, True: 2}[value]


@pytest.mark.parametrize(("a", "b"), list(product(ALL, ALL)))
def test_and_is_the_lesser_or_the_greater_of_two(a: Truth, b: Truth) -> None:
    assert _order(conjoin((a, b))) == min(_order(a), _order(b))
    assert _order(disjoin((a, b))) == max(_order(a), _order(b))


@pytest.mark.parametrize("a", ALL)
def test_not_turns_back_and_keeps_unknown(a: Truth) -> None:
    assert negate(negate(a)) is a
    assert negate(None) is None


@given(st.lists(TRUTHS, max_size=6))
def test_de_morgan(values: list[Truth]) -> None:
    assert negate(conjoin(values)) is disjoin(map(negate, values))
    assert negate(disjoin(values)) is conjoin(map(negate, values))


@given(st.lists(TRUTHS, max_size=4))
def test_order_and_repetition_change_nothing(values: list[Truth]) -> None:
    for join in (conjoin, disjoin):
        assert {join(order) for order in permutations(values)} == {join(values)}
        assert join([*values, *values]) is join(values)


@given(TRUTHS, TRUTHS, TRUTHS)
def test_distribution_and_absorption(a: Truth, b: Truth, c: Truth) -> None:
    assert conjoin((a, disjoin((b, c)))) is disjoin((conjoin((a, b)), conjoin((a, c))))
    assert conjoin((a, disjoin((a, b)))) is a
    assert disjoin((a, conjoin((a, b)))) is a


@given(st.lists(TRUTHS, max_size=5), st.data())
def test_learning_more_never_takes_an_answer_back(values: list[Truth], data: st.DataObject) -> None:
    learned = [data.draw(st.booleans()) if value is None else value for value in values]
    for join in (conjoin, disjoin):
        assert join(values) in (None, join(learned))


def test_nothing_is_true_under_and_false_under_or() -> None:
    assert conjoin(()) is True
    assert disjoin(()) is False


def test_the_excluded_middle_does_not_hold() -> None:
    assert disjoin((None, negate(None))) is None


def test_words() -> None:
    assert [spell(value) for value in ALL] == ["true", "false", "unknown"]
