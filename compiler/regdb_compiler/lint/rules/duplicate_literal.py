"""A part of an `and` or `or` is written twice.

Why:
    The second time it says nothing. Often it was meant to be another fact.

Fails:
    condition: {when: sign.school and children.present and sign.school}

Passes:
    condition: {when: sign.school and children.present}

Fix (safe):
    Takes the second one out.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Fix, Level
from regdb_compiler.driver import Build
from regdb_compiler.entries import RegulationEntry
from regdb_compiler.lint.edits import replace_words
from regdb_compiler.lint.view import view_of
from regdb_compiler.lint.written import Part, parts_of, spelled
from regdb_compiler.raw_condition import RawJoin, RawNot

CODE, NAME = "R438", "duplicate-literal"
LEVEL: Level = "warning"
_JOIN = re.compile(r"\s+(?:and|or)\s+(?:not\s+)*\Z")


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each repeated part, as written: definitions that overlap are no repetition."""
    view = view_of(build)
    for rule in view.first:
        doc = rule.entry.doc.condition
        for key, node, text in (("when", rule.when, doc.when), ("unless", rule.unless, doc.unless)):
            if node is None or not text:
                continue
            found = view.literals(node)
            if len(found) < 2 or len(set(found)) == len(found):
                continue
            yield from _repeated(rule.entry, key, text)


def _repeated(entry: RegulationEntry, key: str, text: str) -> Iterator[Diagnostic]:
    seen: dict[tuple[int, tuple[str, ...]], Part] = {}
    for part in parts_of(text):
        if part.join is None or isinstance(part.raw, RawJoin):
            continue
        first = seen.setdefault((id(part.join), spelled(part.raw)), part)
        if first is part:
            continue
        place = entry.text_place(part.start, part.end, "condition", key)
        related = ((entry.text_place(first.start, first.end, "condition", key), "the first time"),)
        message = f"`{text[part.start : part.end]}` is written twice"
        yield Diagnostic(CODE, NAME, LEVEL, message, place, related=related, law=str(entry.citation), fix=_fix(entry, key, text, part))


def _fix(entry: RegulationEntry, key: str, text: str, part: Part) -> Fix | None:
    before = _JOIN.search(text[: part.start])
    plain = not isinstance(part.raw, RawNot) or not isinstance(part.raw.part, RawJoin)
    edit = replace_words(entry.field("condition", key), before.start(), part.end, "") if before and plain else None
    return Fix("safe", "take the second one out", (edit,)) if edit else None
