"""A condition reads facts of the plan only, but the regulation names no states.

Why:
    The plan's facts are told for the transition in question. Without states the rule is judged at every transition of every plan,
    and is unknown wherever the plan is silent.

Fails:
    condition: {when: plan.enters_intersection}
    states: null

Passes:
    condition: {when: plan.enters_intersection}
    states: {current: [intersection_handling]}
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build
from regdb_compiler.lint.view import spot, view_of

CODE, NAME = "R437", "manoeuvre-without-states"
LEVEL: Level = "info"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each regulation without limits, all of whose facts are of the plan and have no assumed value."""
    view = view_of(build)
    for rule in view.first:
        if rule.limits or rule.current is not None or rule.next is not None or rule.entry.doc.legality:
            continue
        facts = [fact for name in view.facts(rule.when) if (fact := view.fact(name)) is not None]
        if facts and all(fact.source == "plan" and fact.assumption is None for fact in facts):
            place = spot(rule.entry, "when", facts[0].name)
            message = "this asks about a manoeuvre, but no states say which"
            yield Diagnostic(CODE, NAME, LEVEL, message, place, help="add `states:`", law=str(rule.entry.citation))
