"""Normalised text -> sentences of tokens: words in one form (singular, number words as digits), marks, and quantities with their units."""

from __future__ import annotations

import re
from dataclasses import dataclass

from regdb_runtime.perception.normalise import Normalised
from regdb_runtime.perception.word_set import word_set

_TOKEN = re.compile(r"km/h|mi/h|[^\W\d_]+(?:'[^\W\d_]+)?|\d+(?:[.,]\d+)*|[.,;:!?()\[\]\n\"/&%+]|(?<!\w)'|'(?!\w)|(?<=\s)-+(?=\s)")
_ABBREVIATED = word_set("st ave blvd rd dr mr mrs ms approx etc e.g i.e eg ie vs hwy dept jr sr inc ft")
_STOPS = frozenset(".!?\n")

_SMALL = (
    "zero", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten", "eleven", "twelve", "thirteen", "fourteen", "fifteen",
    "sixteen", "seventeen", "eighteen", "nineteen",
)  # fmt: skip
_ONES = {word: n for n, word in enumerate(_SMALL)}
_TENS = {word: 10 * n for n, word in enumerate(("twenty", "thirty", "forty", "fifty", "sixty", "seventy", "eighty", "ninety"), 2)}
_NUMBERS = frozenset(_ONES) | frozenset(_TENS)
_DIGITS = frozenset("0123456789")
_UNITS = {
    "mph": "mph", "mi/h": "mph", "km/h": "km/h", "kmh": "km/h", "kph": "km/h", "kmph": "km/h", "km": "km/h", "kms": "km/h",
    "ft": "ft", "foot": "ft", "feet": "ft", "meter": "m", "metre": "m", "m": "m", "yard": "yd", "inch": "in", "percent": "%", "%": "%",
    "pound": "lb", "lb": "lb", "lbs": "lb", "ton": "ton", "mile": "mi", "second": "s", "kilometer": "km", "kilometre": "km",
}  # fmt: skip
_PER_HOUR = {"mile": "mph", "mi": "mph", "kilometer": "km/h", "kilometre": "km/h", "km": "km/h"}
_IRREGULAR = {
    "men": "man", "women": "woman", "children": "child", "people": "person", "persons": "person", "kids": "kid", "buses": "bus", "busses": "bus",
    "lorries": "lorry", "policemen": "policeman", "firemen": "fireman", "workmen": "workman", "feet": "foot", "axes": "axis",
    "colour": "color", "coloured": "colored", "centre": "center", "kerb": "curb", "grey": "gray", "signalised": "signalized", "metres": "meter",
    "metre": "meter", "bike": "bicycle", "bikes": "bicycle", "has": "have", "does": "do", "goes": "go", "lanes": "lane", "zones": "zone",
    "bicyclist": "cyclist", "bicyclists": "cyclist", "biker": "cyclist", "signalling": "signaling", "cannot": "not", "motorbike": "motorcycle",
    "motorbikes": "motorcycle", "motorcyclists": "motorcyclist", "cyclists": "cyclist", "can't": "not", "won't": "not", "ain't": "not",
    "yellow's": "yellow", "let's": "let", "this": "this", "always": "always", "perhaps": "perhaps", "is": "is", "was": "was", "as": "as",
    "its": "its", "his": "his", "us": "us", "besides": "besides", "across": "across", "towards": "toward", "afterwards": "afterward",
}  # fmt: skip


class Forms(dict[str, str]):
    """Word -> the one form of it the lexicon uses; worked out once for each word met."""

    limit = 60_000

    def __missing__(self, word: str) -> str:
        form = one_form(word)
        if len(self) < self.limit:
            self[word] = form
        return form


def one_form(word: str) -> str:
    """`lights` -> `light`, `isn't` -> `not`, `bus's` -> `bus`, `kerb` -> `curb`; what is no plural stays."""
    if word in _IRREGULAR:
        return _IRREGULAR[word]
    if "'" in word and len(word) > 1:
        return "not" if word.endswith("n't") else one_form(word.partition("'")[0])
    if len(word) < 4 or not word.endswith("s") or word.endswith(("ss", "us", "is")):
        return word
    if word.endswith("ies") and len(word) > 4:
        return word[:-3] + "y"
    return word[:-2] if word.endswith(("ches", "shes", "xes", "sses", "zes")) else word[:-1]


