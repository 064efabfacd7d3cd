"""The result's words say the opposite of `legality`: "may" where the transitions are unlawful, "must not" where they are permitted.

Why:
    A rule turned round makes every lawful plan unlawful, or the reverse, and nothing else in the file looks wrong.

Fails:
    result: may change lanes
    legality: false

Passes:
    result: must not change lanes
    legality: false

Fix (legal):
    Turns `legality` round. It changes what the law says here, so it is never applied by itself.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Edit, Fix, Level
from regdb_compiler.driver import Build

CODE, NAME = "R205", "polarity-mismatch"
LEVEL: Level = "error"
_WHO = r"\A\W*(?:(?:the driver|a driver|a vehicle|it|he|she|they)\s+)?"
_FORBIDS = re.compile(_WHO + r"(?:must|shall|may|can)\s*not\b|\bis (?:unlawful|prohibited|forbidden)\b", re.IGNORECASE)
_PERMITS = re.compile(_WHO + r"(?:may|can)\s+(?!not\b|only\b|no\b|neither\b|never\b)", re.IGNORECASE)
_LIMITED = re.compile(r"\b(?:not|no|only|unless|neither|never|without|until|if|when)\b", re.IGNORECASE)


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each result that speaks against its legality; "may drive 70 mph" with a limit is a way to speak of the limit."""
    for entry in build.corpus.regulations:
        doc = entry.doc
        permits = bool(_PERMITS.match(doc.result)) and not _LIMITED.search(doc.result) and not doc.attributes
        if (doc.legality and _FORBIDS.search(doc.result)) or (not doc.legality and permits):
            said, now = ("forbids", "true (a permission)") if doc.legality else ("permits", "false (a prohibition)")
            message = f"the result {said} something, but `legality` is {now}"
            place = entry.place("legality")
            fix = Fix("legal", "turn `legality` round", (Edit(place, "false" if doc.legality else "true"),))
            related = ((entry.place("result"), "the words"),)
            yield Diagnostic(CODE, NAME, LEVEL, message, place, related=related, law=str(entry.citation), fix=fix)
