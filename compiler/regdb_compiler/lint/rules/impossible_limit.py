"""A limit that no plan can keep, or that none can break: a highest value below zero, a least one above the highest.

Why:
    A sign or two numbers were swapped.

Fails:
    attributes: {max_speed: 25 mph, min_speed: 40 mph}
    force: absolute

Passes:
    attributes: {max_speed: 40 mph, min_speed: 25 mph}
    force: absolute
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb.regulation import Limit
from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build
from regdb_compiler.lint.view import view_of
from regdb_compiler.resolve import Resolved, constant_of

CODE, NAME = "R317", "impossible-limit"
LEVEL: Level = "error"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each bound below zero, and for each pair of bounds that leaves nothing between them."""
    for rule in view_of(build).first:
        for limit in rule.limits:
            bound = constant_of(limit.bound)
            if bound is not None and bound < 0:
                yield _finding(rule, limit, f"{limit.text} is below zero")
        for limit in rule.limits if len(rule.limits) > 1 else ():
            if limit.direction == "min" and (most := _most(rule, limit)) is not None:
                yield _finding(rule, limit, f"at least {limit.text} and at most {most.text} leaves nothing")


def _most(rule: Resolved, least: Limit) -> Limit | None:
    floor = constant_of(least.bound)
    for limit in rule.limits:
        roof = constant_of(limit.bound)
        if limit.direction == "max" and limit.fact == least.fact and floor is not None and roof is not None and roof < floor:
            return limit
    return None


def _finding(rule: Resolved, limit: Limit, message: str) -> Diagnostic:
    return Diagnostic(CODE, NAME, LEVEL, message, rule.entry.place("attributes", limit.attribute), law=str(rule.entry.citation))
