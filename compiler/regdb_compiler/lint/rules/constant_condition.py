"""A part of a condition is true or false whatever the scene: `x or not x`, `true`, an `or` of all cases.

Why:
    It decides nothing, or makes the whole condition decide nothing.

Fails:
    condition: {when: sign.school or not sign.school}

Passes:
    condition: {when: sign.school or children.present}
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb.condition import Const, Or
from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build
from regdb_compiler.lint.folding import contradiction, joins, negations
from regdb_compiler.lint.view import spot, view_of

CODE, NAME = "R433", "constant-condition"
LEVEL: Level = "warning"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each constant that is written, and for each `or` one of whose parts is always true."""
    view = view_of(build)
    for rule in view.first:
        doc = rule.entry.doc.condition
        for key, node, text in (("when", rule.when, doc.when), ("unless", rule.unless, doc.unless)):
            if node is None or not text:
                continue
            if any(isinstance(literal, Const) for literal in view.literals(node)):
                message = "a constant stands in the condition"
                yield Diagnostic(CODE, NAME, LEVEL, message, rule.entry.place("condition", key), law=str(rule.entry.citation))
            if " or " not in text:
                continue
            for join in joins(node):
                fact = contradiction(negations(join.parts), build.corpus.vocabulary) if isinstance(join, Or) else None
                if fact:
                    message = f"whatever `{fact}` is, one of these parts is true"
                    yield Diagnostic(CODE, NAME, LEVEL, message, spot(rule.entry, key, fact), law=str(rule.entry.citation))
