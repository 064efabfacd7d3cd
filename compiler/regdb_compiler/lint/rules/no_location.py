"""The section does not say where in its code it stands.

Why:
    The place in the legislation is part of every entry (division, chapter, article): coverage is counted by it.

Fails:
    location: []

Passes:
    location: [Division 1, Chapter 1]
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build

CODE, NAME = "R121", "no-location"
LEVEL: Level = "warning"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each section without a location, or with a level left blank."""
    for section in build.corpus.sections:
        location = section.doc.location
        if not location or not all(part.strip() for part in location):
            message = "the place in the code is not told" if not location else "a level of the location is blank"
            place = section.key_place("location")
            yield Diagnostic(CODE, NAME, LEVEL, message, place, help="[Division 11, Chapter 7, Article 1]", law=str(section.citation))
