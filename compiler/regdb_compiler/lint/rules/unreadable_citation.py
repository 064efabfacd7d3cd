"""A case cites something that cannot be read as a citation.

Why:
    Coverage counts which sections the cases exercise, and pages link there. Words that are no citation link to nothing.

Fails:
    cases: [{name: x, cites: [red light], plan: {current: stop, next: turn_right}, expect: legal}]

Passes:
    cases: [{name: x, cites: [ST 10(a)], plan: {current: stop, next: turn_right}, expect: legal}]
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb.citation import CitationError, parse_citation
from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build

CODE, NAME = "R114", "unreadable-citation"
LEVEL: Level = "error"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each such citation."""
    for case in build.corpus.cases:
        for position, text in enumerate(case.doc.cites):
            try:
                parse_citation(text)
            except CitationError as error:
                message, _, help_ = str(error).partition("; ")
                yield Diagnostic(CODE, NAME, LEVEL, message, case.place("cites", position), help=help_)
