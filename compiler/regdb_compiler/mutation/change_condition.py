"""A condition -> every condition that differs from it in one written thing: an operator, a part, a word, a number, a `not`."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from fractions import Fraction

from regdb.condition import TRUE, And, Compare, Const, Has, Is, Known, Linear, Literal, Node, Not, OneOf, Or, Within, literals
from regdb.condition_text import show
from regdb.units import from_si, unit_named
from regdb.vocabulary import Vocabulary

EDGE = {"<": "<=", "<=": "<", ">": ">=", ">=": ">"}
"""The operator that differs on the number itself and nowhere else."""

_MINUTE = 60


@dataclass(frozen=True, slots=True)
class Change:
    """A changed tree, its kind, the change in words, and the literal beside which it is written."""

    kind: str
    node: Node
    what: str
    beside: Literal


def changes(node: Node, vocabulary: Vocabulary) -> Iterator[Change]:
    """Every single change of a condition; none of `true`, where nothing is written."""
    if isinstance(node, Const):
        return
    if not isinstance(node, (And, Or)):
        yield Change("part", TRUE, f"without `{show(node)}`", next(literals(node)))
    yield from _changes(node, vocabulary)


def _changes(node: Node, vocabulary: Vocabulary) -> Iterator[Change]:
    match node:
        case And(parts) | Or(parts):
            for position, part in enumerate(parts):
                before, after = parts[:position], parts[position + 1 :]
                yield Change("part", _join(type(node), (*before, *after)), f"without `{_short(part)}`", next(literals(part)))
                for change in _changes(part, vocabulary):
                    yield replace(change, node=type(node)((*before, change.node, *after)))
        case Not(part):
            yield Change("negation", part, f"`{_short(node)}` -> `{_short(part)}`", next(literals(part)))
            for change in _changes(part, vocabulary):
                if change.kind != "negation" or isinstance(part, (And, Or)):
                    yield replace(change, node=Not(change.node))
        case Const():
            return
        case _:
            yield Change("negation", Not(node), f"`{show(node)}` -> `{show(Not(node))}`", node)
            yield from _literal_changes(node, vocabulary)


def _join(kind: type[And] | type[Or], parts: tuple[Node, ...]) -> Node:
    return parts[0] if len(parts) == 1 else kind(parts)


def _short(node: Node) -> str:
    text = show(node)
    return text if len(text) <= 100 else f"{text[:97]}..."


def _literal_changes(node: Literal, vocabulary: Vocabulary) -> Iterator[Change]:
    match node:
        case OneOf():
            options: Iterator[tuple[str, Node]] = (("word", new) for new in _other_words(node, vocabulary))
        case Has(fact, word):
            options = (("word", Has(fact, other)) for other in _values(fact, vocabulary) if other != word)
            options = iter(list(options)[:1])
        case Compare():
            options = iter([*_other_operator(node), *(("bound", new) for new in _other_bounds(node))])
        case Within():
            options = (("bound", new) for new in _other_intervals(node))
        case Const() | Is() | Known():
            return
    for kind, new in options:
        yield Change(kind, new, f"`{show(node)}` -> `{show(new)}`", node)


def _values(fact: str, vocabulary: Vocabulary) -> tuple[str, ...]:
    declared = vocabulary.facts.get(fact)
    return declared.values if declared is not None else ()


def _other_words(node: OneOf, vocabulary: Vocabulary) -> Iterator[Node]:
    """One word alone becomes another; of several each is left out."""
    if len(node.words) > 1:
        for word in node.words:
            yield OneOf(node.fact, tuple(other for other in node.words if other != word))
        return
    values = _values(node.fact, vocabulary)
    others = [word for word in values if word not in node.words and word not in {"none", "other"}] or [w for w in values if w not in node.words]
    yield from (OneOf(node.fact, (word,)) for word in others[:1])


def _other_operator(node: Compare) -> Iterator[tuple[str, Node]]:
    if node.op in EDGE:
        yield "operator", replace(node, op=EDGE[node.op])
    elif node.op == "==":
        yield from (("operator", replace(node, op=op)) for op in ("<=", ">="))


def step(value: float, kind: str, unit: str) -> float:
    """One unit of a written number in SI: a minute, a day, 1 mph; a tenth of a unit where the number itself has a fraction."""
    if kind in {"time", "date"}:
        return float(_MINUTE if kind == "time" else 1)
    whole = from_si(value, unit).denominator == 1
    return float(unit_named(unit).factor * (1 if whole else Fraction(1, 10)))


def _other_bounds(node: Compare) -> Iterator[Node]:
    for by in _steps(node.left, node):
        yield replace(node, left=moved(node.left, by))
    for by in _steps(node.right, node):
        yield replace(node, right=moved(node.right, by))


def _steps(side: Linear, node: Compare) -> tuple[float, ...]:
    """One unit up and down, where a number is written on that side."""
    if side.terms and not side.constant:
        return ()
    size = step(side.constant, node.kind, node.unit)
    return size, -size


def moved(expression: Linear, by: float) -> Linear:
    """The expression with its number moved by so much."""
    return Linear(expression.constant + by, expression.terms)


def _other_intervals(node: Within) -> Iterator[Node]:
    size = int(step(0, node.kind, ""))
    for by in (size, -size):
        yield replace(node, start=_clock(node.start + by, node.kind))
        yield replace(node, end=_clock(node.end + by, node.kind))


def _clock(value: int, kind: str) -> int:
    return value % (24 * 3600) if kind == "time" else value
