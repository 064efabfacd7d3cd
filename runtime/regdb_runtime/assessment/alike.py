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


def distinctions(rules: Iterable[Regulation]) -> Distinctions:
    """Read them off the conditions and limits."""
    facts: set[str] = set()
    entangled: set[str] = set()
    compared: dict[str, dict[Linear, None]] = {}
    for rule in rules:
        facts.update(rule.facts)
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
    return Distinctions(frozenset(facts), {fact: tuple(found) for fact, found in compared.items()}, frozenset(entangled))


def _alone(side: Linear) -> str | None:
    """The fact, where a side of a comparison is that fact and nothing else."""
    return side.terms[0][1] if len(side.terms) == 1 and side.constant == 0 and side.terms[0][0] == 1 else None


def codes(wanted: Distinctions, facts: PlanFacts, stretch: int, situation: Situation) -> tuple[Codes, bool]:
    """One code a plan, (k,), equal where plans are alike; and whether codes mean the same for other plans measured against the same stretch.

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
    return found, lasting


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
