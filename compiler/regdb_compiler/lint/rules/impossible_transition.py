"""The states of a regulation make no transition that the state machine has.

Why:
    Such a regulation never applies. Often the super-state was left out and the short name means another state.

Fails:
    states: {current: [lane_change], next: [turn_right]}

Passes:
    states: {current: [lane_following], next: [lane_change]}
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build
from regdb_compiler.lint.view import view_of

CODE, NAME = "R431", "impossible-transition"
LEVEL: Level = "error"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each regulation whose current states lead to none of its next states."""
    machine = build.corpus.machine
    known: dict[tuple[frozenset[str], frozenset[str]], bool] = {}
    for rule in view_of(build).first:
        if rule.current is None or rule.next is None:
            continue
        pair = (rule.current, rule.next)
        if pair not in known:
            known[pair] = any(state in pair[1] for name in pair[0] for state in machine.states[name].next)
        if not known[pair]:
            entry = rule.entry
            message = "no transition of the state machine leads from one of these states to one of those"
            yield Diagnostic(CODE, NAME, LEVEL, message, entry.key_place("states"), help="see `regdb show states`", law=str(entry.citation))
