"""An exception or override never meets what it names: their states have no transition in common.

Why:
    A rule displaces another only at a transition that both speak of.

Fails:
    exception_to: [st-10-a]
    legality: true
    result: may change lanes
    states: {current: [lane_following], next: [lane_change]}

Passes:
    exception_to: [st-10-a]
    legality: true
    result: may turn right
    states: {current: [intersection_handling], next: [turn_right]}
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build
from regdb_compiler.lint.naming import named_targets
from regdb_compiler.resolve import Resolved

CODE, NAME = "R622", "exception-elsewhere"
LEVEL: Level = "error"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each name whose regulation shares no transition with the naming one."""
    by_entry = build.resolution.by_entry
    for name in named_targets(build):
        entry, targets = name.entry, name.targets
        ours = [rule for rule in by_entry.get(entry, ()) if rule.sound]
        theirs = [rule for target in targets for rule in by_entry.get(target, ()) if rule.sound]
        if ours and theirs and not any(_meet(ours[0], other) for other in theirs):
            message = f"{entry.id} and {targets[0].id} have no transition in common"
            related = ((targets[0].key_place("states"), "its states"),)
            yield Diagnostic(CODE, NAME, LEVEL, message, name.place, related=related, law=str(entry.citation))


def _meet(one: Resolved, other: Resolved) -> bool:
    return _share(one.current, other.current) and _share(one.next, other.next)


def _share(one: frozenset[str] | None, other: frozenset[str] | None) -> bool:
    return one is None or other is None or not one.isdisjoint(other)
