"""What a sentence's cues reach: the marks of the context layer on its tokens, and how far a clause goes."""

from __future__ import annotations

from dataclasses import dataclass, field

from regdb_runtime.perception.cues import DEFINITE, NOT_PAST, PLACES

STRONG = frozenset(";:()?")
"""Marks that end every reach."""


@dataclass(slots=True)
class Cue:
    """A cue found: tokens first..last."""

    kind: str
    first: int
    last: int


@dataclass(slots=True)
class Context:
    """What reaches which token. `denied`, `hedged`, `aside`: token index -> whether, or why; `cues` for what asks about more."""

    said: list[str]
    cues: list[Cue] = field(default_factory=list)
    denied: set[int] = field(default_factory=set)
    hedged: set[int] = field(default_factory=set)
    aside: dict[int, str] = field(default_factory=dict)
    soft: dict[int, str] = field(default_factory=dict)
    colors_aside: dict[int, str] = field(default_factory=dict)

    def why_aside(self, places: list[int]) -> str:
        """Why a phrase that rests on these tokens is no statement about the scene now; empty when it is one."""
        for at in places:
            if at in self.aside:
                return self.aside[at]
        if places[0] in self.soft and not definite(self.said, places[0]):
            return self.soft[places[0]]
        return ""


def definite(said: list[str], first: int, determiners: frozenset[str] = DEFINITE) -> bool:
    """Whether one of these determiners stands before the noun phrase that begins here: `the red light`, not `pedestrians`."""
    at = first - 1
    while at >= 0 and first - at <= 4:
        word = said[at]
        if word in determiners:
            return True
        if word in ("and", "or", "any", "of") or not word.isalpha() or word in PLACES:
            return False
        at -= 1
    return False


def is_past(word: str) -> bool:
    """Whether this is a verb of a story: `turned`, `was`."""
    return (word.endswith("ed") and word not in NOT_PAST) or word in ("was", "were", "had", "began", "came", "saw", "went", "stood")


def comma(said: list[str], at: int) -> int:
    while at < len(said) and said[at] != "," and said[at] not in STRONG and said[at] != "then":
        at += 1
    return at


def until_comma(context: Context, cue: Cue, into: dict[int, str], why: str, *, commas: bool = False) -> None:
    said = context.said
    end = comma(said, cue.last + 1)
    while commas and end < len(said) and said[end] == ",":
        end = comma(said, end + 1)
    for at in range(cue.last + 1, end):
        into.setdefault(at, why)
