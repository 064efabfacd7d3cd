"""A raw condition as its author's words in canonical spacing: nothing is reordered, no unit changed."""

from __future__ import annotations

import re

from regdb_compiler.raw_condition import (
    Raw,
    RawCompare,
    RawHas,
    RawJoin,
    RawKnown,
    RawName,
    RawNot,
    RawOneOf,
    RawTerm,
    RawWithin,
    Word,
)

_QUANTITY = re.compile(r"(\d+(?:\.\d+)?)\s*(\D.*)\Z", re.DOTALL)


def spell(raw: Raw, outer: int = 0) -> str:
    """Canonical text of a condition before types: one space around operators, no parentheses that say nothing."""
    match raw:
        case RawJoin(word, parts):
            own = 1 if word == "or" else 2
            text = f" {word} ".join(spell(part, own) for part in parts)
            return f"({text})" if outer > own else text
        case RawNot(part):
            return f"not {spell(part, 3)}"
        case RawName(name):
            return name.text
        case RawKnown(name):
            return f"known({name.text})"
        case RawOneOf(name, words):
            return f"{name.text} in {{{', '.join(word.text for word in words)}}}"
        case RawHas(word, name):
            return f"{word.text} in {name.text}"
        case RawWithin(name, start, end):
            return f"{name.text} within {start.text}..{end.text}"
        case RawCompare(op, left, right):
            return f"{_linear(left)} {op.text} {_linear(right)}"


def _linear(terms: tuple[RawTerm, ...]) -> str:
    text = ""
    for term in terms:
        body = " * ".join(_factor(word) for word in term.factors)
        sign = "-" if term.sign < 0 else "+"
        text = f"{text} {sign} {body}" if text else body if term.sign > 0 else f"-{body}"
    return text


def _factor(word: Word) -> str:
    if word.kind != "QUANTITY":
        return word.text
    match = _QUANTITY.match(word.text)
    return f"{match[1]} {match[2]}" if match else word.text
