"""The day on which the source was checked has not come yet.

Why:
    Tests are judged on that day by default, and readers trust it. A day to come is a misprint.

Fails:
    source: {checked: 2999-01-01}

Passes:
    source: {checked: 2026-01-02}
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build
from regdb_compiler.lint.view import view_of

CODE, NAME = "R118", "checked-in-future"
LEVEL: Level = "warning"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each section checked after the day of the check; a day's grace, since calendars differ over the world."""
    today = view_of(build).today
    for section in build.corpus.sections:
        checked = section.doc.source.checked
        if checked.toordinal() > today + 1:
            message = f"the source cannot have been checked on {checked.isoformat()}"
            yield Diagnostic(CODE, NAME, LEVEL, message, section.place("source", "checked"), law=str(section.citation))
