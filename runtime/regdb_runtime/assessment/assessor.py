"""Assesses manoeuvres: what binds their speed, and the best of their plans under the law, best first."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from regdb.interpretation import Interpretation
from regdb_runtime.assessment.alike import Distinctions, Distinguished
from regdb_runtime.assessment.assessed import LAWFUL, NO_PLAN, RANKS, UNCERTAIN, UNLAWFUL, Assessed, Violation
from regdb_runtime.assessment.caps import Caps
from regdb_runtime.assessment.cross_section import Roads
from regdb_runtime.assessment.halts import Halts
from regdb_runtime.assessment.judge import Judged, Judging
from regdb_runtime.assessment.plan_facts import BESIDE, Measuring, measure, measuring
from regdb_runtime.assessment.rejections import Fallen
from regdb_runtime.assessment.route_facts import shared_facts
from regdb_runtime.assessment.settings import AssessmentSettings
from regdb_runtime.assessment.violation import violations
from regdb_runtime.database import RegulationDatabase
from regdb_runtime.maneuver import Maneuver
from regdb_runtime.maps.road_map import RoadMap
from regdb_runtime.observation import Footprint, Observation
from regdb_runtime.planning.contacts import Sweeper
from regdb_runtime.planning.goal import SpeedCap, StopPoint
from regdb_runtime.planning.prediction import Predictions
from regdb_runtime.scenes.stretch import Stretch
from regdb_runtime.trajectory import Candidates
from regdb_runtime.verdict import Verdict

Rows = NDArray[np.intp]


class Assessor:
    """The law over the trajectories of manoeuvres. Holds what does not change from tick to tick; answers depend on their arguments alone."""

    def __init__(
        self, database: RegulationDatabase, footprint: Footprint, settings: AssessmentSettings | None = None,
        interpretation: Interpretation | None = None, road_map: RoadMap | None = None,
    ) -> None:  # fmt: skip
        self.database, self.footprint = database, footprint
        self.settings = settings or AssessmentSettings()
        self.interpretation = interpretation
        self._roads = Roads(road_map) if road_map is not None else None
        self._distinguished = Distinguished()
        self._caps = Caps(self.settings, interpretation, self._distinguished)
        self._halts = Halts(self._distinguished)

    def caps(self, maneuver: Maneuver, stretches: Sequence[Stretch]) -> tuple[SpeedCap, ...]:
        """Speed limits along the path: those in force, and by the strict reading of what is unknown those that may be."""
        return self._caps.of(maneuver, stretches, shared_facts(maneuver, self._roads))

    def halt(self, maneuver: Maneuver, stretches: Sequence[Stretch], speed: float) -> StopPoint | None:
        """The nearest place ahead that the law forbids to pass now and that can be stopped before from a speed (m/s), None without one."""
        return self._halts.of(maneuver, stretches, shared_facts(maneuver, self._roads), speed)

    def best(
        self, maneuver: Maneuver, stretches: Sequence[Stretch], candidates: Candidates, order: ArrayLike, costs: ArrayLike,
        observation: Observation,  # noqa: ARG002  # what is seen now has entered the stretches
        predictions: Predictions, ok: ArrayLike, sweeper: Sweeper | None = None,
    ) -> Assessed:  # fmt: skip
        """The best plan by (rank, violation, cost): exactly the one that judging all of them would give.

        `order`: rows of the candidates by rising cost; `ok` (N,): which keep the kinematic limits; `costs` (N,) break ties between equal
        violations. `sweeper`: the predictions made ready for contacts, where the caller has done so for the tick.
        """
        order, costs, ok = np.asarray(order, dtype=np.intp), np.asarray(costs, dtype=np.float64), np.asarray(ok, dtype=np.bool_)
        rows = order[ok[order]]
        if not len(rows) or not stretches:
            return Assessed(None, NO_PLAN, None)
        what = self._measuring(maneuver, stretches, candidates, predictions)
        judging = Judging(maneuver, stretches, [self._distinguish(stretch, maneuver) for stretch in stretches])
        search = _Search(what, judging, candidates, costs, sweeper or Sweeper(predictions, self.footprint), self.settings)
        return search.best(rows)

    def verdicts(
        self, maneuver: Maneuver, stretches: Sequence[Stretch], candidates: Candidates, predictions: Predictions, doubted: Collection[str] = ()
    ) -> tuple[tuple[Stretch, Verdict], ...]:
        """What the law says of the first of the plans, on each stretch that it reaches, whoever it touches: for motion that happened.

        `doubted`: measured facts that are left unknown where they are found true.
        """
        what = self._measuring(maneuver, stretches, candidates, predictions)
        judging = Judging(maneuver, stretches, [self._distinguish(stretch, maneuver) for stretch in stretches])
        facts = measure(what, candidates, np.array([0]))
        certain = {name: column for name, column in facts.columns.items() if name not in doubted or column.told(0) is not True}
        judged = judging.judge(replace(facts, columns=certain))
        return tuple((stretches[group.stretch], group.verdict) for group in judged.of(0))

    def _measuring(self, maneuver: Maneuver, stretches: Sequence[Stretch], candidates: Candidates, predictions: Predictions) -> Measuring:
        sections = self._roads.sections(maneuver.lane_path) if self._roads is not None else None
        ego = float(candidates.x[0, 0]), float(candidates.y[0, 0])
        reach = float(candidates.station[:, -1].max()) - float(candidates.station[0, 0]) + self.footprint.length + BESIDE
        shared = shared_facts(maneuver, self._roads)
        return measuring(
            maneuver, stretches, self.footprint, self.settings, self.interpretation, sections, shared, predictions, ego, reach
        )  # fmt: skip

    def _distinguish(self, stretch: Stretch, maneuver: Maneuver) -> Distinctions:
        """What the rules of a transition distinguish."""
        return self._distinguished.of(stretch.view.concerned(maneuver.current, maneuver.next))


class _Search:
    """One search through the plans of a manoeuvre in the order of cost."""

    def __init__(
        self, what: Measuring, judging: Judging, candidates: Candidates, costs: NDArray[np.float64], sweeper: Sweeper, settings: AssessmentSettings
    ) -> None:  # fmt: skip
        self.what, self.judging = what, judging
        self.candidates, self.costs, self.sweeper, self.settings = candidates, costs, sweeper, settings
        self.fallen = Fallen()
        self.batches: list[tuple[Rows, Judged]] = []
        self.judged = 0

    def best(self, rows: Rows) -> Assessed:
        """The cheapest lawful plan that touches nobody; else of the unknown ones the one that may break least; else the one that breaks least."""
        begin, size = 0, self.settings.first_batch
        while begin < len(rows):
            batch = rows[begin : begin + size]
            begin, size = begin + len(batch), size * self.settings.batch_growth
            judged = self.judging.judge(measure(self.what, self.candidates, batch))
            self.batches.append((batch, judged))
            self.judged += len(batch)
            for row in np.flatnonzero(judged.rank == LAWFUL).tolist():
                if self._free(int(batch[row])):
                    self.fallen.count(judged, np.flatnonzero((judged.rank != LAWFUL) & (np.arange(len(batch)) < row)))
                    return self._found(batch, judged, row, LAWFUL)
            self.fallen.count(judged, np.flatnonzero(judged.rank != LAWFUL))
        return self._least(UNCERTAIN) or self._least(UNLAWFUL) or self._none()

    def _free(self, index: int) -> bool:
        plans = self.candidates
        when, whom = self.sweeper.first_contact(plans.x[index], plans.y[index], plans.heading[index])
        if np.isinf(when):
            return True
        self.fallen.touch(str(self.sweeper.predictions.ids[whom]))
        return False

    def _least(self, rank: int) -> Assessed | None:
        """Of the plans of a rank the one with the least violation (of unknown ones: that may be one), then cost, then row."""
        listed = []
        for number, (batch, judged) in enumerate(self.batches):
            if (judged.rank == rank).any():
                broken = violations(judged, self.settings, rank)
                listed += [(broken[row], float(self.costs[batch[row]]), number, row) for row in np.flatnonzero(judged.rank == rank).tolist()]
        for violation, _, number, row in sorted(listed):
            batch, judged = self.batches[number]
            if self._free(int(batch[row])):
                return self._found(batch, judged, row, rank, violation)
        return None

    def _none(self) -> Assessed:
        _, judged = self.batches[0]
        return Assessed(None, NO_PLAN, judged.verdict(0), self.fallen.report(), judged=self.judged)

    def _found(self, batch: Rows, judged: Judged, row: int, rank: int, violation: Violation = ()) -> Assessed:
        verdicts = self.judging.final(judged, row)
        worst = max(verdicts, key=lambda verdict: RANKS[verdict.verdict])
        return Assessed(int(batch[row]), rank, worst, self.fallen.report(), verdicts, violation, self.judged)
