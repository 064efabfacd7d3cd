"""What a regulation displaces, speaks of and narrows itself to, with one written name left out."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace

from regdb.condition import And, Has, Is, Node, Not, OneOf, all_of
from regdb.regulation import Regulation
from regdb.states import StateMachine
from regdb_compiler.diagnostics import Place
from regdb_compiler.driver import Build
from regdb_compiler.entries import RegulationEntry

Lacking = tuple[str, Place, Regulation]
"""The change in words, its place, the changed row."""


def without_scope(scope: Node, part: Node | str) -> Node:
    """A scope without one of its parts: the part itself, or what asks for a fact of this name."""
    parts = scope.parts if isinstance(scope, And) else (scope,)
    return all_of(*(item for item in parts if item != part and _fact(item) != part))


def _fact(node: Node) -> str:
    literal = node.part if isinstance(node, Not) else node
    return literal.fact if isinstance(literal, (Is, OneOf, Has)) else ""


def target_changes(build: Build, entry: RegulationEntry, row: Regulation) -> Iterator[Lacking]:
    """The row without one written exception or override; what another written name still reaches stays displaced."""
    written = [(kind, position, name) for kind in ("exception_to", "overrides") for position, name in enumerate(getattr(entry.doc, kind))]
    reached = {(kind, position): frozenset(_reached(build, name, row)) for kind, position, name in written}
    for kind, position, name in written:
        others = frozenset().union(*(ids for key, ids in reached.items() if key != (kind, position)))
        gone = reached[kind, position] - others
        left = tuple(target for target in row.targets if target not in gone)
        kept = tuple(target for target in row.overrides if target not in gone)
        what = f"no longer {'an exception to' if kind == 'exception_to' else 'overrides'} {name}"
        yield what, entry.place(kind, position), replace(row, targets=left, overrides=kept)


def _reached(build: Build, name: str, row: Regulation) -> Iterator[str]:
    group, _, word = name.partition(":")
    for target in row.targets:
        if group in {"tag", "topic"} and word:
            others = build.corpus.by_id.get(target, ())
            if any(word in other.doc.tags if group == "tag" else word == other.topic for other in others):
                yield target
        elif target == name or target.endswith(f"-{name}"):
            yield target


def state_changes(machine: StateMachine, entry: RegulationEntry, row: Regulation) -> Iterator[Lacking]:
    """The row without one written state; the only one left out means every transition."""
    for role in ("current", "next"):
        names = getattr(entry.doc.states, role)
        for position, name in enumerate(names):
            rest = [other for other in names if other != name]
            left = frozenset(state for other in rest for state in machine.expand(other)) or None
            what = f"states.{role} without {name}" + ("" if rest else ", so any state")
            changed = replace(row, current=left) if role == "current" else replace(row, next=left)
            yield what, entry.place("states", role, position), changed


def transitions(machine: StateMachine, row: Regulation) -> frozenset[tuple[str, str]]:
    """Those of the machine's transitions that a row speaks of."""
    pairs: Iterable[tuple[str, str]] = ((state.id, other) for state in machine.states.values() for other in state.next)
    return frozenset(pair for pair in pairs if row.concerns(*pair))
