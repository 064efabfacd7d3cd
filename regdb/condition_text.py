"""The condition tree as text a person reads (the compiler's parser reads it back) and as JSON (what the database stores)."""

from __future__ import annotations

import json
from typing import Any

from regdb.condition import And, Compare, Const, Has, Is, Known, Linear, Node, Not, OneOf, Or, Within
from regdb.units import from_si, show_number
from regdb.vocabulary import show_value

_BINDING = {Or: 1, And: 2, Not: 3}
_encode = json.JSONEncoder(separators=(",", ":"), ensure_ascii=False).encode


def show(node: Node) -> str:
    """Canonical text of a condition; parsing it gives the same tree."""
    return _show(node, 0)


def _show(node: Node, outer: int) -> str:
    match node:
        case And(parts) | Or(parts):
            own = _BINDING[type(node)]
            word = " and " if isinstance(node, And) else " or "
            text = word.join(_show(part, own) for part in parts)
            return f"({text})" if outer >= own else text
        case Not(OneOf(fact, (word,))):
            return f"{fact} != {word}"
        case Not(part):
            return f"not {_show(part, 3)}"
        case _:
            return _show_literal(node)


def _show_literal(node: Const | Is | OneOf | Has | Compare | Within | Known) -> str:
    match node:
        case Const(value):
            return "true" if value else "false"
        case Is(fact):
            return fact
        case OneOf(fact, (word,)):
            return f"{fact} == {word}"
        case OneOf(fact, words):
            return f"{fact} in {{{', '.join(words)}}}"
        case Has(fact, word):
            return f"{word} in {fact}"
        case Known(fact):
            return f"known({fact})"
        case Within(fact, start, end, kind):
            return f"{fact} within {show_value(start, kind, '')}..{show_value(end, kind, '')}"
        case Compare(op, left, right, kind, unit):
            return f"{show_linear(left, kind, unit)} {op} {show_linear(right, kind, unit)}"


def show_linear(expression: Linear, kind: str, unit: str) -> str:
    """A linear expression in the unit a person reads."""
    text = ""
    for coefficient, fact in expression.terms:
        sign = "-" if coefficient < 0 else "+"
        size = abs(coefficient)
        term = fact if size == 1 else f"{show_number(from_si(size, ''))} * {fact}"
        text += (f" {sign} {term}") if text else (term if sign == "+" else f"-{term}")
    if not text:
        return show_value(expression.constant, kind, unit)
    if expression.constant:
        text += f" {'-' if expression.constant < 0 else '+'} {show_value(abs(expression.constant), kind, unit)}"
    return text


def to_json(node: Node) -> str:
    """The tree as one line of JSON, the form the database stores."""
    return _encode(to_data(node))


def from_json(text: str) -> Node:
    """The tree from its JSON. Raises ValueError for what is no condition tree."""
    return from_data(json.loads(text))


def to_data(node: Node) -> list[Any]:
    """The tree as nested lists: an operator's name, then its operands."""
    match node:
        case And(parts):
            return ["and", *map(to_data, parts)]
        case Or(parts):
            return ["or", *map(to_data, parts)]
        case Not(part):
            return ["not", to_data(part)]
        case Const(value):
            return ["const", value]
        case Is(fact):
            return ["is", fact]
        case Known(fact):
            return ["known", fact]
        case OneOf(fact, words):
            return ["in", fact, list(words)]
        case Has(fact, word):
            return ["has", fact, word]
        case Within(fact, start, end, kind):
            return ["within", fact, start, end, kind]
        case Compare(op, left, right, kind, unit):
            return ["cmp", op, linear_to_data(left), linear_to_data(right), kind, unit]


def from_data(data: Any) -> Node:
    """The tree from nested lists. Raises ValueError for an operator or shape it does not know."""
    try:
        return _from_data(data)
    except (TypeError, IndexError, KeyError) as error:
        raise ValueError(f"not a condition tree: {data!r}") from error


def _from_data(data: Any) -> Node:
    match data:
        case ["and", *parts]:
            return And(tuple(map(_from_data, parts)))
        case ["or", *parts]:
            return Or(tuple(map(_from_data, parts)))
        case ["not", part]:
            return Not(_from_data(part))
        case ["const", bool(value)]:
            return Const(value)
        case ["is", str(fact)]:
            return Is(fact)
        case ["known", str(fact)]:
            return Known(fact)
        case ["in", str(fact), list(words)]:
            return OneOf(fact, tuple(words))
        case ["has", str(fact), str(word)]:
            return Has(fact, word)
        case ["within", str(fact), int(start), int(end), str(kind)]:
            return Within(fact, start, end, kind)
        case ["cmp", str(op), left, right, str(kind), str(unit)] if op in {"<", "<=", ">", ">=", "==", "!="}:
            return Compare(op, linear_from_data(left), linear_from_data(right), kind, unit)
        case _:
            raise ValueError(f"not a condition tree: {data!r}")


def linear_to_data(expression: Linear) -> list[Any]:
    return [expression.constant, [list(term) for term in expression.terms]]


def linear_from_data(data: Any) -> Linear:
    constant, terms = data
    return Linear(float(constant), tuple((float(coefficient), str(fact)) for coefficient, fact in terms))
