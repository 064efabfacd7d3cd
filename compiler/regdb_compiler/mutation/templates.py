"""Conditions with the definitions they name left as names, so that a definition is changed where it is written, once."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from regdb.condition import TRUE, And, Is, Node, Not, Or, all_of, literals
from regdb.jurisdiction import Jurisdiction
from regdb_compiler.definitions import DefinitionEntry
from regdb_compiler.driver import Build
from regdb_compiler.parse_condition import parse_condition
from regdb_compiler.resolve import Resolved

Replaced = Mapping[DefinitionEntry, Node]
"""Definitions that stand for another tree."""


@dataclass
class Templates:
    """The trees of regulations and definitions as written; a name that is no fact stands as `Is(name)`."""

    build: Build
    _trees: dict[DefinitionEntry, Node] = field(default_factory=dict)

    def read(self, text: str, jurisdiction: Jurisdiction, day: int) -> Node:
        """A condition as written; `true` for none. What cannot be read is told by the driver, not here."""
        table = self.build.resolution.definitions

        def name_alone(name: str) -> Node | None:
            return Is(name) if table.find(name, jurisdiction, day) is not None else None

        return TRUE if not text else parse_condition(text, self.build.corpus.vocabulary, name_alone).node or TRUE

    def of_definition(self, entry: DefinitionEntry) -> Node:
        """The tree of a definition."""
        if entry not in self._trees:
            self._trees[entry] = self.read(entry.doc.when, entry.version.section.jurisdiction, entry.version.effective)
        return self._trees[entry]

    def expand(self, node: Node, jurisdiction: Jurisdiction, day: int, replaced: Replaced | None = None) -> Node:
        """The tree with every name led to what it stands for."""
        replaced = replaced or {}
        match node:
            case And(parts):
                return all_of(*(self.expand(part, jurisdiction, day, replaced) for part in parts))
            case Or(parts):
                return Or(tuple(self.expand(part, jurisdiction, day, replaced) for part in parts))
            case Not(part):
                return Not(self.expand(part, jurisdiction, day, replaced))
            case Is(name) if name not in self.build.corpus.vocabulary:
                entry = self.build.resolution.definitions.find(name, jurisdiction, day)
                if entry is None:
                    return node
                tree = replaced.get(entry) or self.of_definition(entry)
                return self.expand(tree, entry.version.section.jurisdiction, day, replaced)
        return node

    def when(self, rule: Resolved, written: Node, scope: Node | None = None, replaced: Replaced | None = None) -> Node:
        """The condition of a row whose `when` is `written`, with its scope and what its authority adds."""
        own = rule.scope if scope is None else scope
        expanded = self.expand(written, rule.entry.jurisdiction, rule.effective, replaced)
        return all_of(own, self.build.authority.added_condition(rule), expanded)

    def uses(self, rule: Resolved) -> set[DefinitionEntry]:
        """Every definition that the rule rests on, over any number of steps."""
        found: set[DefinitionEntry] = set()
        queue = [(name, rule.entry.jurisdiction) for name in rule.uses]
        while queue:
            name, jurisdiction = queue.pop()
            entry = self.build.resolution.definitions.find(name, jurisdiction, rule.effective)
            if entry is not None and entry not in found:
                found.add(entry)
                queue += [(inner, entry.version.section.jurisdiction) for inner in self._names(self.of_definition(entry))]
        return found

    def _names(self, node: Node) -> Iterator[str]:
        for literal in literals(node):
            if isinstance(literal, Is) and literal.fact not in self.build.corpus.vocabulary:
                yield literal.fact
