"""A source that was attached prints the sections around this one, but not this one.

Why:
    A section that its own code does not print was repealed, renumbered, or never there under this number. Sources that hold single
    sections say nothing about others.

Fails:
    texts: {"99": "(a) Words of a section before.", "101": "(a) Words of a section after."}

Passes:
    texts: {"99": "(a) Words of a section before.", "100": "(a) A driver shall not change lanes.", "101": "(a) Words of a section after."}
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build
from regdb_compiler.official.annotated import texts_of

CODE, NAME = "R211", "section-not-in-text"
LEVEL: Level = "warning"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each section that an attached source passes over."""
    texts = texts_of(build)
    for section in build.corpus.sections if texts else ():
        source = texts.gap(section)
        if source:
            law = str(section.citation)
            message = f"the attached text prints the sections around {law}, but not {law}"
            help_ = "find out whether it was repealed (`until`) or renumbered"
            yield Diagnostic(CODE, NAME, LEVEL, message, section.place("section"), note=f"source: {source}", help=help_, law=law)
