"""Mutants -> the law test that notices each: only tests in which a changed row acts otherwise are judged again, until one fails."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property

from regdb.condition import linear_value, unknown_facts
from regdb.meaning import Judgement
from regdb.regulation import Regulation
from regdb.situation import Situation
from regdb.truth import Truth
from regdb_compiler.driver import Build
from regdb_compiler.law_tests.judge import compare, judge_tests
from regdb_compiler.law_tests.read import LawTest
from regdb_compiler.law_tests.take_part import Law
from regdb_compiler.mutation.mutant import Mutant

Act = tuple[object, ...]
"""All that a row contributes to a decision; empty when it has no say."""


@dataclass(eq=False)
class Trial:
    """A passed test, ready to be judged again with other rows."""

    test: LawTest
    rules: tuple[Regulation, ...]
    situation: Situation
    governing: frozenset[str]
    acts: dict[int, Act] = field(default_factory=dict)

    def has(self, row: Regulation) -> bool:
        """Whether a row of this jurisdiction and date is in force there and then."""
        return row.jurisdiction in self.governing and row.in_force(self.test.day)

    def act(self, row: Regulation) -> Act:
        """What the row contributes in this situation."""
        plan = self.situation.plan
        if not self.has(row) or not row.concerns(plan.current, plan.next):
            return ()
        alone = Judgement((row,), self.situation)
        holds = alone.holds(row)
        if holds is False:
            return ()
        limits = tuple((item.attribute, alone.beyond(item), linear_value(item.bound, self.situation)) for item in row.limits)
        return (holds, row.legality, row.force, row.targets, limits, self._missing(row, holds))

    def _missing(self, row: Regulation, holds: Truth) -> tuple[str, ...]:
        """The facts on which an undecided row hangs, where the test names them."""
        if holds is not None or self.test.expected.unknown is None:
            return ()
        unless = () if row.unless is None else unknown_facts(row.unless, self.situation)
        return (*unknown_facts(row.when, self.situation), *unless)

    def act_as_is(self, row: Regulation) -> Act:
        """The same of an unchanged row, worked out once."""
        key = id(row)
        if key not in self.acts:
            self.acts[key] = self.act(row)
        return self.acts[key]

    def notices(self, mutant: Mutant) -> bool:
        """Whether the test fails once the mutant's rows stand in place of the law's."""
        names_assumptions = self.test.expected.assumed is not None
        if not names_assumptions and all(self.act_as_is(a) == self.act(b) for a, b in mutant.swaps):
            return False
        gone = {id(original) for original, _ in mutant.swaps}
        kept = [rule for rule in self.rules if id(rule) not in gone]
        kept += [changed for _, changed in mutant.swaps if self.has(changed)]
        decision = Judgement(tuple(kept), self.situation).decision
        return next(compare(self.test, decision), None) is not None


@dataclass
class Trials:
    """Every passed test of a build, by the regulations that take part in it."""

    build: Build

    @cached_property
    def law(self) -> Law:
        return Law(self.build.regulations, self.build.corpus.tree)

    @cached_property
    def _all(self) -> tuple[dict[str, list[Trial]], list[Trial]]:
        """Trials beside a regulation by its id, and those of cases."""
        beside: dict[str, list[Trial]] = {}
        cases: list[Trial] = []
        loaded = frozenset(rule.jurisdiction for rule in self.build.regulations)
        for outcome in judge_tests(self.build, self.build.law_tests):
            if outcome.status == "passed" and outcome.judgement is not None:
                test = outcome.test
                places = self.build.corpus.tree.governing(test.place, loaded)
                trial = Trial(test, tuple(outcome.judgement.rules), outcome.judgement.situation, places)
                (cases if test.entry is None else beside.setdefault(test.entry.id, [])).append(trial)
        return beside, cases

    @cached_property
    def _connected_to(self) -> dict[str, list[str]]:
        """Regulation id -> ids beside which it takes part."""
        found: dict[str, list[str]] = {}
        for name in self._all[0]:
            for other in self.law.connected(name):
                found.setdefault(other, []).append(name)
        return found

    def of(self, mutant: Mutant) -> Iterator[Trial]:
        """Tests that may notice: beside the regulations touched, beside those connected with them, then the cases."""
        beside, cases = self._all
        seen: set[str] = set()
        near = [name for own in sorted(mutant.ids) for name in self._connected_to.get(own, ())]
        for name in (*sorted(mutant.ids), *sorted(near)):
            if name not in seen:
                seen.add(name)
                yield from beside.get(name, ())
        yield from cases

    def killer(self, mutant: Mutant) -> LawTest | None:
        """The first law test that notices the mutant."""
        return next((trial.test for trial in self.of(mutant) if self._concerns(trial, mutant) and trial.notices(mutant)), None)

    def _concerns(self, trial: Trial, mutant: Mutant) -> bool:
        """A test beside a regulation sees only what is connected with it; rows connected with others stay out."""
        entry = trial.test.entry
        return entry is None or not mutant.ids.isdisjoint(self.law.connected(entry.id))
