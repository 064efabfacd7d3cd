"""The condition tree: its nodes, how it is read from and written to JSON, shown, and evaluated for reference.

The condition language is decidable on purpose: comparisons of facts with literals or linear expressions, `in`, `within`,
`known`, and/or/not. This evaluator is the one every other reader (index, SQL, solver) is tested against.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Protocol

from regdb.truth import Truth, conjoin, disjoin, negate
from regdb.vocabulary import Value


class Reader(Protocol):
    """Where facts come from: `value` after the vocabulary's assumptions, `observed` before them; None is unknown."""

    def value(self, fact: str) -> Value | None: ...

    def observed(self, fact: str) -> Value | None: ...


@dataclass(frozen=True, slots=True)
class Const:
    """True or false whatever the scene."""

    value: bool


@dataclass(frozen=True, slots=True)
class Is:
    """A boolean fact is true."""

    fact: str


@dataclass(frozen=True, slots=True)
class OneOf:
    """An enumeration has one of these words (sorted)."""

    fact: str
    words: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Has:
    """A set fact contains this word."""

    fact: str
    word: str


@dataclass(frozen=True, slots=True)
class Linear:
    """constant + sum of coefficient x fact, all in SI."""

    constant: float
    terms: tuple[tuple[float, str], ...] = ()


@dataclass(frozen=True, slots=True)
class Compare:
    """left op right on numbers in SI; `kind` (quantity, count, time, date) and `unit` are how a person reads them."""

    op: str
    left: Linear
    right: Linear
    kind: str = "quantity"
    unit: str = ""


@dataclass(frozen=True, slots=True)
class Within:
    """A time or date fact lies in [start, end); where start > end, the interval goes over midnight."""

    fact: str
    start: int
    end: int
    kind: str = "time"


@dataclass(frozen=True, slots=True)
class Known:
    """The fact has been observed. Two-valued, and blind to assumptions."""

    fact: str


@dataclass(frozen=True, slots=True)
class Not:
    part: Node


@dataclass(frozen=True, slots=True)
class And:
    parts: tuple[Node, ...]


@dataclass(frozen=True, slots=True)
class Or:
    parts: tuple[Node, ...]


Node = Const | Is | OneOf | Has | Compare | Within | Known | Not | And | Or
Literal = Const | Is | OneOf | Has | Compare | Within | Known

TRUE, FALSE = Const(value=True), Const(value=False)

COMPARISONS: dict[str, Callable[[float, float], bool]] = {
    "<": lambda a, b: a < b,
    "<=": lambda a, b: a <= b,
    ">": lambda a, b: a > b,
    ">=": lambda a, b: a >= b,
    "==": lambda a, b: a == b,
    "!=": lambda a, b: a != b,
}
OPPOSITE = {"<": ">=", "<=": ">", ">": "<=", ">=": "<", "==": "!=", "!=": "=="}


def evaluate(node: Node, reader: Reader) -> Truth:
    """The truth of a condition in a scene. The reference for every other reader of the language."""
    match node:
        case And(parts):
            return conjoin(evaluate(part, reader) for part in parts)
        case Or(parts):
            return disjoin(evaluate(part, reader) for part in parts)
        case Not(part):
            return negate(evaluate(part, reader))
        case Known(fact):
            return reader.observed(fact) is not None
        case Const():
            return node.value
        case Compare(op, left, right):
            a, b = linear_value(left, reader), linear_value(right, reader)
            return None if a is None or b is None else COMPARISONS[op](a, b)
    value = reader.value(node.fact)
    return None if value is None else _literal(node, value)


def _literal(node: Is | OneOf | Has | Within, value: Value) -> bool:
    match node:
        case Is():
            return value is True
        case OneOf(_, words):
            return value in words
        case Has(_, word):
            return isinstance(value, frozenset) and word in value
        case Within(_, start, end):
            number = float(value)  # type: ignore[arg-type]  # time and date facts hold integers
            return start <= number < end if start <= end else number >= start or number < end


def linear_value(expression: Linear, reader: Reader) -> float | None:
    """The value of a linear expression in SI; None when a fact in it is unknown."""
    if len(expression.terms) == 1 and expression.constant == 0 and expression.terms[0][0] == 1:
        value = reader.value(expression.terms[0][1])
        return None if value is None else float(value)  # type: ignore[arg-type]  # the compiler checked the type
    total = expression.constant
    for coefficient, fact in expression.terms:
        value = reader.value(fact)
        if value is None:
            return None
        total += coefficient * float(value)  # type: ignore[arg-type]
    return total


def all_of(*parts: Node) -> Node:
    """The conjunction, flat, without `true`; false if any part is the constant false."""
    flat: list[Node] = []
    for part in parts:
        if part == FALSE:
            return FALSE
        if part != TRUE:
            flat.extend(part.parts if isinstance(part, And) else (part,))
    return TRUE if not flat else flat[0] if len(flat) == 1 else And(tuple(flat))


def literals(node: Node) -> Iterator[Literal]:
    """Every literal of the tree, left to right."""
    match node:
        case And(parts) | Or(parts):
            for part in parts:
                yield from literals(part)
        case Not(part):
            yield from literals(part)
        case _:
            yield node


def literal_facts(node: Literal) -> tuple[str, ...]:
    """The facts one literal reads."""
    match node:
        case Const():
            return ()
        case Compare(_, left, right):
            return tuple(fact for side in (left, right) for _, fact in side.terms)
        case _:
            return (node.fact,)


def facts_of(node: Node) -> tuple[str, ...]:
    """The facts a condition reads, each once, in order of first use."""
    return tuple(dict.fromkeys(fact for literal in literals(node) for fact in literal_facts(literal)))


def unknown_facts(node: Node, reader: Reader) -> tuple[str, ...]:
    """The unknown facts on which an unknown condition hangs; parts already settled do not count."""
    if evaluate(node, reader) is not None:
        return ()
    match node:
        case And(parts) | Or(parts):
            return tuple(dict.fromkeys(fact for part in parts for fact in unknown_facts(part, reader)))
        case Not(part):
            return unknown_facts(part, reader)
        case _:
            return tuple(fact for fact in literal_facts(node) if reader.value(fact) is None)
