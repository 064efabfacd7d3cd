"""A subdivision is cited with two levels of one kind in a row, as (a)(b) or (1)(2).

Why:
    Levels alternate: (a)(1)(A)(i). Two of a kind in a row are nearly always a list of subdivisions, or a level left out,
    and then the citation leads nowhere.

Fails:
    subdivision: (a)(b)

Passes:
    subdivision: (a)(1)
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import pairwise

from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build

CODE, NAME = "R113", "odd-subdivision"
LEVEL: Level = "warning"
_ROMAN = re.compile(r"[ivx]+\Z")


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each regulation whose citation repeats a kind of level."""
    for entry in build.corpus.regulations:
        parts = entry.citation.parts
        if len(parts) > 1 and any(_kind(a) == _kind(b) and not _ROMAN.match(b) for a, b in pairwise(parts)):
            message = f"{entry.citation.subdivision} has two levels of one kind in a row"
            place = entry.place("subdivision") if entry.doc.subdivision is not None else entry.place("id")
            yield Diagnostic(CODE, NAME, LEVEL, message, place, help="levels alternate: (a)(1)(A)", law=str(entry.citation))


def _kind(part: str) -> str:
    return "number" if part.isdigit() else "capital" if part.isupper() else "letter"