FORMS = Forms()


@dataclass(frozen=True, slots=True)
class Number:
    """A number as written, and its unit; empty where none is written."""

    value: float
    unit: str


@dataclass(slots=True)
class Sentence:
    """Tokens of one sentence in their one form; `starts` and `ends` in the normalised text. `numbers`: token index -> quantity.

    `ending`: the mark it ends with, empty at the end of the text.
    """

    words: list[str]
    starts: list[int]
    ends: list[int]
    numbers: dict[int, Number]
    ending: str


def tokens(text: str) -> list[str]:
    """The tokens of a phrase, in their one form; number words as digits, as in sentences."""
    return [str(_ONES[word]) if word in _ONES else FORMS[word] for word in _TOKEN.findall(text)]


def sentences(normal: Normalised) -> list[Sentence]:
    """Split at `.`, `!`, `?` and line ends, not after an abbreviation."""
    text = normal.text
    raw: list[str] = []
    starts: list[int] = []
    for match in _TOKEN.finditer(text):
        raw.append(match[0])
        starts.append(match.start())
    found: list[Sentence] = []
    begin = 0
    for at, word in enumerate(raw):
        if word in _STOPS and not (word == "." and at > begin and _goes_on(text, raw[at - 1], starts[at] + 1)):
            if at > begin:
                found.append(_sentence(raw[begin:at], starts[begin:at], word))
            begin = at + 1
    if begin < len(raw):
        found.append(_sentence(raw[begin:], starts[begin:], ""))
    return found


def _goes_on(text: str, before: str, after: int) -> bool:
    """Whether a full stop after this word ends no sentence: an abbreviation, initials, or no space behind it."""
    if after < len(text) and text[after].isalnum():
        return True
    rest = text[after : after + 2].strip()
    return ((before in _ABBREVIATED and before != "no") or (len(before) == 1 and before.isalpha() and before != "i")) and bool(rest)


def _sentence(raw: list[str], starts: list[int], ending: str) -> Sentence:
    forms = FORMS
    words = [forms[word] for word in raw]
    ends = [start + len(word) for start, word in zip(starts, raw, strict=True)]
    if _NUMBERS.isdisjoint(raw) and not any(word[0] in _DIGITS for word in raw):
        return Sentence(words, starts, ends, {}, ending)
    return _with_numbers(words, starts, ends, ending)


def _with_numbers(words: list[str], starts: list[int], ends: list[int], ending: str) -> Sentence:
    """Number words become digits, and a unit joins the number before it."""
    made: list[str] = []
    firsts: list[int] = []
    lasts: list[int] = []
    numbers: dict[int, Number] = {}
    at = 0
    while at < len(words):
        value, after = _number(words, at)
        end = after
        if value is not None:
            unit, end = _unit(words, after)
            numbers[len(made)] = Number(value, unit)
            made.append(f"{value:g}")
        else:
            made.append(words[at])
        firsts.append(starts[at])
        lasts.append(ends[end - 1])
        at = end
    return Sentence(made, firsts, lasts, numbers, ending)


def _number(words: list[str], at: int) -> tuple[float | None, int]:
    word = words[at]
    if word[0] in _DIGITS:
        plain = word.replace(",", "") if re.fullmatch(r"\d{1,3}(,\d{3})+(\.\d+)?", word) else word.replace(",", ".")
        return (float(plain) if plain.count(".") <= 1 else None), at + 1
    if word in _TENS:
        if at + 1 < len(words) and words[at + 1] in _ONES and 0 < _ONES[words[at + 1]] < 10:
            return float(_TENS[word] + _ONES[words[at + 1]]), at + 2
        return float(_TENS[word]), at + 1
    if word in _ONES:
        return float(_ONES[word]), at + 1
    return None, at + 1


def _unit(words: list[str], at: int) -> tuple[str, int]:
    """The unit that follows, and where it ends."""
    if at + 2 < len(words) and words[at] in _PER_HOUR and words[at + 1] in ("per", "an", "/") and words[at + 2] in ("hour", "hr", "h"):
        return _PER_HOUR[words[at]], at + 3
    if at < len(words) and words[at] in _UNITS:
        return _UNITS[words[at]], at + 1
    return "", at
