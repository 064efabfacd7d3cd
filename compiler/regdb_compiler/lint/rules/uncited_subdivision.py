"""A regulation rests on a subdivision that the version's text does not have.

Why:
    The text restates the whole rule, subdivision by subdivision. A regulation without its passage cannot be checked by reading.

Fails:
    id: d

Passes:
    id: b
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build
from regdb_compiler.lint.view import view_of

CODE, NAME = "R206", "uncited-subdivision"
LEVEL: Level = "warning"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each regulation whose first level is nowhere in the text; not where a comment of the text covers a range."""
    view = view_of(build)
    for version in build.corpus.versions:
        if "(a)" not in view.passages(version)[""] and "(1)" not in version.doc.text:
            continue
        for entry in version.regulations:
            first = next(iter(entry.citation.parts), "")
            if first and f"({first})" not in version.doc.text:
                message = f"the text has no ({first})"
                place = entry.place("subdivision") if entry.doc.subdivision is not None else entry.place("id")
                related = ((version.place("text"), "the text"),)
                yield Diagnostic(CODE, NAME, LEVEL, message, place, related=related, law=str(entry.citation))
