"""A model's answer to statements: JSON by the schema, as far as it is whole; else prose, by the matcher; else nothing, so that all stays unknown."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Protocol

from regdb.vocabulary import Fact, FactError, Value, Vocabulary
from regdb_runtime.perception.answer_schema import KEYS, NOT_SEEN, NOTHING, SEEN, SIGN_TEXT, SPEED_LIMIT, AnswerLimits, read_name
from regdb_runtime.perception.describer import Description, Frame, Prompt
from regdb_runtime.perception.evidence import Reading, Span, Statement
from regdb_runtime.perception.partial_json import Piece, first_object

POSTED, SIGN = "posted.speed", "sign.speed_limit"
"""What a number on a speed-limit sign says."""

_LONGEST_NUMBER = 16
"""Characters of a number with its unit."""


class ReadsText(Protocol):
    """Whatever reads prose: the matcher."""

    def read(self, text: str, captured: float = 0.0, frame: str = "", prompt: str = "", model: str = "") -> Reading: ...


@dataclass(frozen=True, slots=True)
class Asked:
    """Where an answer came from, for the evidence: capture time and id of the frame, name of the prompt, the model."""

    captured: float = 0.0
    frame: str = ""
    prompt: str = ""
    model: str = ""


def read_answer(
    description: Description, matcher: ReadsText | None, vocabulary: Vocabulary, frame: Frame | None = None, prompt: Prompt | None = None,
    limits: AnswerLimits | None = None,
) -> Reading:  # fmt: skip
    """All that an answer says, with the places in its text; a failure says nothing.

    Text that shows itself as JSON is never read as prose: in `{"not_seen": ["stop si` the words of a denial would stand as an assertion.
    What is cut off (also the last sentence of prose: `a pedestrian` may have been going to end in `is not there`), contradicts itself, names
    no fact, or stands beside the answer is set aside with the reason.
    """
    text = description.text
    if description.failure or not text.strip():
        return Reading(text)
    asked = Asked(frame.captured if frame else 0.0, frame.id if frame else "", prompt.name if prompt else "", description.model)
    answer = first_object(text)
    if answer is not None:
        return _Answer(text, vocabulary, matcher, asked, limits or AnswerLimits()).read(answer)
    if "{" in text or any(f'"{key}"' in text for key in KEYS):
        return Reading(text, (), (("answer", Span(0, len(text)), "JSON that cannot be read"),))
    if matcher is None:
        return Reading(text)
    if not description.cut:
        return matcher.read(text, asked.captured, asked.frame, asked.prompt, asked.model)
    whole = max(text.rfind(mark) for mark in ".!?\n") + 1
    read = matcher.read(text[:whole], asked.captured, asked.frame, asked.prompt, asked.model)
    rest = Span(whole, len(text))
    return Reading(text, read.statements, (*read.set_aside, *((("…", rest, "cut off"),) if text[whole:].strip() else ())))


class _Answer:
    """One answer in JSON, as it is read."""

    def __init__(self, text: str, vocabulary: Vocabulary, matcher: ReadsText | None, asked: Asked, limits: AnswerLimits) -> None:
        self._text, self._vocabulary, self._matcher = text, vocabulary, matcher
        self._asked, self._limits = asked, limits
        self._said: list[Statement] = []
        self._aside: list[tuple[str, Span, str]] = []

    def read(self, answer: Piece) -> Reading:
        members = answer.members()
        for key in members.keys() - set(KEYS):
            self._set_aside(key, members[key], "no key of the schema")
        if answer.cut:
            self._aside.append(("answer", Span(answer.end, len(self._text)), "cut off"))
        self._beside(answer)
        for key, value in ((SEEN, True), (NOT_SEEN, False)):
            for piece in _strings(members.get(key)):
                self._name(key, piece, value)
        for piece in _strings(members.get(SIGN_TEXT)):
            self._sign(piece)
        if SPEED_LIMIT in members:
            self._speed(members[SPEED_LIMIT])
        return Reading(self._text, self._consistent(), tuple(self._aside))

    def _beside(self, answer: Piece) -> None:
        """Words before and after the object: an echo of the question as often as not."""
        for start, end in ((0, answer.start), (answer.end, len(self._text))):
            words = self._text[start:end].replace("json", " ").strip(" \t\r\n`")
            if words and not (answer.cut and start):
                self._aside.append((words[:40], Span(start, end), "beside the answer"))

    def _name(self, key: str, piece: Piece, seen: bool) -> None:
        name = str(piece.value)
        found = read_name(name, self._vocabulary)
        if found is None:
            self._set_aside(name, piece, "none of them" if name == NOTHING else "names no fact that a picture shows")
        elif seen:
            self._state(found[0].name, piece, key, found[1])
        elif found[0].kind == "boolean":
            self._state(found[0].name, piece, key, value=False)
        else:
            self._set_aside(name, piece, "a word that is not seen says nothing of the others")

    def _sign(self, piece: Piece) -> None:
        """The words on a sign, read as the sign's legend; every statement rests on the whole of them."""
        words = str(piece.value)[: self._limits.sign_length]
        if self._matcher is None or not words.strip():
            return
        asked = self._asked
        read = self._matcher.read(words, asked.captured, asked.frame, asked.prompt, asked.model)
        place = Span(piece.start + 1, piece.end - 1)
        self._said += [replace(item, spans=(place,), rule=f"{SIGN_TEXT}: {item.rule}") for item in read.statements]
        self._aside += [(what, place, why) for what, _, why in read.set_aside]

    def _speed(self, piece: Piece) -> None:
        """The number on the sign: an integer, or text with or without a unit."""
        fact = self._vocabulary.facts.get(POSTED)
        if fact is None or piece.value is None:
            return
        number = _number(fact, piece.value)
        if number is None or not self._plausible(fact, number):
            self._set_aside(str(piece.value), piece, "no number of a speed limit")
            return
        self._state(POSTED, piece, SPEED_LIMIT, number)
        if SIGN in self._vocabulary:
            self._state(SIGN, piece, SPEED_LIMIT, value=True)

    def _plausible(self, fact: Fact, number: float) -> bool:
        least, most = (_number(fact, bound) for bound in (self._limits.least, self._limits.most))
        return least is not None and most is not None and least <= number <= most

    def _state(self, fact: str, piece: Piece, rule: str, value: Value) -> None:
        asked = self._asked
        self._said.append(Statement(
            fact, value, captured=asked.captured, spans=(Span(piece.start, piece.end),), rule=rule, frame=asked.frame, prompt=asked.prompt,
            model=asked.model,
        ))  # fmt: skip

    def _set_aside(self, what: str, piece: Piece, why: str) -> None:
        self._aside.append((what, Span(piece.start, piece.end), why))

    def _consistent(self) -> tuple[Statement, ...]:
        """The statements in the order of their places, each once; words of a set together; of a fact said in two ways, neither."""
        values: dict[str, set[Value]] = {}
        for item in self._said:
            values.setdefault(item.fact, set()).add(item.value)
        kept: dict[tuple[str, Value], Statement] = {}
        for item in sorted(self._said, key=lambda said: said.spans[0].start):
            kind = self._vocabulary.facts[item.fact].kind if item.fact in self._vocabulary else ""
            if kind == "set":
                item = replace(item, value=_union(values[item.fact]))
            elif len(values[item.fact]) > 1:
                self._aside.append((item.fact, item.spans[0], "said in two ways"))
                continue
            earlier = kept.get((item.fact, item.value))
            kept[item.fact, item.value] = item if earlier is None else replace(earlier, spans=(*earlier.spans, *item.spans))
        return tuple(kept.values())


def _union(values: set[Value]) -> frozenset[str]:
    return frozenset(word for value in values if isinstance(value, frozenset) for word in value)


def _strings(piece: Piece | None) -> Iterator[Piece]:
    """The texts of a list; a text alone, and the true ones of an object of truths, count as a list too."""
    if piece is None:
        return
    if isinstance(piece.value, str):
        yield piece
    elif isinstance(piece.value, list):
        yield from (item for item in piece.items() if isinstance(item.value, str))
    elif isinstance(piece.value, dict):
        yield from (replace(item, value=name) for name, item in piece.members().items() if item.value is True)


def _number(fact: Fact, value: object) -> float | None:
    """A number with or without a unit as the fact's SI; without one it is in the fact's usual unit."""
    if isinstance(value, bool) or not isinstance(value, (int, float, str)):
        return None
    text = str(value).strip().lower()
    if len(text) > _LONGEST_NUMBER:
        return None
    if text.replace(".", "", 1).isdigit():
        text = f"{text} {fact.unit}"
    try:
        found = fact.read(text)
    except FactError:
        return None
    return float(found) if isinstance(found, (int, float)) else None
