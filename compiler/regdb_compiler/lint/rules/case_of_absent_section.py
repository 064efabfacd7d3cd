"""A case cites a section that is not in the codes.

Why:
    The case shows law that nobody wrote down, or the number is wrong; either way it counts for no section's coverage.

Fails:
    cases: [{name: x, cites: [ST 999], plan: {current: stop, next: turn_right}, expect: legal}]

Passes:
    cases: [{name: x, cites: [ST 10(b)], plan: {current: stop, next: turn_right}, expect: legal}]
"""

from __future__ import annotations

import difflib
from collections.abc import Iterator

from regdb.citation import CitationError, parse_citation
from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build

CODE, NAME = "R816", "case-of-absent-section"
LEVEL: Level = "warning"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each such citation."""
    known = build.corpus.by_citation
    for case in build.corpus.cases:
        for position, text in enumerate(case.doc.cites):
            try:
                citation = parse_citation(text)
            except CitationError:
                continue
            if (citation.code, citation.section) not in known:
                near = difflib.get_close_matches(citation.section, [number for code, number in known if code == citation.code], 1)
                note = f"did you mean {citation.code} {near[0]}?" if near else ""
                message = f"{citation.code} {citation.section} is not in the codes"
                yield Diagnostic(CODE, NAME, LEVEL, message, case.place("cites", position), note=note)
