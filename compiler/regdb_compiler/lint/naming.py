"""Which regulations every written exception and override names, with the place of the name."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from regdb_compiler.diagnostics import Place
from regdb_compiler.driver import Build
from regdb_compiler.entries import RegulationEntry


@dataclass(frozen=True, slots=True)
class Named:
    """A name under `exception_to` or `overrides`: who names, which of the two, at which position, and the versions it leads to."""

    entry: RegulationEntry
    kind: str
    position: int
    targets: tuple[RegulationEntry, ...]

    @property
    def place(self) -> Place:
        return self.entry.place(self.kind, self.position)


def named_targets(build: Build) -> tuple[Named, ...]:
    """Every name that leads to one regulation. Groups are left out. Worked out once for a build, and kept with it."""
    held = build.__dict__.get("lint_named")
    if not isinstance(held, tuple):
        held = build.__dict__["lint_named"] = tuple(_named(build))
    return held


def _named(build: Build) -> Iterator[Named]:
    by_id = build.corpus.by_id
    for entry in build.corpus.regulations:
        for kind, names in (("exception_to", entry.doc.exception_to), ("overrides", entry.doc.overrides)):
            for position, name in enumerate(names):
                if not name.startswith(("tag:", "topic:")):
                    full = (f"{entry.section.id}-{name}", f"{entry.jurisdiction.code}-{name}", name)
                    found = next((by_id[item] for item in full if item in by_id), ())
                    if found:
                        yield Named(entry, kind, position, found)
