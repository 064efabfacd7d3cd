"""A date lies before the motor car or more than fifty years ahead.

Why:
    A century mistyped turns law on or off for everybody, and no test notices: they are judged on other days.

Fails:
    versions: [{effective: 1026-01-01}]

Passes:
    versions: [{effective: 2026-01-01}]
"""

from __future__ import annotations

import datetime
from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build
from regdb_compiler.entries import Written
from regdb_compiler.lint.view import view_of

CODE, NAME = "R514", "far-date"
LEVEL: Level = "warning"
FIRST = datetime.date(1886, 1, 1).toordinal()
YEARS_AHEAD = 50


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each such date of a version, regulation or source."""
    last = view_of(build).today + 366 * YEARS_AHEAD
    for where, path, date in _dates(build):
        if date is not None and not FIRST <= date.toordinal() <= last:
            message = f"{date.isoformat()} is {'before any traffic law of cars' if date.toordinal() < FIRST else 'very far ahead'}"
            yield Diagnostic(CODE, NAME, LEVEL, message, where.place(*path))


def _dates(build: Build) -> Iterator[tuple[Written, tuple[str, ...], datetime.date | None]]:
    for section in build.corpus.sections:
        yield section, ("source", "checked"), section.doc.source.checked
    for version in build.corpus.versions:
        yield version, ("effective",), version.doc.effective
        yield version, ("until",), version.doc.until
    for entry in build.corpus.regulations:
        yield entry, ("effective",), entry.doc.effective
        yield entry, ("until",), entry.doc.until
