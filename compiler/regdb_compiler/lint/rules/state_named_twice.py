"""A list of states names a state that another word in it stands for already.

Why:
    A super-state's name stands for all its states; the second word says nothing, or another was meant.

Fails:
    states: {current: [lane_following, lane_following.lane_change], next: [lane_change]}

Passes:
    states: {current: [lane_following], next: [lane_change]}

Fix (safe):
    Takes the narrower word out, unless it stands first.
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Fix, Level
from regdb_compiler.driver import Build
from regdb_compiler.entries import RegulationEntry
from regdb_compiler.lint.edits import delete_item
from regdb_compiler.lint.view import view_of
from regdb_compiler.source import Sequence

CODE, NAME = "R447", "state-named-twice"
LEVEL: Level = "info"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each word whose states another word of the list has too."""
    machine = build.corpus.machine
    known: dict[tuple[str, ...], list[tuple[int, str]]] = {}
    for rule in view_of(build).first:
        states = rule.entry.doc.states
        for role, names in (("current", states.current), ("next", states.next)):
            if len(names) < 2:
                continue
            if names not in known:
                known[names] = _covered({name: frozenset(machine.expand(name)) for name in names}, names)
            for position, wider in known[names]:
                yield _finding(rule.entry, role, position, names[position], wider)


def _covered(sets: dict[str, frozenset[str]], names: tuple[str, ...]) -> list[tuple[int, str]]:
    """Positions of the words that another covers; of equal ones the later."""
    found = []
    for position, name in enumerate(names):
        for other_position, other in enumerate(names):
            narrower = sets[name] < sets[other] or (sets[name] == sets[other] and other_position < position)
            if other_position != position and narrower:
                found.append((position, other))
                break
    return found


def _finding(entry: RegulationEntry, role: str, position: int, name: str, wider: str) -> Diagnostic:
    node = entry.field("states", role)
    edit = delete_item(node, position) if isinstance(node, Sequence) else None
    fix = Fix("safe", f"take `{name}` out", (edit,)) if edit else None
    message = f"`{wider}` stands for `{name}` already"
    return Diagnostic(CODE, NAME, LEVEL, message, entry.place("states", role, position), law=str(entry.citation), fix=fix)
