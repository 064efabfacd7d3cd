"""How bad it is to break the law where nothing is lawful: graver topics first, then how many rules, then how far and long beyond a limit."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from regdb.condition import linear_value
from regdb.regulation import Regulation
from regdb.situation import Situation
from regdb_runtime.assessment.assessed import RANKS, UNLAWFUL, Violation
from regdb_runtime.assessment.judge import Group, Judged
from regdb_runtime.assessment.measured import PlanFacts
from regdb_runtime.assessment.settings import AssessmentSettings
from regdb_runtime.trajectory import Floats


class Gravity:
    """The declared priority: the gravest topic has place 0, those not named come last."""

    def __init__(self, settings: AssessmentSettings) -> None:
        self._places: Mapping[str, int] = {topic: place for place, topic in enumerate(settings.least_violation)}

    def place(self, rule: Regulation) -> int:
        """Place of a rule's topic; smaller is graver."""
        return self._places.get(rule.topic, len(self._places))

    def violations(self, judged: Judged) -> list[Violation]:
        """What each plan breaks over all stretches it crosses, k of them."""
        size = judged.facts.size
        places, shares = np.full(size, np.inf), np.zeros(size)
        broken: list[set[str]] = [set() for _ in range(size)]
        for group in judged.groups:
            if RANKS[group.verdict.verdict] == UNLAWFUL:
                rows, rules = group.rows, group.verdict.deciding
                places[rows] = np.minimum(places[rows], min(map(self.place, rules)))
                shares[rows] = np.maximum(shares[rows], _excess(group, judged.facts))
                for row in rows.tolist():
                    broken[row].update(rule.id for rule in rules)
        return [(-place, len(rules), share) for place, rules, share in zip(places.tolist(), broken, shares.tolist(), strict=True)]


def _excess(group: Group, facts: PlanFacts) -> Floats:
    """How far beyond the broken limits each plan of a group is, as a share of the bound; the greatest of several, (m,)."""
    verdict = group.verdict
    situation = Situation(verdict.circumstances.vocabulary, verdict.scene, verdict.plan)
    found, names = np.zeros(len(group.rows)), facts.names(group.stretch)
    for limit in (limit for rule in verdict.deciding for limit in rule.limits):
        bound = linear_value(limit.bound, situation)
        if bound is not None and limit.fact in names:
            beyond = facts.beyond(group.stretch, limit.fact, group.rows, bound, limit.direction)
            found = np.maximum(found, np.nan_to_num(beyond) / max(abs(bound), 1e-3))
    return found
