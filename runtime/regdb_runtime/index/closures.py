"""Exact three-valued functions over the flat list of facts: one for a condition, one for a breach of limits, one for bounds."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from regdb.condition import COMPARISONS, And, Compare, Const, Has, Is, Known, Linear, Node, Not, OneOf, Or, Within
from regdb.meaning import LimitInForce
from regdb.regulation import Limit, Regulation
from regdb.truth import Truth
from regdb_runtime.errors import DatabaseDamaged
from regdb_runtime.index.slots import FactTable, Values

Condition = Callable[[Values], Truth]
Number = Callable[[Values], float | None]
Bounds = Callable[[Values], tuple[LimitInForce, ...]]


def slot_of(fact: str, table: FactTable) -> int:
    """The slot of a fact. Raises DatabaseDamaged when the vocabulary lacks it."""
    try:
        return table.slots[fact]
    except KeyError:
        raise DatabaseDamaged(f"a condition reads the fact {fact!r}, which the vocabulary of this database lacks") from None


def all_true(parts: tuple[Condition, ...]) -> Condition:
    """Kleene's and of several functions."""
    if len(parts) == 1:
        return parts[0]

    def run(values: Values) -> Truth:
        result: Truth = True
        for part in parts:
            truth = part(values)
            if truth is False:
                return False
            if truth is None:
                result = None
        return result

    return run


def any_true(parts: tuple[Condition, ...]) -> Condition:
    """Kleene's or of several functions."""
    if len(parts) == 1:
        return parts[0]

    def run(values: Values) -> Truth:
        result: Truth = False
        for part in parts:
            truth = part(values)
            if truth is True:
                return True
            if truth is None:
                result = None
        return result

    return run


def condition(node: Node, table: FactTable) -> Condition:
    """The truth of a condition tree as a function of the values."""
    match node:
        case And(parts):
            return all_true(tuple(condition(part, table) for part in parts)) if parts else lambda _: True
        case Or(parts):
            return any_true(tuple(condition(part, table) for part in parts)) if parts else lambda _: False
        case Not(part):
            inner = condition(part, table)
            return lambda values: None if (truth := inner(values)) is None else not truth
        case Compare():
            return _compare(node, table)
        case Const(value):
            return lambda _: value
        case Known(fact):
            slot_of(fact, table)
            return lambda values: fact in values[-2] or fact in values[-1]
        case _:
            return _on_one_fact(node, slot_of(node.fact, table))


def _on_one_fact(node: Is | OneOf | Has | Within, slot: int) -> Condition:
    match node:
        case Is():
            return lambda values: None if (value := values[slot]) is None else value is True
        case OneOf(_, words):
            return lambda values: None if (value := values[slot]) is None else value in words
        case Has(_, word):
            return lambda values: None if (value := values[slot]) is None else word in value
        case Within(_, start, end):
            if start <= end:
                return lambda values: None if (value := values[slot]) is None else start <= value < end
            return lambda values: None if (value := values[slot]) is None else value >= start or value < end


def _compare(node: Compare, table: FactTable) -> Condition:
    compare, left, right = COMPARISONS[node.op], linear(node.left, table), linear(node.right, table)

    def run(values: Values) -> Truth:
        a, b = left(values), right(values)
        return None if a is None or b is None else compare(a, b)

    return run


def linear(expression: Linear, table: FactTable) -> Number:
    """The value of a linear expression in SI; None when a fact in it is unknown."""
    constant = expression.constant
    terms = tuple((coefficient, slot_of(fact, table)) for coefficient, fact in expression.terms)
    if not terms:
        return lambda _: constant
    if len(terms) == 1 and constant == 0 and terms[0][0] == 1:
        only = terms[0][1]
        return lambda values: values[only]

    def run(values: Values) -> float | None:
        total = constant
        for coefficient, slot in terms:
            value = values[slot]
            if value is None:
                return None
            total += coefficient * value
        return total

    return run


def beyond(rule: Regulation, table: FactTable) -> Condition:
    """Whether the plan is past any limit of the rule."""
    return any_true(tuple(_beyond(limit, table) for limit in rule.limits))


def _beyond(limit: Limit, table: FactTable) -> Condition:
    slot, bound = slot_of(limit.fact, table), linear(limit.bound, table)
    compare: Any = COMPARISONS[">" if limit.direction == "max" else "<"]

    def run(values: Values) -> Truth:
        quantity, limit_value = values[slot], bound(values)
        return None if quantity is None or limit_value is None else compare(quantity, limit_value)

    return run


def bounds(rule: Regulation, table: FactTable) -> Bounds:
    """The limits of a rule in effect, as numbers; those whose bound is unknown are left out."""
    if all(not limit.bound.terms for limit in rule.limits):
        fixed = tuple(LimitInForce(limit, limit.bound.constant, rule) for limit in rule.limits)
        return lambda _: fixed
    pairs = tuple((limit, linear(limit.bound, table)) for limit in rule.limits)

    def run(values: Values) -> tuple[LimitInForce, ...]:
        numbers = [(limit, bound(values)) for limit, bound in pairs]
        return tuple(LimitInForce(limit, float(number), rule) for limit, number in numbers if number is not None)

    return run
