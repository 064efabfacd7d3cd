"""The source names no place where the text was read.

Why:
    A number that cannot be looked up cannot be checked. Only what is recalled from memory has no place, and says so.

Fails:
    source: {url: null, also: null, confidence: seen}

Passes:
    source: {url: https://example.org/100, confidence: seen}
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build

CODE, NAME = "R115", "source-without-url"
LEVEL: Level = "warning"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each section that claims to have been read somewhere and does not say where."""
    for section in build.corpus.sections:
        source = section.doc.source
        if not source.url.strip() and source.confidence != "recalled":
            message = f"the text is called {source.confidence}, but `url` does not say where"
            yield Diagnostic(CODE, NAME, LEVEL, message, section.place("source"), help="add `url:`", law=str(section.citation))
