"""How far plans break the duties of the law, or may, weightiest duty first, for the moment when nothing is lawful; many plans at once."""

from __future__ import annotations

import numpy as np

from regdb.condition import linear_value
from regdb.regulation import Regulation
from regdb.situation import Situation
from regdb_runtime.assessment.assessed import RANKS, UNLAWFUL, Violation
from regdb_runtime.assessment.judge import Group, Judged
from regdb_runtime.assessment.measured import PlanFacts
from regdb_runtime.assessment.settings import AssessmentSettings
from regdb_runtime.trajectory import Floats


def violations(judged: Judged, settings: AssessmentSettings, rank: int = UNLAWFUL) -> list[Violation]:
    """For each of k plans how far it breaks each duty, and last what no duty covers; compare as tuples, the least is chosen.

    With `rank` UNCERTAIN: how far it may break them, by the rules whose breach is unknown.

    As `planning.duties.violations`, over all stretches a plan crosses: a topic counts once, by the stretch where it is broken most. A speed
    counts by how far it is beyond its limit on average over the plan, so that of plans all too fast the one that slows down is the lesser evil;
    amounts count in steps of `breach_step`.
    """
    duties, step = settings.duties, settings.breach_step
    worst: dict[tuple[int, str], Floats] = {}
    for group in judged.groups:
        if RANKS[group.verdict.verdict] == rank:
            for rule in group.verdict.deciding:
                place = next((index for index, duty in enumerate(duties) if duty.covers(rule)), len(duties))
                found = worst.setdefault((place, rule.topic or rule.id), np.zeros(judged.facts.size))
                found[group.rows] = np.maximum(found[group.rows], np.ceil(_amount(rule, group, judged.facts) / step) * step)
    total = np.zeros((judged.facts.size, len(duties) + 1))
    for (place, _), found in worst.items():
        total[:, place] += found
    return [tuple(row) for row in total.tolist()]


def _amount(rule: Regulation, group: Group, facts: PlanFacts) -> Floats:
    """How far each plan of a group breaks one rule, (m,) or (1,) for all: the share of the bound by which it is beyond a limit, at most 1."""
    if not rule.limits:
        return np.ones(1)
    verdict = group.verdict
    situation = Situation(verdict.circumstances.vocabulary, verdict.scene, verdict.plan)
    found, names = np.zeros(len(group.rows)), facts.names(group.stretch)
    for limit in rule.limits:
        bound = linear_value(limit.bound, situation)
        if bound is None or limit.fact not in names:
            return np.ones(1)
        beyond = facts.beyond(group.stretch, limit.fact, group.rows, bound, limit.direction)
        found = np.fmax(found, np.fmin(beyond / max(abs(bound), 1e-9), 1.0))
    return found
