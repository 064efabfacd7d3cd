"""Two regulations of one version say the same.

Why:
    Both are reported for every breach, and whoever amends one leaves the other as it was.

Fails:
    regulations: [{id: a}, {id: b}]

Passes:
    regulations: [{id: a}, {id: b, condition: {when: sign.school}}]
"""

from __future__ import annotations

from collections.abc import Hashable, Iterator

from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build
from regdb_compiler.entries import RegulationEntry

CODE, NAME = "R916", "duplicate-regulation"
LEVEL: Level = "warning"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each regulation that another before it equals in all that decides."""
    for version in build.corpus.versions:
        if len(version.regulations) < 2:
            continue
        seen: dict[Hashable, RegulationEntry] = {}
        for entry in version.regulations:
            first = seen.setdefault(_meaning(entry), entry)
            if first is not entry:
                message = f"{entry.id} says the same as {first.id}"
                related = ((first.place("id"), "the first"),)
                yield Diagnostic(CODE, NAME, LEVEL, message, entry.place("id"), related=related, law=str(entry.citation))


def _meaning(entry: RegulationEntry) -> Hashable:
    """All that decides, as written; its words are not compared."""
    doc = entry.doc
    condition = doc.condition
    return (
        condition.when, condition.unless, doc.legality, tuple(doc.attributes.items()), doc.states.current, doc.states.next, doc.exception_to,
        doc.overrides, doc.requires_sign, doc.applies_to, doc.force, doc.effective, doc.until, doc.authority,
    )  # fmt: skip
