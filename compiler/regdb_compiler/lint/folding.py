"""Whether literals can be true together: per fact, which values they leave. Decides contradictions and parts that are always true."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from regdb.condition import OPPOSITE, And, Compare, Is, Node, Not, OneOf, Or
from regdb.vocabulary import Vocabulary

_TURNED = {"<": ">", "<=": ">=", ">": "<", ">=": "<=", "==": "==", "!=": "!="}


@dataclass
class _Left:
    """What is left of one fact's values: truths, words, and an interval of numbers whose ends may be open."""

    truths: set[bool] = field(default_factory=lambda: {True, False})
    words: set[str] | None = None
    low: tuple[float, bool] = (-math.inf, False)
    high: tuple[float, bool] = (math.inf, False)

    @property
    def is_empty(self) -> bool:
        if not self.truths or self.words == set():
            return True
        return self.low[0] > self.high[0] or (self.low[0] == self.high[0] and (self.low[1] or self.high[1]))


def contradiction(parts: Iterable[Node], vocabulary: Vocabulary) -> str | None:
    """The fact whose literals among `parts` cannot be true together; None when there is none."""
    left: dict[str, _Left] = {}
    for part in parts:
        fact = _narrow(part, left, vocabulary)
        if fact is not None and left[fact].is_empty:
            return fact
    return None


def negations(parts: Iterable[Node]) -> Iterator[Node]:
    """The parts turned round: an `or` is always true when these contradict each other."""
    for part in parts:
        yield part.part if isinstance(part, Not) else Not(part)


def joins(node: Node) -> Iterator[And | Or]:
    """Every `and` and `or` of a condition, outermost first."""
    match node:
        case And(parts) | Or(parts):
            yield node
            for part in parts:
                yield from joins(part)
        case Not(part):
            yield from joins(part)
        case _:
            return


def _narrow(part: Node, left: dict[str, _Left], vocabulary: Vocabulary) -> str | None:
    """Take away what the literal excludes; returns its fact, or None for what is no literal about one fact."""
    negated, literal = (True, part.part) if isinstance(part, Not) else (False, part)
    match literal:
        case Is(fact):
            left.setdefault(fact, _Left()).truths &= {not negated}
            return fact
        case OneOf(fact, words):
            held = left.setdefault(fact, _Left())
            declared = vocabulary.facts.get(fact)
            all_words = set(declared.values if declared else words) if held.words is None else held.words
            held.words = all_words - set(words) if negated else all_words & set(words)
            return fact
        case Compare():
            return _narrow_number(literal, negated, left)
        case _:
            return None


def _narrow_number(literal: Compare, negated: bool, left: dict[str, _Left]) -> str | None:
    op, one, other = literal.op, literal.left, literal.right
    if other.terms and not one.terms:
        op, one, other = _TURNED[op], other, one
    if len(one.terms) != 1 or one.terms[0][0] != 1 or one.constant or other.terms:
        return None
    op = OPPOSITE[op] if negated else op
    fact, number = one.terms[0][1], other.constant
    held = left.setdefault(fact, _Left())
    if op in {"<", "<=", "=="}:
        held.high = min(held.high, (number, op == "<"), key=lambda end: (end[0], not end[1]))
    if op in {">", ">=", "=="}:
        held.low = max(held.low, (number, op == ">"))
    return fact
