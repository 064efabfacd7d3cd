"""Judges plans of one manoeuvre by the law of each stretch they cross; plans the law cannot tell apart are judged once."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from regdb.situation import Plan, Situation
from regdb_runtime.assessment.alike import Distinctions, codes
from regdb_runtime.assessment.assessed import LAWFUL, RANKS
from regdb_runtime.assessment.measured import PlanFacts
from regdb_runtime.maneuver import Maneuver
from regdb_runtime.scenes.stretch import Stretch
from regdb_runtime.verdict import Verdict

Rows = NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class Group:
    """Plans alike in one stretch, and the verdict on them, which was given on the first of the rows."""

    stretch: int
    verdict: Verdict
    rows: Rows
    own: bool = True
    """False where the verdict was given on a plan of another batch."""


@dataclass(frozen=True, eq=False)
class Judged:
    """Verdicts on k plans measured together: their groups, the rank of each plan, and the first stretch that gave it."""

    facts: PlanFacts
    groups: Sequence[Group]
    rank: NDArray[np.int8]
    worst: Rows

    def of(self, row: int) -> Iterator[Group]:
        """The groups a plan is in, stretch by stretch."""
        return (group for group in self.groups if row in group.rows)

    def verdict(self, row: int) -> Verdict | None:
        """The worst verdict on a plan, of equally bad ones the first."""
        return next((group.verdict for group in self.of(row) if group.stretch == self.worst[row]), None)


@dataclass(eq=False)
class Judging:
    """The law over the plans of one manoeuvre. Codes that last from batch to batch keep their verdicts."""

    maneuver: Maneuver
    stretches: Sequence[Stretch]
    distinctions: Sequence[Distinctions]
    known: dict[tuple[int, tuple[str, ...], int], Verdict] = field(default_factory=dict)

    def judge(self, facts: PlanFacts) -> Judged:
        """The verdict of every stretch on every plan that reaches it."""
        rank, worst = np.full(facts.size, LAWFUL, dtype=np.int8), np.zeros(facts.size, dtype=np.intp)
        groups: list[Group] = []
        for index in range(len(self.stretches)):
            for group in self._grouped(facts, index, np.flatnonzero(facts.reached[index])):
                groups.append(group)
                found = RANKS[group.verdict.verdict]
                worse = group.rows[rank[group.rows] < found]
                rank[worse], worst[worse] = found, index
        return Judged(facts, groups, rank, worst)

    def final(self, judged: Judged, row: int) -> tuple[Verdict, ...]:
        """One plan judged by all its own numbers, stretch by stretch."""
        return tuple(
            group.verdict if group.own and group.rows[0] == row else self._verdict(judged.facts, group.stretch, row) for group in judged.of(row)
        )

    def _grouped(self, facts: PlanFacts, index: int, rows: Rows) -> Iterator[Group]:
        if len(rows) == 1:
            yield Group(index, self._verdict(facts, index, int(rows[0])), rows)
        if len(rows) <= 1:
            return
        stretch = self.stretches[index]
        shared = Plan(self.maneuver.current, self.maneuver.next, {**stretch.roles, **facts.shared, **facts.of_stretch[index].shared})
        situation = Situation(stretch.view.circumstances.vocabulary, stretch.scene, shared)
        coded, told = codes(self.distinctions[index], facts, index, situation)
        kinds, first, places = np.unique(coded[rows], return_index=True, return_inverse=True)
        for place in np.argsort(first, kind="stable").tolist():
            code = int(kinds[place])
            held = self.known.get((index, told, code)) if told is not None else None
            verdict = held or self._verdict(facts, index, int(rows[first[place]]))
            if told is not None:
                self.known[index, told, code] = verdict
            yield Group(index, verdict, rows[places == place], held is None)

    def _verdict(self, facts: PlanFacts, index: int, row: int) -> Verdict:
        stretch = self.stretches[index]
        plan = Plan(self.maneuver.current, self.maneuver.next, facts.one(index, row, stretch.roles))
        return stretch.view.judge(stretch.prepared, plan)
