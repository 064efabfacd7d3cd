"""Where a literal of a regulation's condition is written; one that comes from a definition stands at the condition itself."""

from __future__ import annotations

import re

from regdb.condition import Has, Literal, OneOf, literal_facts
from regdb_compiler.diagnostics import Place
from regdb_compiler.entries import RegulationEntry


def place_of_literal(entry: RegulationEntry, part: str, literal: Literal) -> Place:
    """The literal's first fact in the text of `when` or `unless`, or the attribute, sign or class that the literal is made from."""
    text = entry.doc.condition.when if part == "when" else entry.doc.condition.unless
    for fact in literal_facts(literal):
        found = _fact_with_words(text, fact, literal)
        if found is not None:
            return entry.text_place(*found, "condition", part)
    return _elsewhere(entry, literal, part)


def _fact_with_words(text: str, fact: str, literal: Literal) -> tuple[int, int] | None:
    """Of several mentions of a fact the one beside this literal's words."""
    mentions = [match.span() for match in re.finditer(rf"(?<![\w.]){re.escape(fact)}(?![\w.])", text)]
    words = literal.words if isinstance(literal, OneOf) else (literal.word,) if isinstance(literal, Has) else ()
    for start, end in mentions if words else ():
        near = text[end : end + 60] if isinstance(literal, OneOf) else text[max(0, start - 30) : start]
        if re.search(rf"\b{re.escape(words[0])}\b", re.split(r"\b(?:and|or)\b", near)[0 if isinstance(literal, OneOf) else -1]):
            return start, end
    return mentions[0] if mentions else None


def _elsewhere(entry: RegulationEntry, literal: Literal, part: str) -> Place:
    facts = literal_facts(literal)
    if entry.doc.requires_sign in facts:
        return entry.place("requires_sign")
    if "ego.vehicle_class" in facts and entry.doc.applies_to:
        return entry.place("applies_to")
    for name in entry.doc.attributes:
        if any(fact.rpartition(".")[2] in name or name in fact for fact in facts):
            return entry.place("attributes", name)
    return entry.place("condition", part) if part == "unless" or entry.doc.condition.when else entry.place("id")
