"""The condition's words are missing, or are the result's words over again.

Why:
    The words are matched against what a camera and a model report, and shown in explanations: they say when, the result says what.

Fails:
    condition: {text: must not change lanes}

Passes:
    condition: {text: Children are beside the road.}
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build

CODE, NAME = "R203", "condition-says-nothing"
LEVEL: Level = "warning"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each such condition."""
    for entry in build.corpus.regulations:
        text = entry.doc.condition.text.strip(" .").casefold()
        if not text or text == entry.doc.result.strip(" .").casefold():
            message = "the condition's text repeats the result" if text else "the condition has no words"
            place = entry.key_place("condition", "text")
            yield Diagnostic(CODE, NAME, LEVEL, message, place, help="say in words when the rule holds", law=str(entry.citation))
