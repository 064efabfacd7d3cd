"""`known(...)` asks for a fact that the vocabulary assumes a value of.

Why:
    An assumed value does not count as known, but every comparison with the fact uses it: one condition then reads the fact in two ways.

Fails:
    condition: {when: known(bicycle.passed) and children.present}

Passes:
    condition: {when: known(children.present) and children.present}
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb.condition import Known
from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build
from regdb_compiler.lint.view import spot, view_of

CODE, NAME = "R434", "known-of-assumed"
LEVEL: Level = "warning"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each such literal."""
    view = view_of(build)
    for rule in view.first:
        for key, node in (("when", rule.when), ("unless", rule.unless)):
            for literal in view.literals(node) if node is not None else ():
                if isinstance(literal, Known):
                    fact = view.fact(literal.fact)
                    if fact is not None and fact.assumption is not None:
                        message = f"`{fact.name}` is assumed {fact.show(fact.assumption.value)} while it is not known"
                        place = spot(rule.entry, key, fact.name)
                        yield Diagnostic(CODE, NAME, LEVEL, message, place, law=str(rule.entry.citation))
