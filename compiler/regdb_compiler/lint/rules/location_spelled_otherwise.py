"""A level of the location is spelled otherwise than in most sections of the code.

Why:
    `Chapter 1` and `chapter  1` are two chapters to a table of contents.

Fails:
    location: [division 1, Chapter 1]

Passes:
    location: [Division 1, Chapter 1]

Fix (safe):
    Writes the level as most sections of the code do.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Edit, Fix, Level
from regdb_compiler.driver import Build

CODE, NAME = "R122", "location-spelled-otherwise"
LEVEL: Level = "warning"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each level that differs from the usual spelling in case, spaces or points only."""
    usual = _usual(build)
    for section in build.corpus.sections:
        for position, part in enumerate(section.doc.location):
            best = usual[section.jurisdiction.code, _bare(part)]
            if part != best and part.strip():
                place = section.place("location", position)
                fix = Fix("safe", f"write {best}", (Edit(place, best),)) if _is_plain(best) else None
                message = f"`{part}` is spelled `{best}` elsewhere"
                yield Diagnostic(CODE, NAME, LEVEL, message, place, law=str(section.citation), fix=fix)


def _usual(build: Build) -> dict[tuple[str, str], str]:
    """(code, level without case, spaces and points) -> its most frequent spelling, of equals the first in the alphabet."""
    counts: dict[tuple[str, str], Counter[str]] = defaultdict(Counter)
    for section in build.corpus.sections:
        for part in section.doc.location:
            counts[section.jurisdiction.code, _bare(part)][part] += 1
    return {key: min(found, key=lambda part: (-found[part], part)) for key, found in counts.items()}


def _bare(part: str) -> str:
    return "".join(char for char in part.casefold() if char.isalnum())


def _is_plain(text: str) -> bool:
    """Whether YAML takes the words as they stand, also in brackets."""
    return all(char.isalnum() or char in " -." for char in text) and text[:1].isalnum()
