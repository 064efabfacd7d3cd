"""Which regulations every written exception and override names, with the place of the name."""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Place
from regdb_compiler.driver import Build
from regdb_compiler.entries import RegulationEntry


def named_targets(build: Build) -> Iterator[tuple[RegulationEntry, Place, tuple[RegulationEntry, ...]]]:
    """For every name that leads to one regulation: who names it, where, and its versions. Groups are left out."""
    by_id = build.corpus.by_id
    for entry in build.corpus.regulations:
        for kind, names in (("exception_to", entry.doc.exception_to), ("overrides", entry.doc.overrides)):
            for position, name in enumerate(names):
                if name.startswith(("tag:", "topic:")):
                    continue
                full = (f"{entry.section.id}-{name}", f"{entry.jurisdiction.code}-{name}", name)
                found = next((by_id[item] for item in full if item in by_id), ())
                if found:
                    yield entry, entry.place(kind, position), found
