"""One candidate state from manoeuvre to report: stretches, caps, plans, limits, cost, law; the best plan and why the rest fell out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from regdb.vocabulary import Value
from regdb_runtime.assessment.assessor import Assessor
from regdb_runtime.decision import CandidateReport, Rejection
from regdb_runtime.maneuver import Maneuver
from regdb_runtime.observation import EgoState, Footprint, Observation, TurnSignal
from regdb_runtime.planning.contacts import Sweeper
from regdb_runtime.planning.cost import MotionCosts, motion_cost, weigh
from regdb_runtime.planning.cost_settings import CostSettings
from regdb_runtime.planning.goal import Goal, SpeedCap
from regdb_runtime.planning.kinematic_limits import check
from regdb_runtime.planning.lattice import sample
from regdb_runtime.planning.prediction import Predictions
from regdb_runtime.planning.settings import LatticeSettings, VehicleLimits
from regdb_runtime.planning.users_along_path import users_along
from regdb_runtime.scenes.history import History
from regdb_runtime.scenes.stretches import Scenes
from regdb_runtime.trajectory import Candidates

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
    footprint: Footprint
    lattice: LatticeSettings
    limits: VehicleLimits
    comfortable: VehicleLimits
    beyond_comfort: float
    cost: CostSettings

    def evaluate(
        self, maneuver: Maneuver, start: EgoState, observation: Observation, history: History, predictions: Predictions,
        sweeper: Sweeper, wanted_speed: float,
    ) -> Evaluated:  # fmt: skip
        """The best plan of a manoeuvre from `start` on, with the law's verdict on it."""
        if maneuver.refused:
            return Evaluated(maneuver, _without_plan(maneuver, (Rejection(maneuver.refused),)))
        if maneuver.prepares is not None:
            prepared = self._evaluate(maneuver.prepares, start, observation, history, predictions, sweeper, wanted_speed, signalled=True)
            if prepared.report.rank != LAWFUL:
                return Evaluated(maneuver, _without_plan(maneuver, (Rejection(f"prepares:{maneuver.prepares.next}"), *prepared.report.rejections)))
        found = self._evaluate(maneuver, start, observation, history, predictions, sweeper, wanted_speed)
        if maneuver.commits and maneuver.may_wait and found.report.rank == UNKNOWN:
            patient = replace(maneuver, commits=False)
            found = self._evaluate(patient, start, observation, history, predictions, sweeper, wanted_speed)
        return found

    def _evaluate(
        self, maneuver: Maneuver, start: EgoState, observation: Observation, history: History, predictions: Predictions,
        sweeper: Sweeper, wanted_speed: float, signalled: bool = False,
    ) -> Evaluated:  # fmt: skip
        stretches = self.scenes.stretches(observation, maneuver, history)
        if signalled:
            stretches = tuple(replace(item, roles={**item.roles, **_signalled(maneuver.turn_signal)}) for item in stretches)
        caps = self.assessor.caps(maneuver, stretches)
        maneuver = replace(maneuver, goal=replace(maneuver.goal, caps=(*maneuver.goal.caps, *caps)))
        path = maneuver.lane_path.path
        state = path.frenet_state(start)
        candidates = sample(path, state, maneuver.goal, self.footprint, self.lattice)
        feasible = check(candidates, self.limits, maneuver.goal, self.footprint)
        users = users_along(path, predictions, (start.x, start.y), self.footprint, self.cost) if self.cost.asks_for_others else None
        costs = self._with_comfort(motion_cost(candidates, self.cost, wanted_speed, users), candidates, maneuver.goal)
        assessed = self.assessor.best(
            maneuver, stretches, candidates, costs.order(), costs.weighted, observation, predictions, feasible.ok, sweeper
        )
        rejections = (*_infeasible(feasible.counts), *assessed.rejections)
        if assessed.index is None:
            return Evaluated(maneuver, _without_plan(maneuver, rejections, len(candidates)), caps)
        added = dict(maneuver.biases)
        if maneuver.credit is not None:
            added["credit"] = min(maneuver.credit - float(costs.distance[assessed.index]), 0.0)
        cost = weigh(costs, assessed.index, assessed.rank, sum(added.values()))
        cost = replace(cost, parts={**cost.parts, **added})
        report = CandidateReport(
            maneuver.current, maneuver.next, assessed.rank, cost, assessed.verdict, candidates.one(assessed.index), maneuver.turn_signal,
            len(stretches), len(candidates), rejections,
        )  # fmt: skip
        return Evaluated(maneuver, report, caps, assessed.violation)


    def _with_comfort(self, costs: MotionCosts, candidates: Candidates, goal: Goal) -> MotionCosts:
        """Plans beyond what is comfortable, now or by leaving too little for what comes after the horizon, cost what nothing else makes up for:
        a plan that puts braking off looks cheap until its horizon ends."""
        beyond = (~check(candidates, self.comfortable, goal, self.footprint).ok).astype(np.float64)
        return replace(costs, comfort=costs.comfort + self.beyond_comfort * beyond, parts={**costs.parts, "beyond_comfort": beyond})


def failed(maneuver: Maneuver, error: Exception) -> Evaluated:
    """A candidate whose evaluation raised: it falls out, and says so."""
    reason = Rejection("error", because=f"{type(error).__name__}: {error}")
    return Evaluated(maneuver, _without_plan(maneuver, (reason,)))


def _signalled(side: TurnSignal) -> dict[str, Value]:
    """The facts of history as they will be once a movement has been signalled for as long as any law asks."""
    return {"ego.turn_signal": side, "ego.signalled_distance": LONG, "ego.signalled_time": LONG}


def _without_plan(maneuver: Maneuver, rejections: Sequence[Rejection], sampled: int = 0) -> CandidateReport:
    return CandidateReport(
        maneuver.current, maneuver.next, NO_PLAN, None, None, None, maneuver.turn_signal, sampled=sampled, rejections=tuple(rejections)
    )  # fmt: skip


def _infeasible(counts: dict[str, int]) -> tuple[Rejection, ...]:
    return tuple(Rejection(f"limit:{name}", count=count) for name, count in sorted(counts.items()) if count)
