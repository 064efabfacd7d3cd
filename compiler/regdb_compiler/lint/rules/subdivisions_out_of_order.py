"""A regulation stands before one of an earlier subdivision.

Why:
    A reader compares file and law side by side. Regulations in the order of the law make a missing one visible.

Fails:
    regulations: [{id: b}, {id: a}]

Passes:
    regulations: [{id: a}, {id: b}]
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build

CODE, NAME = "R112", "subdivisions-out-of-order"
LEVEL: Level = "warning"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each regulation that comes too late; those of no subdivision stand anywhere."""
    for version in build.corpus.versions:
        written = [entry.citation.subdivision for entry in version.regulations]
        if all(len(text) == 3 for text in written) and written == sorted(written):
            continue  # (a) (b) (c): nearly always so, and comparing citations takes long
        cited = [entry for entry in version.regulations if entry.citation.parts]
        for earlier, later in pairwise(cited):
            if later.citation < earlier.citation:
                message = f"{later.citation.subdivision} stands after {earlier.citation.subdivision}"
                related = ((earlier.place("id"), "the one before"),)
                yield Diagnostic(CODE, NAME, LEVEL, message, later.place("id"), related=related, law=str(later.citation))
