"""A condition lists every value of an enumeration, so it asks for nothing.

Why:
    It is true whenever the fact is known, and unknown otherwise: then the verdict is unknown for no reason.

Fails:
    condition: {when: "ego.vehicle_class in {car, truck, bus} and children.present"}

Passes:
    condition: {when: "ego.vehicle_class in {car, truck} and children.present"}
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb.condition import OneOf
from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build
from regdb_compiler.lint.view import spot, view_of

CODE, NAME = "R432", "every-value-listed"
LEVEL: Level = "warning"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each such list."""
    view = view_of(build)
    for rule in view.first:
        for key, node in (("when", rule.when), ("unless", rule.unless)):
            for literal in view.literals(node) if node is not None else ():
                if isinstance(literal, OneOf) and len(literal.words) > 1:
                    fact = view.fact(literal.fact)
                    if fact is not None and len(literal.words) == len(fact.values):
                        message = f"these are all the values `{literal.fact}` can have"
                        place = spot(rule.entry, key, literal.fact)
                        yield Diagnostic(CODE, NAME, LEVEL, message, place, help="leave it out", law=str(rule.entry.citation))
