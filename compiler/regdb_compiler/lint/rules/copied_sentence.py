"""A quote is longer than 25 words.

Why:
    A quote holds the few operative words on which a number or condition rests. Whole sentences are not copied: the official text is
    attached from the user's own copy.

Fails:
    quote: >-
      the driver of a vehicle that approaches a place where children are or may be expected to be at that time of the day
      shall not change lanes until that place has been passed

Passes:
    quote: shall not change lanes until that place has been passed
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build

CODE, NAME = "R201", "copied-sentence"
LEVEL: Level = "warning"
MOST_WORDS = 25


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each quote with more words than that."""
    for entry in build.corpus.regulations:
        quote = entry.doc.quote
        if quote.count(" ") >= MOST_WORDS and (count := len(quote.split())) > MOST_WORDS:
            message = f"the quote has {count} words; {MOST_WORDS} are the most"
            help_ = "keep the operative words; the rest belongs in `text`, in our own words"
            yield Diagnostic(CODE, NAME, LEVEL, message, entry.place("quote"), help=help_, law=str(entry.citation))
