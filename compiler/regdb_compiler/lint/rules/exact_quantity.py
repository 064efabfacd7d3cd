"""A measured quantity is compared by == or !=.

Why:
    A speed or distance that is measured is never exactly the number. Counts, times and dates may be equal.

Fails:
    condition: {when: school.distance == 500 ft}

Passes:
    condition: {when: school.distance <= 500 ft}
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb.condition import Compare, literal_facts
from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build
from regdb_compiler.lint.view import spot, view_of

CODE, NAME = "R315", "exact-quantity"
LEVEL: Level = "warning"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each such comparison; with zero it is a standstill, and allowed."""
    view = view_of(build)
    for rule in view.first:
        for key, node in (("when", rule.when), ("unless", rule.unless)):
            for literal in view.literals(node) if node is not None else ():
                if isinstance(literal, Compare) and literal.op in {"==", "!="} and literal.kind == "quantity" and _measured(literal):
                    fact = literal_facts(literal)[0]
                    message = f"`{fact}` is measured, so it is never exactly the number"
                    place = spot(rule.entry, key, fact)
                    yield Diagnostic(CODE, NAME, LEVEL, message, place, help="compare by <= or >=", law=str(rule.entry.citation))


def _measured(literal: Compare) -> bool:
    """Whether the fact is measured: the number on a sign is read, and a standstill is exact."""
    standstill = not literal.right.terms and literal.right.constant == 0
    facts = literal_facts(literal)
    return bool(facts) and not standstill and not any("posted" in fact for fact in facts)
