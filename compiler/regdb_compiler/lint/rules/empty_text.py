"""A version has no text.

Why:
    The rule restated in our own words is what a reader checks the annotations against.

Fails:
    text: " "

Passes:
    text: (a) A driver does not change lanes.
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build

CODE, NAME = "R208", "empty-text"
LEVEL: Level = "warning"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each version whose text is blank."""
    for version in build.corpus.versions:
        if not version.doc.text.strip():
            law = str(version.section.citation)
            yield Diagnostic(CODE, NAME, LEVEL, "the version has no text", version.key_place("text"), help="say what it says", law=law)
