"""A subdivision is written that the id tells already.

Why:
    `subdivision` is for ids that do not spell it. Written everywhere, it is one more place to forget.

Fails:
    id: b
    subdivision: (b)

Passes:
    id: b

Fix (safe):
    Takes the line out.
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Fix, Level
from regdb_compiler.driver import Build
from regdb_compiler.entries import subdivision_of
from regdb_compiler.lint.edits import delete_key

CODE, NAME = "R920", "redundant-subdivision"
LEVEL: Level = "info"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each such line; where the id goes on with words, the line tells where the levels end."""
    for entry in build.corpus.regulations:
        written = entry.doc.subdivision
        if not written or entry.doc.id != "-".join(entry.citation.parts).lower():
            continue
        if subdivision_of(entry.doc.model_copy(update={"subdivision": None})) != written:
            continue
        edit = delete_key(entry.node, "subdivision")
        fix = Fix("safe", "take the line out", (edit,)) if edit else None
        message = f"the id `{entry.doc.id}` is cited as {written} anyway"
        yield Diagnostic(CODE, NAME, LEVEL, message, entry.place("subdivision"), law=str(entry.citation), fix=fix)
