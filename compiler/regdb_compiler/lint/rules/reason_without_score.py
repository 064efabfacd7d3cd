"""A reason for vagueness is given, but the score is 0.

Why:
    Either the rule is open and the score was forgotten, or the reason is left over.

Fails:
    vagueness: {score: 0, because: '"near" names no distance'}

Passes:
    vagueness: {score: 1, because: '"near" names no distance'}
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build

CODE, NAME = "R703", "reason-without-score"
LEVEL: Level = "warning"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each score of 0 with `because`."""
    for entry in build.corpus.regulations:
        vagueness = entry.doc.vagueness
        if not vagueness.score and vagueness.because.strip():
            place = entry.place("vagueness", "score")
            yield Diagnostic(CODE, NAME, LEVEL, "a reason is given, but the score is 0", place, law=str(entry.citation))
