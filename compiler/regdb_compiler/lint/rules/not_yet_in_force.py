"""A version is not in force yet.

Why:
    It is right to have it, and good to know: what compiles today answers otherwise on that day.

Fails:
    effective: 2999-01-01
    regulations: [{id: a}]

Passes:
    effective: 2000-01-01
    regulations: [{id: a}]
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build
from regdb_compiler.lint.view import view_of

CODE, NAME = "R510", "not-yet-in-force"
LEVEL: Level = "info"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each version that begins after the day of the check."""
    today = view_of(build).today
    for version in build.corpus.versions:
        if version.effective > today:
            message = f"this version comes into force on {version.doc.effective.isoformat()}"
            yield Diagnostic(CODE, NAME, LEVEL, message, version.place("effective"), law=str(version.section.citation))
