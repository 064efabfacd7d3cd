"""A vagueness above 0 comes without a reason.

Why:
    The reason names the words that are open, so that somebody else would give the same score.

Fails:
    vagueness: 2

Passes:
    vagueness: {score: 2, because: '"near" names no distance'}
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build

CODE, NAME = "R702", "score-without-reason"
LEVEL: Level = "warning"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each score without `because`."""
    for entry in build.corpus.regulations:
        vagueness = entry.doc.vagueness
        if vagueness.score and not vagueness.because.strip():
            message = f"vagueness {vagueness.score} without a reason"
            help_ = f"vagueness: {{score: {vagueness.score}, because: ...}}"
            yield Diagnostic(CODE, NAME, LEVEL, message, entry.place("vagueness"), help=help_, law=str(entry.citation))
