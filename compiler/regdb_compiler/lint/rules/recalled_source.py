"""The text was not seen anywhere: it is recalled.

Why:
    What nobody has verified is never shown as verified. This list is the work left to do, so it is for information.

Fails:
    source: {url: null, also: null, confidence: recalled}

Passes:
    source: {confidence: seen}
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build

CODE, NAME = "R116", "recalled-source"
LEVEL: Level = "info"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each section that is recalled."""
    for section in build.corpus.sections:
        if section.doc.source.confidence == "recalled":
            message = f"{section.citation} is recalled; no source was seen"
            yield Diagnostic(CODE, NAME, LEVEL, message, section.place("source", "confidence"), law=str(section.citation))
