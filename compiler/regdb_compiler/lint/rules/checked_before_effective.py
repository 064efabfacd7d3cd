"""A version came into force after its source was last checked.

Why:
    What was read was a text to come. Bills are amended, delayed and vetoed; once the day is there, somebody looks again.

Fails:
    source: {checked: 1999-12-31}

Passes:
    source: {checked: 2026-01-02}
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build
from regdb_compiler.lint.view import view_of

CODE, NAME = "R119", "checked-before-effective"
LEVEL: Level = "warning"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each version in force that nobody has looked at since."""
    today = view_of(build).today
    for version in build.corpus.versions:
        checked = version.section.doc.source.checked
        if checked.toordinal() < version.effective <= today:
            message = f"in force since {version.doc.effective.isoformat()}, last checked before that, on {checked.isoformat()}"
            related = ((version.section.place("source", "checked"), "checked here"),)
            law = str(version.section.citation)
            yield Diagnostic(CODE, NAME, LEVEL, message, version.place("effective"), related=related, law=law)
