"""The section has no title.

Why:
    Titles head every page, search result and explanation.

Fails:
    title: ""

Passes:
    title: Children beside the road
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build

CODE, NAME = "R120", "empty-title"
LEVEL: Level = "warning"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each section whose title has no letter."""
    for section in build.corpus.sections:
        if not any(char.isalpha() for char in section.doc.title):
            place = section.key_place("title")
            help_ = "say in a few words what it is about"
            yield Diagnostic(CODE, NAME, LEVEL, "the section has no title", place, help=help_, law=str(section.citation))
