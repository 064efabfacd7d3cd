"""A section has a file, but its code's outline does not list it.

Why:
    The ledger counts what the outline lists. A section that is not in it is silent: nobody sees where it stands in the code.

Fails:
    outline: [{chapter: Chapter 1, sections: {"10": Red, "20": Speed, "30": Limits, "40": Local}}]

Passes:
    outline: [{chapter: Chapter 1, sections: {"10": Red, "20": Speed, "30": Limits, "40": Local, "100": Children}}]
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build
from regdb_compiler.lint.view import view_of

CODE, NAME = "R124", "unlisted-section"
LEVEL: Level = "error"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each such section, where the code has an outline."""
    for ledger in view_of(build).ledgers:
        outline = ledger.jurisdiction.code
        for item in ledger.accounts if ledger.outline is not None else ():
            if not item.listed:
                law = f"{ledger.jurisdiction.short} {item.section}"
                message = f"{law} is not in the outline"
                yield Diagnostic(CODE, NAME, LEVEL, message, item.place, help=f"list it in {outline}/outline.yaml", law=law)
