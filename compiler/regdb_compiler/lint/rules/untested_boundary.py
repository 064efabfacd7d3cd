"""A number of a limit or condition has no test near it on both sides.

Why:
    "Not exceeding 25" and "25 or more" differ by a hair, and only a test at the number tells which is meant. Near is within a tenth.

Fails:
    attributes: {max_speed: 25 mph}
    force: absolute
    tests:
      - {name: fast, scene: {children.present: true}, plan: {current: lane_following, next: lane_change, speed: 60 mph}, expect: illegal}
      - {name: slow, scene: {children.present: true}, plan: {current: lane_following, next: lane_change, speed: 5 mph}, expect: legal}

Passes:
    attributes: {max_speed: 25 mph}
    force: absolute
    tests:
      - {name: above, scene: {children.present: true}, plan: {current: lane_following, next: lane_change, speed: 26 mph}, expect: illegal}
      - {name: at it, scene: {children.present: true}, plan: {current: lane_following, next: lane_change, speed: 25 mph}, expect: legal}
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache

from regdb.condition import Compare
from regdb.regulation import Limit
from regdb.units import UnitError, parse_quantity
from regdb.vocabulary import show_value
from regdb_compiler.diagnostics import Diagnostic, Level, Place
from regdb_compiler.driver import Build
from regdb_compiler.entries import RegulationEntry
from regdb_compiler.lint.view import View, spot, view_of
from regdb_compiler.resolve import Resolved, constant_of

CODE, NAME = "R813", "untested-boundary"
LEVEL: Level = "info"
NEAR = 0.1
Boundary = tuple[str, float, Limit | Compare, str]
"""The fact, its number in SI, what the number stands in, and the key of that: `when`, `unless` or the attribute."""


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each number whose tests lie all on one side, or far away; regulations without tests are R811's."""
    view = view_of(build)
    for rule in view.first:
        entry = rule.entry
        if not entry.doc.tests:
            continue
        for fact, number, bound, where in _boundaries(view, rule):
            values = list(_values(entry, fact))
            room = max(abs(number) * NEAR, 1.0 if number == 0 or _is_count(view, fact) else 0.0) * (1 + 1e-9)
            low = any(number - room <= value < number for value in values)
            high = any(number < value <= number + room for value in values)
            at = any(abs(value - number) <= 1e-9 * max(1.0, abs(number)) for value in values)
            if (low + high + at) < 2:
                missing = "at" if not at else "just above or below"
                shown = bound.text if isinstance(bound, Limit) else show_value(number, bound.kind, bound.unit)
                message = f"no tests on both sides of {shown}: none {missing} it"
                yield Diagnostic(CODE, NAME, LEVEL, message, _place(entry, fact, where), law=str(entry.citation))


def _boundaries(view: View, rule: Resolved) -> Iterator[Boundary]:
    for limit in rule.limits:
        bound = constant_of(limit.bound)
        if bound is not None and rule.entry.doc.force not in {"advisory", "penalty_tier"}:
            yield limit.fact, bound, limit, limit.attribute
    for key, node in (("when", rule.when), ("unless", rule.unless)):
        for literal in view.literals(node) if node is not None else ():
            if isinstance(literal, Compare) and _is_bound(literal) and literal.left.terms[0][1] in _text(rule.entry, key):
                coefficient, fact = literal.left.terms[0]
                number = literal.right.constant / coefficient
                yield fact, number, literal, key


def _is_bound(literal: Compare) -> bool:
    """One fact against a number."""
    left = literal.left
    return literal.kind in {"quantity", "count"} and not literal.right.terms and len(left.terms) == 1 and not left.constant


def _text(entry: RegulationEntry, key: str) -> str:
    return str(getattr(entry.doc.condition, key))


def _is_count(view: View, name: str) -> bool:
    fact = view.fact(name)
    return fact is not None and fact.kind == "count"


def _values(entry: RegulationEntry, fact: str) -> Iterator[float]:
    short = fact.removeprefix("plan.")
    for test in entry.doc.tests:
        for told in (test.scene.get(fact), test.plan.get(fact), test.plan.get(short)):
            value = _si(told) if isinstance(told, str) and told[:1].isdigit() else None
            if value is not None:
                yield value


@lru_cache(maxsize=4096)
def _si(text: str) -> float | None:
    try:
        return parse_quantity(text).si
    except UnitError:
        return None


def _place(entry: RegulationEntry, fact: str, where: str) -> Place:
    return spot(entry, where, fact) if where in {"when", "unless"} else entry.place("attributes", where)
