"""Two parts of an `and` exclude each other, so the condition is never true.

Why:
    A prohibition with such a condition forbids nothing; in `unless` it excuses nothing. Two words of one enumeration want `or`.

Fails:
    condition: {when: signal.color == red and signal.color == yellow}

Passes:
    condition: {when: "signal.color in {red, yellow}"}
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb.condition import And
from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build
from regdb_compiler.lint.folding import contradiction, joins
from regdb_compiler.lint.view import spot, view_of

CODE, NAME = "R439", "contradictory-literals"
LEVEL: Level = "error"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each such `and`; scope attributes count as parts of `when`."""
    view = view_of(build)
    seen: dict[int, str | None] = {}
    for rule in view.first:
        for key, node in (("when", rule.when), ("unless", rule.unless)):
            if node is None or len(set(view.facts(node))) == len(view.literals(node)):
                continue  # two literals that exclude each other speak of one fact
            if id(node) not in seen:
                parts = (contradiction(j.parts, build.corpus.vocabulary) for j in joins(node) if isinstance(j, And))
                seen[id(node)] = next((fact for fact in parts if fact), None)
            fact = seen[id(node)]
            if fact:
                message = f"`{fact}` cannot be all this at once, so the condition is never true"
                yield Diagnostic(CODE, NAME, LEVEL, message, spot(rule.entry, key, fact), law=str(rule.entry.citation))
