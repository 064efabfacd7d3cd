"""A regulation names one that is never in force at the same time.

Why:
    The exception or override displaces nothing on any day.

Fails:
    effective: 2000-01-01
    regulations:
      - {id: a, until: 2010-01-01}
      - {id: b, effective: 2010-01-01, exception_to: [a], legality: true, result: may change lanes}

Passes:
    effective: 2000-01-01
    regulations:
      - {id: a}
      - {id: b, effective: 2010-01-01, exception_to: [a], legality: true, result: may change lanes}
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build
from regdb_compiler.lint.naming import named_targets

CODE, NAME = "R512", "never-together"
LEVEL: Level = "error"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each name none of whose versions shares a day with any version of the naming regulation."""
    for name in named_targets(build):
        entry, targets = name.entry, name.targets
        namers = build.corpus.by_id[entry.id]
        if not any(namer.overlaps(target) for namer in namers for target in targets):
            message = f"{entry.id} and {targets[0].id} are never in force on the same day"
            related = ((targets[0].place("id"), "named here"),)
            yield Diagnostic(CODE, NAME, LEVEL, message, name.place, related=related, law=str(entry.citation))
