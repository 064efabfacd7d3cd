"""A rule's condition as parts that must all hold: `when and not unless`, negations pushed inward, conjunctions flat."""

from __future__ import annotations

from regdb.condition import FALSE, TRUE, And, Compare, Const, Has, Is, Known, Node, Not, OneOf, Or, Within, facts_of
from regdb.regulation import Regulation

Conjuncts = tuple[Node, ...]


def conjuncts(rule: Regulation) -> Conjuncts:
    """The parts of `when and not unless`, each once; `(FALSE,)` when one of them is the constant false."""
    parts = [*_flat(rule.when, positive=True)]
    if rule.unless is not None:
        parts += _flat(rule.unless, positive=False)
    unique = tuple(dict.fromkeys(part for part in parts if part != TRUE))
    return (FALSE,) if FALSE in unique else unique


def _flat(node: Node, *, positive: bool) -> list[Node]:
    """A node, or its negation, as a list of parts that are no conjunctions."""
    match node:
        case Not(part):
            return _flat(part, positive=not positive)
        case And(parts) if positive:
            return [item for part in parts for item in _flat(part, positive=True)]
        case Or(parts) if not positive:
            return [item for part in parts for item in _flat(part, positive=False)]
        case And(parts) | Or(parts):
            return [_either(tuple(_joined(part, positive=positive) for part in parts))]
        case Const(value):
            return [TRUE if value is positive else FALSE]
        case _:
            return [node if positive else Not(node)]


def _joined(node: Node, *, positive: bool) -> Node:
    parts = _flat(node, positive=positive)
    return TRUE if not parts else parts[0] if len(parts) == 1 else And(tuple(parts))


def _either(parts: tuple[Node, ...]) -> Node:
    flat = [item for part in parts for item in (part.parts if isinstance(part, Or) else (part,))]
    left = [part for part in flat if part != FALSE]
    if TRUE in left:
        return TRUE
    return FALSE if not left else left[0] if len(left) == 1 else Or(tuple(left))


def depth(node: Node) -> int:
    """Levels of operators in a part."""
    match node:
        case And(parts) | Or(parts):
            return 1 + max(map(depth, parts), default=0)
        case Not(part):
            return 1 + depth(part)
        case _:
            return 1


def reads_only(node: Node) -> str | None:
    """The one fact a part reads (not by `known`), or None when it reads several, none, or whether something is known."""
    if _asks_known(node):
        return None
    facts = facts_of(node)
    return facts[0] if len(facts) == 1 else None


def _asks_known(node: Node) -> bool:
    match node:
        case And(parts) | Or(parts):
            return any(map(_asks_known, parts))
        case Not(part):
            return _asks_known(part)
        case _:
            return isinstance(node, Known)


def chance(node: Node) -> float:
    """A rough guess how often a part is possible, for the order of tests: the rarest first."""
    match node:
        case OneOf(_, words):
            return min(0.15 * len(words), 0.8)
        case Not(OneOf(_, words)):
            return max(1 - 0.15 * len(words), 0.2)
        case Is():
            return 0.3
        case Has() | Within():
            return 0.35
        case Compare(op):
            return 0.1 if op == "==" else 0.5
        case Or(parts):
            return min(1.0, sum(map(chance, parts)) + 0.1)
        case Const(value):
            return float(value)
        case _:
            return 0.7
