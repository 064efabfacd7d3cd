"""A section is only partly encoded.

Why:
    This list is the work left to do, and what a reader must not take for the whole law; so it is for information.

Fails:
    omitted: [{subdivision: (b), status: not_expressible, why: no fact tells it}]
    outline: [{chapter: Chapter 1, sections: {"10": Red, "20": Speed, "30": Limits, "40": Local, "100": Children}}]

Passes:
    omitted: [{subdivision: (b), status: not_for_ads, why: binds pedestrians}]
    outline: [{chapter: Chapter 1, sections: {"10": Red, "20": Speed, "30": Limits, "40": Local, "100": Children}}]
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build
from regdb_compiler.lint.view import view_of

CODE, NAME = "R126", "partial-section"
LEVEL: Level = "info"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each such section, where the code has an outline; gaps in the text are another rule's."""
    for ledger in view_of(build).ledgers:
        for item in ledger.accounts if ledger.outline is not None else ():
            if item.status == "partial" and "neither cited nor omitted" not in item.why:
                law = f"{ledger.jurisdiction.short} {item.section}"
                yield Diagnostic(CODE, NAME, LEVEL, f"{law} is partly encoded", item.place, note=item.why, law=law)
