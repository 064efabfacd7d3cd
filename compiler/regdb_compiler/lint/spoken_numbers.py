"""Quantities as law speaks of them: `3 feet`, `three feet`, `twenty-five miles per hour`, each with its place in the text."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import lru_cache

from regdb.units import parse_quantity, show_si

_ONES = (
    "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten", "eleven", "twelve", "thirteen", "fourteen", "fifteen",
    "sixteen", "seventeen", "eighteen", "nineteen",
)  # fmt: skip
_TENS = ("twenty", "thirty", "forty", "fifty", "sixty", "seventy", "eighty", "ninety")
_WORDS: dict[str, int] = {
    **{word: number for number, word in enumerate(_ONES, start=1)},
    **{word: 10 * number for number, word in enumerate(_TENS, start=2)},
    **{f"{ten}{sign}{one}": 10 * high + low
       for high, ten in enumerate(_TENS, start=2) for low, one in enumerate(_ONES[:9], start=1) for sign in "- "},
    "one hundred": 100, "two hundred": 200, "three hundred": 300, "five hundred": 500, "one thousand": 1000,
}  # fmt: skip
_UNITS = {
    "feet": "ft", "foot": "ft", "ft": "ft", "inch": "in", "inches": "in", "miles per hour": "mph", "miles an hour": "mph", "mph": "mph",
    "seconds": "s", "second": "s", "pounds": "lb", "pound": "lb", "lb": "lb", "tons": "",
}  # fmt: skip
_SPOKEN = re.compile(
    r"(?<![\w.$-])(?P<number>\d[\d,]*(?:\.\d+)?|" + "|".join(sorted(_WORDS, key=len, reverse=True)) + r")[\s-]+"
    r"(?P<unit>" + "|".join(word.replace(" ", r"\s+") for word in sorted(_UNITS, key=len, reverse=True)) + r")\b",
    re.IGNORECASE,
)
_HINT = re.compile(r"(?:[0-9a-z][ -])(?:feet|foot|ft|inch|miles|mph|second|pound|lb)")


@dataclass(frozen=True, slots=True)
class Spoken:
    """A quantity in words: what was said, where in the text, its value in SI and the unit's symbol."""

    words: str
    start: int
    end: int
    si: float
    unit: str

    @property
    def shown(self) -> str:
        """As the annotation writes it: `3 ft`."""
        return show_si(self.si, self.unit)


@lru_cache(maxsize=65536)
def spoken_numbers(text: str) -> tuple[Spoken, ...]:
    """The quantities that a text speaks of, in order; numbers without a unit are none."""
    if not _HINT.search(" ".join(text.lower().split())):
        return ()
    return tuple(_spoken(match) for match in _SPOKEN.finditer(text) if _unit(match))


def _spoken(match: re.Match[str]) -> Spoken:
    word = " ".join(match["number"].lower().split())
    number = str(_WORDS.get(word, word))
    return Spoken(match[0], match.start(), match.end(), parse_quantity(f"{number} {_unit(match)}").si, _unit(match))


def _unit(match: re.Match[str]) -> str:
    return _UNITS[" ".join(match["unit"].lower().split())]
