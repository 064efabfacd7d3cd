"""A regulation's id does not begin with the subdivision it is cited by.

Why:
    `cvc-21453-b-right` tells where to look. An id of another subdivision sends readers to the wrong one.

Fails:
    id: a-right
    subdivision: (b)

Passes:
    id: b-right
    subdivision: (b)
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build

CODE, NAME = "R915", "id-not-from-subdivision"
LEVEL: Level = "warning"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each id with another letter or number in front than its written subdivision."""
    for entry in build.corpus.regulations:
        if not entry.doc.subdivision:
            continue
        wanted = "-".join(part.lower() for part in entry.citation.parts)
        if entry.doc.id != wanted and not entry.doc.id.startswith(f"{wanted}-"):
            message = f"the id of {entry.doc.subdivision} begins with `{wanted}`"
            related = ((entry.place("subdivision"), "cited so"),)
            yield Diagnostic(CODE, NAME, LEVEL, message, entry.place("id"), related=related, law=str(entry.citation))
