"""Every part of an `or` is negated.

Why:
    "No sign A or sign B" is `not a and not b`. An `or` of negations holds as soon as one of them is absent, which is nearly always; with
    two values of one enumeration it holds always. It is the commonest slip in encoded traffic law.

Fails:
    condition: {when: not sign.school or not children.present}

Passes:
    condition: {when: not sign.school and not children.present}
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb.condition import Not, Or
from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build
from regdb_compiler.lint.folding import joins
from regdb_compiler.lint.view import spot, view_of

CODE, NAME = "R444", "or-of-negations"
LEVEL: Level = "warning"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each such `or`."""
    view = view_of(build)
    for rule in view.first:
        doc = rule.entry.doc.condition
        for key, node, text in (("when", rule.when, doc.when), ("unless", rule.unless, doc.unless)):
            if node is None or " or " not in text or ("not " not in text and "!=" not in text):
                continue
            for join in joins(node):
                if isinstance(join, Or) and all(isinstance(part, Not) for part in join.parts):
                    fact = next(iter(view.facts(join)), "")
                    message = "this `or` holds as soon as one of its parts is absent"
                    help_ = "if none of them may be there, join them by `and`"
                    yield Diagnostic(CODE, NAME, LEVEL, message, spot(rule.entry, key, fact), help=help_, law=str(rule.entry.citation))
