"""The outline lists a section that has neither a file nor a reason, or a file that carries nothing.

Why:
    Silence is the one thing not allowed: a section is encoded, partly encoded, not for a driving ADS, or not expressible, and why.

Fails:
    outline: [{chapter: Chapter 1, sections: {"10": Red, "20": Speed, "30": Limits, "40": Local, "100": Children, "110": Alleys}}]

Passes:
    outline:
      - chapter: Chapter 1
        all: {status: not_for_ads, why: binds those who build roads}
        sections: {"10": Red, "20": Speed, "30": Limits, "40": Local, "100": Children, "110": Alleys}
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build
from regdb_compiler.lint.view import view_of

CODE, NAME = "R125", "unaccounted-section"
LEVEL: Level = "error"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each section that nothing accounts for, where the code has an outline."""
    for ledger in view_of(build).ledgers:
        for item in ledger.accounts if ledger.outline is not None else ():
            if item.listed and item.status == "unaccounted":
                law = f"{ledger.jurisdiction.short} {item.section}"
                told = "has neither a file nor a reason" if item.entry is None else "has a file that carries no rule and no reason"
                help_ = "encode it, or give a status and why" if item.entry is None else "add `omitted:` to its version"
                yield Diagnostic(CODE, NAME, LEVEL, f"{law} {told}", item.place, help=help_, law=law)
