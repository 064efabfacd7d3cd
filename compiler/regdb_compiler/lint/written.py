"""A condition as its author wrote it: the parts of the text with their offsets, for findings and fixes about spelling."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache

from regdb_compiler.parse_condition import read_raw
from regdb_compiler.raw_condition import Raw, RawCompare, RawHas, RawJoin, RawKnown, RawName, RawNot, RawOneOf, RawWithin, Word
from regdb_compiler.type_condition import Problem

_AFTER = re.compile(r"\s*[,}]?\s*\}")
_BEFORE = re.compile(r"known\s*\(\s*\Z")


@dataclass(frozen=True, slots=True)
class Part:
    """A node with its offsets in the text, and the join that it is a part of."""

    raw: Raw
    start: int
    end: int
    join: RawJoin | None


@lru_cache(maxsize=1024)
def parts_of(text: str) -> tuple[Part, ...]:
    """Every node of a condition with its place, parents first; nothing when the text cannot be read."""
    raw = read_raw(text) if text else None
    return () if raw is None or isinstance(raw, Problem) else tuple(_parts(raw, text, None))


def _parts(raw: Raw, text: str, join: RawJoin | None) -> Iterator[Part]:
    words = tuple(_words(raw))
    start, end = words[0].start, words[-1].end
    if isinstance(_last(raw), RawOneOf) and (close := _AFTER.match(text, end)):
        end = close.end()
    if isinstance(_last(raw), RawKnown):
        end = text.index(")", end) + 1
    if isinstance(raw, RawKnown) and (opening := _BEFORE.search(text[:start])):
        start = opening.start()
    if isinstance(raw, RawNot) and (negation := re.search(_nots(raw), text[:start])):
        start = negation.start()
    yield Part(raw, start, end, join)
    inner = raw.parts if isinstance(raw, RawJoin) else (raw.part,) if isinstance(raw, RawNot) else ()
    for part in inner:
        yield from _parts(part, text, raw if isinstance(raw, RawJoin) else None)


def _nots(raw: RawNot) -> str:
    """What stands before the first word of a negation: as many `not` as it has, parentheses, `known(`."""
    count, inner = 1, raw.part
    while isinstance(inner, RawNot):
        count, inner = count + 1, inner.part
    return rf"(?:not[\s(]*){{{count}}}(?:known\s*\(\s*)?\Z"


def _last(raw: Raw) -> Raw:
    while isinstance(raw, (RawJoin, RawNot)):
        raw = raw.parts[-1] if isinstance(raw, RawJoin) else raw.part
    return raw


def _words(raw: Raw) -> Iterator[Word]:
    match raw:
        case RawJoin(_, parts):
            for part in parts:
                yield from _words(part)
        case RawNot(part):
            yield from _words(part)
        case RawName(name) | RawKnown(name):
            yield name
        case RawOneOf(name, words):
            yield name
            yield from words
        case RawHas(word, name):
            yield from (word, name)
        case RawWithin(name, start, end):
            yield from (name, start, end)
        case RawCompare(op, left, right):
            yield from (word for term in left for word in term.factors)
            yield op
            yield from (word for term in right for word in term.factors)


def spelled(raw: Raw) -> tuple[str, ...]:
    """The words of a part, for telling whether two say the same."""
    kind = raw.word if isinstance(raw, RawJoin) else type(raw).__name__
    if isinstance(raw, RawNot):
        return (kind, *spelled(raw.part))
    if isinstance(raw, RawJoin):
        return (kind, "(", *(word for part in raw.parts for word in spelled(part)), ")")
    if isinstance(raw, RawCompare):
        sides = (word for side in (raw.left, raw.right) for term in side for word in (str(term.sign), *(f.text for f in term.factors)))
        return (kind, raw.op.text, *sides)
    return (kind, *(word.text for word in _words(raw)))
