"""Plans that the law cannot tell apart: those that agree in every truth and word and lie between the same bounds of every number.

Exact: a rule sees a plan only through its literals and limits, so plans with equal codes have equal verdicts, deciding rules and limits.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from regdb.condition import Compare, Linear, linear_value, literal_facts, literals
from regdb.regulation import Regulation
from regdb.situation import Situation
from regdb_runtime.assessment.measured import Column, PlanFacts

Codes = NDArray[np.int64]
_LIMIT = 2**62


@dataclass(frozen=True, eq=False)
class Distinctions:
    """What a set of rules distinguishes: the facts it reads, what each number is compared with, and numbers it reads in other ways too."""

    facts: frozenset[str]
    compared: Mapping[str, tuple[Linear, ...]]
    entangled: frozenset[str]


class Distinguished:
    """What rules distinguish, read off each rule once; the rules are kept as long as this is."""

    def __init__(self) -> None:
        self._rules: dict[int, tuple[Regulation, Distinctions]] = {}
        self._sets: dict[int, tuple[tuple[Regulation, ...], Distinctions]] = {}

    def of(self, rules: tuple[Regulation, ...]) -> Distinctions:
        """What a set of rules distinguishes, remembered by the tuple's identity."""
        held = self._sets.get(id(rules))
        if held is None or held[0] is not rules:
            held = self._sets[id(rules)] = rules, self._together(rules)
        return held[1]

    def facts(self, rule: Regulation) -> frozenset[str]:
        """The facts one rule reads."""
        return self._of_rule(rule).facts

    def _of_rule(self, rule: Regulation) -> Distinctions:
        held = self._rules.get(id(rule))
        if held is None or held[0] is not rule:
            held = self._rules[id(rule)] = rule, distinctions(rule)
        return held[1]

    def _together(self, rules: Iterable[Regulation]) -> Distinctions:
        compared: dict[str, dict[Linear, None]] = {}
        found = [self._of_rule(rule) for rule in rules]
        for item in found:
            for fact, bounds in item.compared.items():
                compared.setdefault(fact, {}).update(dict.fromkeys(bounds))
        facts, entangled = (frozenset[str]().union(*sets) for sets in ([item.facts for item in found], [item.entangled for item in found]))
        return Distinctions(facts, {fact: tuple(bounds) for fact, bounds in compared.items()}, entangled)


def distinctions(rule: Regulation) -> Distinctions:
    """Read off one rule's conditions and limits."""
    entangled: set[str] = set()
    compared: dict[str, dict[Linear, None]] = {}
    for limit in rule.limits:
        compared.setdefault(limit.fact, {})[limit.bound] = None
    for condition in (rule.when, rule.unless):
        for literal in literals(condition) if condition is not None else ():
            if not isinstance(literal, Compare):
                continue
            left = _alone(literal.left)
            if left is None:
                entangled.update(literal_facts(literal))
            else:
                compared.setdefault(left, {})[literal.right] = None
                entangled.update(fact for _, fact in literal.right.terms)
    return Distinctions(frozenset(rule.facts), {fact: tuple(found) for fact, found in compared.items()}, frozenset(entangled))


def _alone(side: Linear) -> str | None:
    """The fact, where a side of a comparison is that fact and nothing else."""
    return side.terms[0][1] if len(side.terms) == 1 and side.constant == 0 and side.terms[0][0] == 1 else None


def codes(wanted: Distinctions, facts: PlanFacts, stretch: int, situation: Situation) -> tuple[Codes, tuple[str, ...] | None]:
    """One code a plan, (k,), equal where plans are alike; and the facts in them: with the same facts, codes mean the same for other plans measured
    against the same stretch. None where they mean nothing beyond these plans.

    `situation`: the scene with the facts that all plans share; what numbers are compared with is read from it.
    """
    names = [name for name in facts.names(stretch) if name in wanted.facts]
    found, size, lasting = np.zeros(facts.size, dtype=np.int64), 1, True
    for name in names:
        column = facts.column(stretch, name)
        places, count, stable = _places(wanted, name, column, names, situation)
        if size > _LIMIT // count:
            found, size, lasting = np.unique(found, return_inverse=True)[1].astype(np.int64), facts.size, False
        found, size, lasting = found * count + places, size * count, lasting and stable
    return found, tuple(names) if lasting else None


def _places(wanted: Distinctions, name: str, column: Column, names: list[str], situation: Situation) -> tuple[Codes, int, bool]:
    """Places of one fact's values among what can be told apart, how many there are, and whether they last."""
    if not column.is_number:
        if column.values.dtype.kind == "b":
            return column.values.astype(np.int64), 2, True
        return column.values.astype(np.int64) + 1, len(column.words) + 1, True
    bounds = wanted.compared.get(name, ())
    if name in wanted.entangled or any(fact in names for bound in bounds for _, fact in bound.terms):
        found = np.unique(column.values, return_inverse=True)[1].astype(np.int64)
        return found, len(found) + 1, False
    numbers = np.array(sorted({number for bound in bounds if (number := linear_value(bound, situation)) is not None}))
    places = np.searchsorted(numbers, column.values, "left") + np.searchsorted(numbers, column.values, "right")
    return np.where(np.isnan(column.values), 2 * len(numbers) + 1, places).astype(np.int64), 2 * len(numbers) + 2, True
