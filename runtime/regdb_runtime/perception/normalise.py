"""Text as received -> lower-case ASCII-like text of plain marks, with the way back from every character to its place in the original."""

from __future__ import annotations

import unicodedata
from dataclasses import dataclass

_HYPHENS = "\u00ad\u2010\u2011\u2012\u2212\ufe58\ufe63\uff0d"
_DASHES = "\u2013\u2014\u2015"
_SINGLE = "\u2018\u2019\u201a\u201b\u2032\u02bc\uff07\u00b4`"
_DOUBLE = "\u201c\u201d\u201e\u201f\u2033\u00ab\u00bb\uff02"
_SPACES = "\u00a0\u1680\u2000\u2001\u2002\u2003\u2004\u2005\u2006\u2007\u2008\u2009\u200a\u200b\u202f\u205f\u2060\u3000\ufeff\t\v\f\r"
_BULLETS = "\u2022\u2023\u2043\u25aa\u25ab\u25cf\u25cb\u25e6\u25a0\u2219\u27a4\u2713\u2714"
_MARKDOWN = "*_#~>|<=\\^@"

SAME_LENGTH = str.maketrans(
    dict.fromkeys(_HYPHENS, "-") | dict.fromkeys(_DASHES, ";") | dict.fromkeys(_SINGLE, "'") | dict.fromkeys(_DOUBLE, '"')
    | dict.fromkeys(_SPACES, " ") | dict.fromkeys(_BULLETS, "\n") | dict.fromkeys(_MARKDOWN, " ") | {"\u2026": "."}
)  # fmt: skip
"""One character for one: hyphens, dashes, quotes, spaces, bullets, markdown. Places stay as they are."""


@dataclass(frozen=True, slots=True)
class Normalised:
    """`text` in lower case; `places[i]` is where its character i stood in the original, None where all stand where they stood."""

    text: str
    places: tuple[int, ...] | None = None

    def original(self, start: int, end: int) -> tuple[int, int]:
        """[start, end) of the original for [start, end) of `text`."""
        if self.places is None:
            return start, end
        return self.places[start], self.places[end - 1] + 1 if end > start else self.places[start]


def normalise(text: str) -> Normalised:
    """NFKC, lower case, plain hyphens, quotes and spaces; markdown becomes spaces, bullets line ends."""
    plain = text.translate(SAME_LENGTH)
    if plain.isascii():
        return Normalised(plain.lower())
    return _by_character(text)


def _by_character(text: str) -> Normalised:
    """For text whose characters change in number: ligatures, fractions, full-width letters, emoji."""
    made: list[str] = []
    places: list[int] = []
    for place, character in enumerate(text):
        for piece in _plain(character):
            made.append(piece)
            places.append(place)
    return Normalised("".join(made), tuple(places))


def _plain(character: str) -> str:
    """One character of the original in plain form: accents dropped, symbols a space."""
    one = character.translate(SAME_LENGTH)
    if one.isascii():
        return one.lower()
    spread = unicodedata.normalize("NFKD", one).translate(SAME_LENGTH)
    kept = "".join(" " if unicodedata.category(piece)[0] in "SC" else piece for piece in spread if not unicodedata.combining(piece))
    return kept.lower()
