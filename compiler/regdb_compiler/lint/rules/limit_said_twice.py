"""A limit is also written as a condition on the same quantity.

Why:
    `max_speed: 25 mph` with `plan.speed > 25 mph` in `when` is broken by the same plans, but the limit is in force only once it
    is broken: no planner can see it beforehand.

Fails:
    condition: {when: plan.speed > 25 mph and children.present}
    attributes: {max_speed: 25 mph}
    force: absolute

Passes:
    condition: {when: children.present}
    attributes: {max_speed: 25 mph}
    force: absolute
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb.condition import Compare, literal_facts
from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build
from regdb_compiler.lint.view import spot, view_of

CODE, NAME = "R316", "limit-said-twice"
LEVEL: Level = "warning"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each limited quantity that the condition reads too."""
    view = view_of(build)
    for rule in view.first:
        if not rule.limits:
            continue
        limited = {limit.fact: limit for limit in rule.limits}
        for literal in view.literals(rule.when):
            facts = [fact for fact in literal_facts(literal) if fact in limited] if isinstance(literal, Compare) else []
            if facts:
                limit = limited[facts[0]]
                message = f"`{limit.attribute}` bounds `{facts[0]}`, and so does the condition"
                place = spot(rule.entry, "when", facts[0])
                yield Diagnostic(CODE, NAME, LEVEL, message, place, help="take it out of `when`", law=str(rule.entry.citation))
