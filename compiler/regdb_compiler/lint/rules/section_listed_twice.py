"""The outline lists a section in two places.

Why:
    It would count twice, and two headings or reasons of one section drift apart.

Fails:
    outline:
      - {chapter: Chapter 1, sections: {"10": Red, "20": Speed, "30": Limits, "40": Local, "100": Children}}
      - {chapter: Chapter 2, sections: {"100": Children again}}

Passes:
    outline: [{chapter: Chapter 1, sections: {"10": Red, "20": Speed, "30": Limits, "40": Local, "100": Children}}]
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build
from regdb_compiler.lint.view import view_of

CODE, NAME = "R128", "section-listed-twice"
LEVEL: Level = "warning"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each later listing."""
    for ledger in view_of(build).ledgers:
        first: dict[str, Diagnostic] = {}
        for item in ledger.accounts:
            law = f"{ledger.jurisdiction.short} {item.section}"
            found = Diagnostic(CODE, NAME, LEVEL, f"{law} is listed twice", item.place, law=law)
            earlier = first.setdefault(item.section, found)
            if earlier is not found and item.listed:
                yield Diagnostic(CODE, NAME, LEVEL, found.message, item.place, related=((earlier.place, "also here"),), law=law)
