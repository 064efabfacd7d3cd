"""Named conditions: which tree a name stands for, in a jurisdiction, on a day."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

from regdb.condition import TRUE, Node
from regdb.jurisdiction import Jurisdiction
from regdb_compiler import documents
from regdb_compiler.corpus import Corpus
from regdb_compiler.diagnostics import Diagnostic
from regdb_compiler.entries import VersionEntry
from regdb_compiler.parse_condition import parse_condition

MAX_DEPTH = 8
"""Steps over which definitions may name each other, so that their trees stay within what every reader can walk."""

DEFINITION_RULES = (
    ("R406", "definition-cycle", "Definitions that name each other in a circle mean nothing."),
    ("R407", "duplicate-definition", "Two definitions of one name are in force in one jurisdiction at the same time."),
    ("R408", "definition-hides-fact", "A definition has the name of a fact, so that a condition could mean either."),
)


@dataclass(frozen=True, eq=False)
class DefinitionEntry:
    """One definition in its version; `position` is its place in the version's list."""

    doc: documents.Definition
    version: VersionEntry
    position: int

    def in_force(self, day: int) -> bool:
        version = self.version
        return version.effective <= day and (version.until is None or day < version.until)


@dataclass
class DefinitionTable:
    """Definitions by jurisdiction and name; trees are typed when first asked for."""

    corpus: Corpus
    entries: dict[tuple[str, str], list[DefinitionEntry]] = field(default_factory=dict)
    problems: list[Diagnostic] = field(default_factory=list)
    broken: set[str] = field(default_factory=set)
    _trees: dict[DefinitionEntry, Node | None] = field(default_factory=dict)
    _open: list[DefinitionEntry] = field(default_factory=list)

    def find(self, name: str, jurisdiction: Jurisdiction, day: int) -> DefinitionEntry | None:
        """The nearest definition from the jurisdiction upwards that is in force on the day."""
        for owner in reversed(self.corpus.tree.path(jurisdiction.id)):
            for entry in self.entries.get((owner.id, name), ()):
                if entry.in_force(day):
                    return entry
        return None

    def tree(self, name: str, jurisdiction: Jurisdiction, day: int) -> Node | None:
        """What the name stands for, None when nothing of that name is in force.

        A definition that cannot be read stands as `true`, so that only its own problem is told; its name is in `broken`.
        """
        entry = self.find(name, jurisdiction, day)
        if entry is None:
            return None
        found = self._tree_of(entry, day)
        if found is None:
            self.broken.add(name)
        return found or TRUE

    def _tree_of(self, entry: DefinitionEntry, day: int) -> Node | None:
        if entry in self._trees:
            return self._trees[entry]
        place = entry.version.place("definitions", entry.position, "name")
        if len(self._open) >= MAX_DEPTH:
            message = f"definitions name each other over more than {MAX_DEPTH} steps"
            self.problems.append(Diagnostic("R406", "definition-cycle", "error", message, place))
            return None
        if entry in self._open:
            circle = " -> ".join([*(item.doc.name for item in self._open[self._open.index(entry) :]), entry.doc.name])
            self.problems.append(Diagnostic("R406", "definition-cycle", "error", f"definitions form a circle: {circle}", place))
            return None
        self._open.append(entry)
        owner = entry.version.section.jurisdiction
        parsed = parse_condition(entry.doc.when, self.corpus.vocabulary, lambda name: self.tree(name, owner, day))
        self._open.pop()
        broken = any(name in self.broken for name in parsed.uses)
        self._trees[entry] = None if broken else parsed.node
        for problem in parsed.problems:
            where = entry.version.text_place(problem.start, problem.end, "definitions", entry.position, "when")
            self.problems.append(Diagnostic(problem.code, problem.name, "error", problem.message, where, note=problem.note))
        return self._trees[entry]

    def changes(self, names: Iterable[str], jurisdiction: Jurisdiction, start: int, until: int | None) -> int | None:
        """The first day after `start` (before `until`) on which one of the names changes its meaning."""
        days: set[int] = set()
        for name in names:
            for owner in self.corpus.tree.path(jurisdiction.id):
                for entry in self.entries.get((owner.id, name), ()):
                    days.update(day for day in (entry.version.effective, entry.version.until) if day is not None)
        later = [day for day in days if start < day and (until is None or day < until)]
        return min(later) if later else None


def read_definitions(corpus: Corpus) -> tuple[DefinitionTable, list[Diagnostic]]:
    """Every definition, each typed once; problems are collected in the table."""
    table = DefinitionTable(corpus)
    for version in corpus.versions:
        for position, doc in enumerate(version.doc.definitions):
            _add(table, DefinitionEntry(doc, version, position))
    for entries in table.entries.values():
        for entry in entries:
            table.tree(entry.doc.name, entry.version.section.jurisdiction, entry.version.effective)
    return table, table.problems


def _add(table: DefinitionTable, entry: DefinitionEntry) -> None:
    name, version = entry.doc.name, entry.version
    place = version.place("definitions", entry.position, "name")
    if name in table.corpus.vocabulary:
        message = f"definition `{name}` has the name of a fact"
        table.problems.append(Diagnostic("R408", "definition-hides-fact", "error", message, place))
    held = table.entries.setdefault((version.section.jurisdiction.id, name), [])
    for other in held:
        if other.in_force(version.effective) or entry.in_force(other.version.effective):
            related = ((other.version.place("definitions", other.position, "name"), "and here"),)
            message = f"`{name}` is defined twice at the same time"
            table.problems.append(Diagnostic("R407", "duplicate-definition", "error", message, place, related=related))
    held.append(entry)
