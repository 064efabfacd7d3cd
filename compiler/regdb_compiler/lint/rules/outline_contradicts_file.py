"""The outline gives a reason for having no rule, but the section's file has rules.

Why:
    One of the two is out of date. The ledger believes the file; the outline can only call a section with rules partly encoded.

Fails:
    outline: [{chapter: Chapter 1, sections: {"100": {heading: Children, status: not_for_ads, why: binds children}}}]

Passes:
    outline: [{chapter: Chapter 1, sections: {"100": {heading: Children, status: partial, why: (b) is missing}}}]
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build
from regdb_compiler.lint.view import view_of

CODE, NAME = "R127", "outline-contradicts-file"
LEVEL: Level = "warning"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each listed section whose status is not what its file shows."""
    for ledger in view_of(build).ledgers:
        for item in ledger.accounts:
            if item.claimed not in {"", "partial", item.status} and item.entry is not None:
                law = f"{ledger.jurisdiction.short} {item.section}"
                message = f"the outline calls {law} {item.claimed}, its file shows {item.status}"
                related = ((item.entry.place("section"), "its file"),)
                help_ = "leave the status out of the outline, or the rules out of the file"
                yield Diagnostic(CODE, NAME, LEVEL, message, item.place, help=help_, related=related, law=law)
