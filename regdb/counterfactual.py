"""What a situation would be if a literal of a condition were otherwise: for checking that a change does what it says."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from regdb.condition import Compare, Const, Has, Is, Known, Literal, Not, OneOf, Within, evaluate
from regdb.situation import Plan, Scene, Situation
from regdb.vocabulary import Fact, Value

Wish = tuple[Literal, bool]
"""A literal and the truth it shall have."""


def with_wishes(situation: Situation, wishes: Iterable[Wish]) -> Situation | None:
    """The situation after each wish in turn is made true by the least change of its facts; None where none can be found.

    A later wish may undo an earlier one: whoever asks judges the whole again.
    """
    for literal, truth in wishes:
        changed = next(_tries(literal, truth, situation), None)
        if changed is None:
            return None
        situation = changed
    return situation


def _tries(literal: Literal, truth: bool, situation: Situation) -> Iterator[Situation]:
    wanted = literal if truth else Not(literal)
    for values in _candidates(literal, truth, situation):
        changed = _with_values(situation, values)
        if evaluate(wanted, changed) is True:
            yield changed


def _candidates(literal: Literal, truth: bool, situation: Situation) -> Iterator[Mapping[str, Value | None]]:
    """Values of the literal's facts under which it may have the truth; None leaves a fact unknown."""
    match literal:
        case Is(fact):
            yield {fact: truth}
        case OneOf(fact, words):
            declared = situation.vocabulary.facts.get(fact)
            others = [word for word in declared.values if word not in words] if declared else []
            yield from ({fact: word} for word in (words if truth else others))
        case Has(fact, word):
            value = situation.value(fact)
            held = value if isinstance(value, frozenset) else frozenset()
            yield {fact: held | {word} if truth else held - {word}}
        case Within(fact, start, end):
            yield {fact: start if truth else end}
        case Known(fact):
            yield {fact: _any_value(situation.vocabulary.facts.get(fact)) if truth else None}
        case Compare():
            yield from _numbers(literal, situation)
        case Const():
            return


def _numbers(literal: Compare, situation: Situation) -> Iterator[dict[str, Value | None]]:
    """The number at which both sides are equal, and those a little and a good deal to either side, for the first fact that counts."""
    constant = literal.left.constant - literal.right.constant
    sums: dict[str, float] = {}
    for sign, side in ((1.0, literal.left), (-1.0, literal.right)):
        for coefficient, fact in side.terms:
            sums[fact] = sums.get(fact, 0.0) + sign * coefficient
    others: dict[str, Value | None] = {fact: 0.0 for fact in sums if situation.value(fact) is None}
    for fact, coefficient in sums.items():
        if coefficient:
            rest = sum(c * _number(name, situation) for name, c in sums.items() if name != fact)
            equal = -(constant + rest) / coefficient
            nudge = 1e-9 * max(1.0, abs(equal))
            yield from ({**others, fact: equal + shift} for shift in (0.0, nudge, -nudge, 1.0, -1.0))


def _number(fact: str, situation: Situation) -> float:
    value = situation.value(fact)
    return float(value) if isinstance(value, (int, float)) else 0.0


def _any_value(fact: Fact | None) -> Value | None:
    if fact is None:
        return None
    if fact.quiet is not None:
        return fact.quiet
    if fact.kind == "enumeration":
        return fact.values[0]
    return False if fact.kind == "boolean" else frozenset() if fact.kind == "set" else 0.0


def _with_values(situation: Situation, values: Mapping[str, Value | None]) -> Situation:
    scene, plan = dict(situation.scene.facts), dict(situation.plan.facts)
    for fact, value in values.items():
        declared = situation.vocabulary.facts.get(fact)
        target = plan if fact in plan or (declared is not None and declared.source == "plan") else scene
        scene.pop(fact, None)
        plan.pop(fact, None)
        if value is not None:
            target[fact] = value
    told = situation.plan
    return Situation(situation.vocabulary, Scene(scene, situation.scene.silent), Plan(told.current, told.next, plan))
