"""`unless` names what `when` asks for, so the regulation never holds.

Why:
    Whenever the condition is true, so is the exception to it.

Fails:
    condition: {when: children.present and sign.school, unless: sign.school}

Passes:
    condition: {when: children.present, unless: sign.school}
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb.condition import And, Or, literal_facts, literals
from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build
from regdb_compiler.lint.view import spot, view_of

CODE, NAME = "R445", "unless-cancels-when"
LEVEL: Level = "error"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each regulation one of whose parts of `unless` is a part of `when`."""
    for rule in view_of(build).first:
        if rule.unless is None:
            continue
        wanted = set(rule.when.parts) if isinstance(rule.when, And) else {rule.when}
        excused = rule.unless.parts if isinstance(rule.unless, Or) else (rule.unless,)
        both = next((part for part in excused if part in wanted), None)
        if both is not None:
            fact = next((name for literal in literals(both) for name in literal_facts(literal)), "")
            place = spot(rule.entry, "unless", fact)
            message = "`when` asks for this, so the regulation never holds"
            related = ((spot(rule.entry, "when", fact), "asked for here"),)
            yield Diagnostic(CODE, NAME, LEVEL, message, place, related=related, law=str(rule.entry.citation))
