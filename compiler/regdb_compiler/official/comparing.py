"""Whether words stand in a text: both brought to one form (space, quotes, hyphens, section signs; case kept), and what is nearest."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterator
from dataclasses import dataclass

_ONE_FORM = str.maketrans(
    {
        "\u2018": "'", "\u2019": "'", "\u201a": "'", "\u201b": "'", "\u2032": "'", "`": "'",
        "\u201c": '"', "\u201d": '"', "\u201e": '"', "\u2033": '"', "\u00ab": '"', "\u00bb": '"',
        "\u2010": "-", "\u2011": "-", "\u2012": "-", "\u2013": "-", "\u2014": "-", "\u2015": "-", "\u2212": "-",
        "\u00ad": None, "\u200b": None, "\u200c": None, "\u200d": None, "\ufeff": None,
        "\u2026": "...", "\ufb01": "fi", "\ufb02": "fl",
    }
)  # fmt: skip
_SIGN = re.compile(r"\u00a7+\s*")
_GAP = re.compile(r"\s*(?:\.\.\.|\u2026)\s*")
LEAST_LIKE = 0.5
"""Share of equal words below which nothing is called the nearest passage."""

MORE_WORDS = 3
"""Words by which the nearest passage may be longer or shorter than what was looked for."""


@dataclass(frozen=True, slots=True)
class Match:
    """The words of the text that come nearest, and whether they differ in spacing, quotes, hyphens and stops alone."""

    words: str
    typographic: bool


def normal(text: str) -> str:
    """The text in the form in which texts are compared; case is kept."""
    text = _SIGN.sub("Section ", text.translate(_ONE_FORM))
    return re.sub(r"\s+", " ", text.replace("\u00a0", " ")).strip()


def contains(text: str, quote: str) -> bool:
    """Whether a quote stands in a text, both in any typography; of a quote with `...` in it, its parts one after the other."""
    whole, at = normal(text), 0
    for part in _GAP.split(quote):
        words = normal(part)
        found = whole.find(words, at)
        if found < 0:
            return False
        at = found + len(words)
    return True


def nearest(text: str, quote: str) -> Match | None:
    """The run of words of the text most like the quote; None if nothing is like it."""
    whole = normal(text)
    span = _loose_span(whole, normal(quote))
    if span is not None:
        return Match(whole[span[0] : span[1]], typographic=True)
    words, wanted = whole.split(" "), normal(quote).split(" ")
    best = max(_windows(words, wanted), key=lambda item: item[0], default=(0.0, 0, 0))
    return Match(" ".join(words[best[1] : best[2]]), typographic=False) if best[0] >= LEAST_LIKE else None


def _loose_span(whole: str, quote: str) -> tuple[int, int] | None:
    """Where the quote stands if only letters and digits count."""
    kept = [place for place, letter in enumerate(whole) if letter.isalnum()]
    wanted = "".join(letter for letter in quote if letter.isalnum())
    at = "".join(whole[place] for place in kept).find(wanted) if wanted else -1
    if at < 0:
        return None
    start, end = kept[at], kept[at + len(wanted) - 1] + 1
    inside_word = (start > 0 and whole[start - 1].isalnum()) or whole[end : end + 1].isalnum()
    return None if inside_word else (start, end)


def _windows(words: list[str], wanted: list[str]) -> Iterator[tuple[float, int, int]]:
    """Likeness, start and end of the stretches of the text around the runs that it shares with the quote."""
    matcher = difflib.SequenceMatcher(None, [_bare(word) for word in words], [_bare(word) for word in wanted], autojunk=False)
    blocks = [block for block in matcher.get_matching_blocks() if block.size]
    blocks.append(matcher.find_longest_match())
    for block in blocks:
        for more in range(-MORE_WORDS, MORE_WORDS + 1):
            start = max(0, block.a - block.b)
            end = min(len(words), start + len(wanted) + more)
            if end > start:
                yield difflib.SequenceMatcher(None, words[start:end], wanted, autojunk=False).ratio(), start, end


def _bare(word: str) -> str:
    return word.strip(".,;:()'\"").lower()
