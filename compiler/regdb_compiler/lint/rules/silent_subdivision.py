"""The text has a subdivision that no regulation cites and nothing omits.

Why:
    A section is called encoded only when every subdivision that prescribes is carried by a rule. One that is not says why.

Fails:
    text: |
      (a) A driver does not change lanes while children are beside the road.
      (b) A driver stops for them.
    regulations: [{id: a}]
    omitted: null

Passes:
    text: |
      (a) A driver does not change lanes while children are beside the road.
      (b) Children use the pavement.
    regulations: [{id: a}]
    omitted: [{subdivision: (b), status: not_for_ads, why: binds children}]
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build
from regdb_compiler.subdivisions import gaps, marked

CODE, NAME = "R212", "silent-subdivision"
LEVEL: Level = "warning"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each subdivision that opens a line or a sentence of a version's text."""
    for version in build.corpus.versions:
        marks = marked(version.doc.text)
        for letter in gaps(version):
            law = f"{version.section.citation}({letter})"
            place = version.text_place(*marks[letter], "text")
            help_ = "encode it, or name it in `omitted:` with status and why"
            yield Diagnostic(CODE, NAME, LEVEL, f"({letter}) is neither cited nor omitted", place, help=help_, law=law)
