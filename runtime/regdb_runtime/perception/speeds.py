"""Which speed a number is: the posted maximum, a minimum, an advised one, one for trucks, or only how fast somebody drives."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from regdb_runtime.perception.lexicon import FILLERS, Lexicon
from regdb_runtime.perception.sentences import Sentence
from regdb_runtime.perception.word_set import word_set

FACTS = {"limit": "posted.speed", "minimum": "posted.minimum_speed", "advisory": "posted.advisory_speed", "truck": "posted.truck_speed"}
"""Kind -> fact; other kinds (actual speeds, distances, times) say nothing of signs."""
LEFT_REACH, RIGHT_REACH = 18, 7
"""Tokens before and after a number within which the word that says what it is may stand."""
PLAUSIBLE = (5.0, 160.0)
"""Numbers that speed signs show, in the unit written; the widest range of posted limits, in km/h or mph."""
_UNITS = frozenset(("", "mph", "km/h"))
_ENDS = frozenset(";!?")


@dataclass(frozen=True, slots=True)
class Speed:
    """A number that a sign shows: the fact, the number's token, and the tokens that say so."""

    fact: str
    number: int
    mask: int


@dataclass(frozen=True, slots=True)
class SpeedWords:
    """The vocabulary's word classes for speeds."""

    limit: frozenset[str]
    minimum: frozenset[str]
    advisory: frozenset[str]
    actual: frozenset[str]
    truck: frozenset[str]

    @classmethod
    def of(cls, lexicon: Lexicon) -> SpeedWords:
        """From the classes `speed_limit`, `speed_minimum`, `speed_advisory`, `speed_actual`, `speed_truck`."""
        return cls(*(lexicon.class_of(f"speed_{kind}") for kind in ("limit", "minimum", "advisory", "actual", "truck")))


def speeds(sentence: Sentence, words: SpeedWords) -> Iterator[Speed]:
    """Every number of the sentence that a sign shows as a speed."""
    said = sentence.words
    before = -1
    last: Speed | None = None
    for at, number in sentence.numbers.items():
        if number.unit not in _UNITS or not PLAUSIBLE[0] <= number.value <= PLAUSIBLE[1]:
            before, last = at, None
            continue
        if last is not None and at - before <= 3 and said[at - 1] in ("(", "/", "or") and number.unit:
            found: Speed | None = Speed(last.fact, at, (last.mask & ~(1 << last.number)) | 1 << at)
        else:
            found = _right(said, at, words) or _left(said, at, before, words)
        if found is not None and not (number.unit == "" and at + 1 < len(said) and said[at + 1] in _COUNTED):
            yield found
            last = found
        else:
            last = None
        before = at


_ALLOWED = word_set("allowed permitted permissible legal allowable")
_COUNTED = word_set(
    """lane car vehicle pedestrian person people hour am pm a.m p.m way second minute foot day sign light cyclist degree"""
)


def _right(said: list[str], at: int, words: SpeedWords) -> Speed | None:
    """`25 mph speed limit`, `60: this is a speed limit sign`."""
    kind, mask = "", 1 << at
    for after in range(at + 1, min(len(said), at + 1 + RIGHT_REACH)):
        word = said[after]
        if word in words.minimum:
            kind, mask = "minimum", mask | 1 << after
        elif word in words.advisory:
            kind, mask = "advisory", mask | 1 << after
        elif word in words.truck and kind:
            kind = "truck"
        elif word in words.limit:
            return Speed(FACTS[kind or "limit"], at, mask | 1 << after)
        elif word not in FILLERS and word not in (":", "speed", "posted", "-", "school", "legal", "this"):
            break
    return Speed(FACTS[kind], at, mask) if kind else None


def _left(said: list[str], at: int, before: int, words: SpeedWords) -> Speed | None:
    """`speed limit sign showing 100 km/h`, `the maximum allowed speed on this road is 60`; the nearest word that says what it is decides."""
    truck = at + 2 < len(said) and said[at + 1] == "for" and said[at + 2] in words.truck
    for back in range(at - 1, max(before, at - 1 - LEFT_REACH, -1), -1):
        word = said[back]
        if word in _ENDS:
            return None
        if word in words.truck:
            truck = True
        elif word in words.actual:
            near = said[max(0, back - 3) : back]
            if word != "speed" or not any(item in words.limit or item in _ALLOWED for item in near):
                return None
            return Speed(FACTS["limit"], at, 1 << at | 1 << back)
        elif word in words.minimum or word in words.advisory:
            return Speed(FACTS["minimum" if word in words.minimum else "advisory"], at, 1 << at | 1 << back)
        elif word in words.limit:
            near = said[max(0, back - 3) : back]
            kind = "truck" if truck or any(item in words.truck for item in near) else "limit"
            for name, members in (("minimum", words.minimum), ("advisory", words.advisory)):
                if any(item in members for item in near):
                    kind = name
            return Speed(FACTS[kind], at, 1 << at | 1 << back)
    return None
