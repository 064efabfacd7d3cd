"""The JSON Schema of sparse answers: what is seen, what is clearly not there, the words on signs, the number on the speed-limit sign."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from regdb.vocabulary import Fact, Value, Vocabulary

SEEN, NOT_SEEN, SIGN_TEXT, SPEED_LIMIT = "seen", "not_seen", "sign_text", "speed_limit"
KEYS = (SEEN, NOT_SEEN, SIGN_TEXT, SPEED_LIMIT)
NOTHING = "none"
"""The word of an enumeration that says nothing is there; nobody is asked to see it."""


@dataclass(frozen=True)
class AnswerLimits:
    """How long an answer may become, so that a small model ends in time: `items` names a list, `signs` texts of at most `sign_length`
    characters; a posted number lies between `least` and `most` (in the sign's own unit; 5 is the least of MUTCD R2-1, 85 the most posted)."""

    items: int = 12
    signs: int = 4
    sign_length: int = 80
    least: int = 5
    most: int = 85


def can_be_asked(fact: Fact) -> bool:
    """Whether a picture can answer it and words reveal it: the vocabulary must have a phrase, and a number must stand on a sign."""
    return fact.source in {"perception", "map"} and bool(fact.phrases) and fact.kind in {"boolean", "enumeration", "set"}


def names_of(fact: Fact) -> tuple[str, ...]:
    """How an answer names what is seen of a fact: a boolean by its name, a word of the others as `fact=word`."""
    if fact.kind == "boolean":
        return (fact.name,)
    return tuple(f"{fact.name}={word}" for word in fact.values if word != NOTHING)


def read_name(name: str, vocabulary: Vocabulary) -> tuple[Fact, Value] | None:
    """A name of an answer as a fact and the value that seeing it gives; None where it names nothing that may be seen."""
    head, equals, word = name.strip().partition("=")
    fact = vocabulary.facts.get(head.strip())
    word = word.strip()
    if fact is None or fact.source not in {"perception", "map"}:
        return None
    if fact.kind == "boolean":
        return (fact, True) if not equals or word == "true" else None
    if word not in fact.values:
        return None
    if fact.kind == "enumeration":
        return fact, word
    return (fact, frozenset((word,))) if fact.kind == "set" else None


def answer_schema(facts: Iterable[Fact], limits: AnswerLimits | None = None) -> Mapping[str, Any]:
    """The schema of an answer about these facts. Those that cannot be asked are left out; nothing but `seen` is required."""
    bounds = limits or AnswerLimits()
    asked = [fact for fact in facts if can_be_asked(fact)]
    seen = [name for fact in asked for name in names_of(fact)]
    absent = [fact.name for fact in asked if fact.kind == "boolean"]
    sign = {"type": "string", "maxLength": bounds.sign_length}
    properties: dict[str, Any] = {SEEN: _names(seen, bounds.items)}
    if absent:
        properties[NOT_SEEN] = _names(absent, bounds.items)
    properties[SIGN_TEXT] = {"type": "array", "items": sign, "maxItems": bounds.signs}
    properties[SPEED_LIMIT] = {"type": "integer", "minimum": bounds.least, "maximum": bounds.most}
    return {"type": "object", "properties": properties, "required": [SEEN], "additionalProperties": False}


def _names(names: list[str], most: int) -> dict[str, Any]:
    items: dict[str, Any] = {"type": "string", "enum": names} if names else {"type": "string", "maxLength": 64}
    return {"type": "array", "items": items, "maxItems": min(most, len(names)) if names else 0}
