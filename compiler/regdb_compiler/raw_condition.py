"""The condition as the grammar gives it: words with their offsets in the text, before the vocabulary types them."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Word:
    """A token: its text, the grammar's name for it, and its offsets in the condition's text (end exclusive)."""

    text: str
    kind: str
    start: int
    end: int


@dataclass(frozen=True, slots=True)
class RawName:
    name: Word


@dataclass(frozen=True, slots=True)
class RawKnown:
    name: Word


@dataclass(frozen=True, slots=True)
class RawOneOf:
    name: Word
    words: tuple[Word, ...]


@dataclass(frozen=True, slots=True)
class RawHas:
    word: Word
    name: Word


@dataclass(frozen=True, slots=True)
class RawWithin:
    name: Word
    start: Word
    end: Word


@dataclass(frozen=True, slots=True)
class RawTerm:
    """One summand: its sign, and one factor or two."""

    sign: int
    factors: tuple[Word, ...]


@dataclass(frozen=True, slots=True)
class RawCompare:
    op: Word
    left: tuple[RawTerm, ...]
    right: tuple[RawTerm, ...]


@dataclass(frozen=True, slots=True)
class RawNot:
    part: Raw


@dataclass(frozen=True, slots=True)
class RawJoin:
    """`and` or `or` of two or more parts."""

    word: str
    parts: tuple[Raw, ...]


Raw = RawName | RawKnown | RawOneOf | RawHas | RawWithin | RawCompare | RawNot | RawJoin
