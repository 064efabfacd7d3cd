"""A permission rests on a fact that is assumed to be so while nothing is known of it.

Why:
    A permission counts only when it is known to hold. Where the vocabulary assumes the very value that the permission asks for, silence of
    the sensors makes a prohibition vanish.

Fails:
    exception_to: [st-10-a]
    legality: true
    result: may turn right
    condition: {when: weather.dry}

Passes:
    exception_to: [st-10-a]
    legality: true
    result: may turn right
    condition: {when: ego.stopped_at_line}
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb.condition import And, Is, Node, Not, OneOf
from regdb.vocabulary import Fact
from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build
from regdb_compiler.lint.view import spot, view_of

CODE, NAME = "R440", "permission-by-assumption"
LEVEL: Level = "warning"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each part of a permission's `when` that an assumption alone makes true; what the plan says of itself is let be."""
    view = view_of(build)
    for rule in view.first:
        if not rule.entry.doc.legality:
            continue
        for part in rule.when.parts if isinstance(rule.when, And) else (rule.when,):
            fact = view.fact(part.fact) if isinstance(part, (Is, OneOf)) else None
            if fact is not None and fact.source != "plan" and _assumed_true(part, fact):
                message = f"`{fact.name}` is assumed while it is not known, and that alone permits"
                place = spot(rule.entry, "when", fact.name)
                help_ = f"ask for `known({fact.name})` too, or declare the fact strict"
                yield Diagnostic(CODE, NAME, LEVEL, message, place, help=help_, law=str(rule.entry.citation))


def _assumed_true(part: Node, fact: Fact) -> bool:
    if fact.assumption is None or isinstance(part, Not):
        return False
    value = fact.assumption.value
    return value is True if isinstance(part, Is) else isinstance(part, OneOf) and value in part.words
