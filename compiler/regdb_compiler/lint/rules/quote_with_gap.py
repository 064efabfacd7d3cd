"""A quote leaves words out.

Why:
    A quote is exact so that it can be found in the attached text. Words with `...` between them are found nowhere.

Fails:
    quote: shall not ... change lanes

Passes:
    quote: shall not change lanes
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build

CODE, NAME = "R209", "quote-with-gap"
LEVEL: Level = "warning"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each quote with three points in it."""
    for entry in build.corpus.regulations:
        quote = entry.doc.quote
        gap = "..." if "..." in quote else "\u2026" if "\u2026" in quote else ""
        if gap:
            start = quote.index(gap)
            place = entry.text_place(start, start + len(gap), "quote")
            help_ = "quote one unbroken run of words"
            yield Diagnostic(CODE, NAME, LEVEL, "the quote leaves words out", place, help=help_, law=str(entry.citation))
