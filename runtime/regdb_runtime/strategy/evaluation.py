"""One candidate state from manoeuvre to report: stretches, caps, plans, limits, cost, law; the best plan and why the rest fell out."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from regdb.vocabulary import Value
from regdb_runtime.assessment.assessed import Assessed
from regdb_runtime.assessment.assessor import Assessor
from regdb_runtime.decision import CandidateReport, Rejection
from regdb_runtime.maneuver import Maneuver
from regdb_runtime.observation import TurnSignal
from regdb_runtime.planning.cost import CostTerms, MotionCosts, weigh
from regdb_runtime.planning.goal import SpeedCap, StopPoint
from regdb_runtime.planning.kinematic_limits import UNITS, Feasibility
from regdb_runtime.scenes.stretches import Scenes
from regdb_runtime.strategy.sampling import Moment, Sampler

LAWFUL, UNKNOWN, NO_PLAN = 0, 1, 3
"""Ranks of a candidate with a lawful plan, of one whose plans nobody can judge, and of one without any."""
LONG = 1000.0
"""Metres or seconds of signalling beyond what any law asks."""


@dataclass(frozen=True, eq=False)
class Evaluated:
    """A report with what the planner goes on with: the manoeuvre, the speed caps laid on it, and how bad the breach is if it is unlawful."""

    maneuver: Maneuver
    report: CandidateReport
    caps: tuple[SpeedCap, ...] = ()
    breach: tuple[float, ...] = ()


@dataclass(frozen=True, eq=False)
class Evaluator:
    """What every evaluation of a run shares."""

    scenes: Scenes
    assessor: Assessor
    sampler: Sampler

    def evaluate(self, maneuver: Maneuver, moment: Moment) -> Evaluated:
        """The best plan of a manoeuvre, with the law's verdict on it."""
        if maneuver.refused:
            return Evaluated(maneuver, _without_plan(maneuver, (Rejection(maneuver.refused),)))
        if maneuver.prepares is not None:
            prepared = self._evaluate(maneuver.prepares, moment, signalled=True)
            if prepared.report.rank != LAWFUL:
                reasons = (Rejection(f"prepares:{maneuver.prepares.next}"), *prepared.report.rejections)
                return Evaluated(maneuver, _without_plan(maneuver, reasons))
        found = self._evaluate(maneuver, moment)
        if maneuver.commits and maneuver.may_wait and found.report.rank == UNKNOWN:
            return self._evaluate(replace(maneuver, commits=False), moment)
        return found

    def _evaluate(self, maneuver: Maneuver, moment: Moment, signalled: bool = False) -> Evaluated:
        stretches = self.scenes.stretches(moment.observation, maneuver, moment.history)
        if signalled:
            stretches = tuple(replace(item, roles={**item.roles, **_signalled(maneuver.turn_signal)}) for item in stretches)
        caps = self.assessor.caps(maneuver, stretches)
        stop = _nearer(maneuver.goal.stop, self.assessor.halt(maneuver, stretches, moment.observation.ego.speed))
        maneuver = replace(maneuver, goal=replace(maneuver.goal, caps=(*maneuver.goal.caps, *caps), stop=stop))
        plans = self.sampler.plans(maneuver, moment)
        assessed = self.assessor.best(
            maneuver, stretches, plans.candidates, plans.order, plans.costs.weighted, moment.observation, moment.predictions,
            plans.feasible.ok, moment.sweeper,
        )  # fmt: skip
        rejections = (*_infeasible(plans.feasible), *assessed.rejections)
        if assessed.index is None:
            return Evaluated(maneuver, _without_plan(maneuver, rejections, len(plans.candidates)), caps)
        report = CandidateReport(
            maneuver.current, maneuver.next, assessed.rank, _cost(maneuver, plans.costs, assessed), assessed.verdict,
            plans.candidates.one(assessed.index), maneuver.turn_signal, len(stretches), len(plans.candidates), rejections,
        )  # fmt: skip
        return Evaluated(maneuver, report, caps, assessed.violation)


def failed(maneuver: Maneuver, error: Exception) -> Evaluated:
    """A candidate whose evaluation raised: it falls out, and says so."""
    reason = Rejection("error", because=f"{type(error).__name__}: {error}")
    return Evaluated(maneuver, _without_plan(maneuver, (reason,)))


def _cost(maneuver: Maneuver, costs: MotionCosts, assessed: Assessed) -> CostTerms:
    """The cost of the plan found, with what the strategist adds to its distance."""
    assert assessed.index is not None
    added = dict(maneuver.biases)
    if maneuver.credit is not None:
        added["credit"] = min(maneuver.credit - float(costs.distance[assessed.index]), 0.0)
    cost = weigh(costs, assessed.index, assessed.rank, sum(added.values()))
    return replace(cost, parts={**cost.parts, **added})


def _signalled(side: TurnSignal) -> dict[str, Value]:
    """The facts of history as they will be once a movement has been signalled for as long as any law asks."""
    return {"ego.turn_signal": side, "ego.signalled_distance": LONG, "ego.signalled_time": LONG}


def _without_plan(maneuver: Maneuver, rejections: Sequence[Rejection], sampled: int = 0) -> CandidateReport:
    return CandidateReport(
        maneuver.current, maneuver.next, NO_PLAN, None, None, None, maneuver.turn_signal, sampled=sampled, rejections=tuple(rejections)
    )  # fmt: skip


def _nearer(own: StopPoint | None, asked: StopPoint | None) -> StopPoint | None:
    """Of the manoeuvre's own stop and the law's the one that comes first."""
    if own is None or asked is None:
        return own or asked
    return asked if asked.station < own.station else own


def _infeasible(found: Feasibility) -> Iterator[Rejection]:
    """Which limit of the vehicle or of the goal plans fail, with the first one's number and its bound."""
    for reason, count in found.counts.items():
        if count:
            row = int(np.argmax(found.first_reason == reason))
            measured, bound = round(float(found.measured[row]), 6), round(float(found.bound[row]), 6)
            yield Rejection(f"limit:{reason}", measured, bound, UNITS.get(reason, ""), count, found.rules[row])
