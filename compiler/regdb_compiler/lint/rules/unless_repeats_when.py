"""`unless` excludes what `when` excludes already.

Why:
    What `when` rules out cannot be excused again. Either one is left over or one of the two names the wrong fact.

Fails:
    condition: {when: children.present and not sign.school, unless: sign.school or signal.flashing}

Passes:
    condition: {when: children.present, unless: sign.school or signal.flashing}
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb.condition import And, Not, Or, literal_facts, literals
from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build
from regdb_compiler.lint.view import spot, view_of

CODE, NAME = "R446", "unless-repeats-when"
LEVEL: Level = "warning"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each part of `unless` whose negation is a part of `when`."""
    for rule in view_of(build).first:
        if rule.unless is None:
            continue
        wanted = rule.when.parts if isinstance(rule.when, And) else (rule.when,)
        excluded = {part.part for part in wanted if isinstance(part, Not)}
        for part in rule.unless.parts if isinstance(rule.unless, Or) else (rule.unless,):
            if part in excluded:
                fact = next((name for literal in literals(part) for name in literal_facts(literal)), "")
                message = "`when` excludes this already"
                related = ((spot(rule.entry, "when", fact), "excluded here"),)
                place = spot(rule.entry, "unless", fact)
                yield Diagnostic(CODE, NAME, LEVEL, message, place, related=related, law=str(rule.entry.citation))
