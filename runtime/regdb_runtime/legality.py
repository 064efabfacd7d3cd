"""Rows, scene and transition in; verdict and limits out: the law of one place and day, ready to judge."""

from __future__ import annotations

import datetime
from bisect import bisect_right
from collections.abc import Iterable, Mapping, Sequence
from typing import Protocol

from regdb.jurisdiction import JurisdictionError, JurisdictionTree
from regdb.regulation import Regulation
from regdb.situation import Plan, Scene
from regdb.states import StateMachine
from regdb.vocabulary import FactError, Value, Vocabulary, read_date
from regdb_runtime.errors import RequestError
from regdb_runtime.index.bitmaps import bitmaps
from regdb_runtime.index.bucket import Bucket, Decide
from regdb_runtime.index.generated import Generator
from regdb_runtime.index.guarded import judge_guarded
from regdb_runtime.index.slots import FactTable, PreparedScene
from regdb_runtime.verdict import Circumstances, Verdict

BITMAPS_BEYOND = 256
"""Rules in a bucket up to which a function is generated: it is the faster answer, but takes 0.2 ms a rule to compile; bitmaps 0.04."""

Day = datetime.date | str | int
"""A day as a date, ISO text, or proleptic Gregorian ordinal."""


def day_number(date: Day) -> int:
    """The ordinal of a day. Raises RequestError for text that is no ISO date."""
    if isinstance(date, datetime.date):
        return date.toordinal()
    if isinstance(date, int):
        return date
    try:
        return read_date(date)
    except FactError as error:
        raise RequestError(str(error)) from None


class RulesInForce:
    """The regulations of one set of jurisdictions and one date interval, by transition; decisions are compiled on first use."""

    def __init__(self, rules: Sequence[Regulation], generator: Generator, machine: StateMachine, threshold: int = BITMAPS_BEYOND) -> None:
        self.rules, self.machine = tuple(rules), machine
        self.table, self._generator = generator.expressions.table, generator
        self.decides: dict[tuple[str, str], tuple[Decide, Bucket]] = {}
        self._threshold = threshold
        self._by_state: dict[str | None, list[int]] = {}
        for index, rule in enumerate(self.rules):
            for state in (None,) if rule.current is None else rule.current:
                self._by_state.setdefault(state, []).append(index)

    def bucket(self, current: str, following: str) -> tuple[Decide, Bucket]:
        """The compiled decision of a transition. Raises RequestError for a state that is not there."""
        found = self.decides.get((current, following))
        if found is None:
            for state in (current, following):
                if state not in self.machine.states:
                    raise RequestError(f"unknown state {state!r}; a plan names states by id, such as {next(iter(self.machine.states), 'none')!r}")
            found = self.decides[current, following] = self._build(current, following)
        return found

    def _build(self, current: str, following: str) -> tuple[Decide, Bucket]:
        places = sorted([*self._by_state.get(None, ()), *self._by_state.get(current, ())])
        rules = [rule for place in places if (rule := self.rules[place]).next is None or following in rule.next]
        bucket = Bucket(rules, self.table)
        compiled = self._generator.generate(bucket) if len(bucket.candidates) <= self._threshold else bitmaps(bucket)
        return compiled, bucket


class View:
    """The law of one place on one day. Immutable; safe to share between threads."""

    def __init__(self, rules: RulesInForce, circumstances: Circumstances) -> None:
        self._rules, self._table = rules, rules.table
        self.circumstances = circumstances
        self._decides = rules.decides

    @property
    def place(self) -> str:
        """The jurisdiction asked about."""
        return self.circumstances.place

    @property
    def date(self) -> str:
        """The day asked about, ISO."""
        return self.circumstances.date

    @property
    def rules(self) -> tuple[Regulation, ...]:
        """Every regulation that governs here and now, by id."""
        return self._rules.rules

    def prepare(self, scene: Scene) -> PreparedScene:
        """Encode a scene once, to judge several plans against it."""
        return self._table.prepare(scene)

    def judge(self, scene: Scene | PreparedScene, plan: Plan) -> Verdict:
        """The verdict for a plan in a scene. Raises RequestError for a state that is not there."""
        prepared = scene if scene.__class__ is PreparedScene and scene.table is self._table else self._prepared(scene)
        found = self._decides.get((plan.current, plan.next)) or self._rules.bucket(plan.current, plan.next)
        if not prepared.wrong:
            values = self._table.with_plan(prepared, plan)
            if values is not None:
                try:
                    return Verdict(found[0](values), found[1].rules, self.circumstances, prepared.scene, plan)
                except Exception:  # noqa: BLE001  # judged again below, where what fails fails closed and says why
                    pass
            tidied, lost, wrong = self._table.tidy(plan.facts)
            if values is None and not lost and not wrong:
                return self.judge(prepared, Plan(plan.current, plan.next, tidied))
        return self._guarded(found[1], prepared.scene, plan)

    def lawful_next(
        self, scene: Scene | PreparedScene, current: str, plan_facts: Mapping[str, Value] | None = None
    ) -> dict[str, Verdict]:
        """Next state id -> verdict, for every state the machine allows after `current`. Raises RequestError."""
        prepared = self._prepared(scene)
        facts = plan_facts or {}
        return {state: self.judge(prepared, Plan(current, state, facts)) for state in self._after(current)}

    def warm(self, current: str | None = None) -> int:
        """Compile the transitions that can follow `current` (all of the machine's without it); how many there are."""
        states = [current] if current is not None else list(self._rules.machine.states)
        pairs = [(state, following) for state in states for following in self._after(state)]
        for pair in pairs:
            self._rules.bucket(*pair)
        return len(pairs)

    def concerned(self, current: str, following: str) -> tuple[Regulation, ...]:
        """The regulations that speak of a transition, by id."""
        return self._rules.bucket(current, following)[1].rules

    def _after(self, current: str) -> tuple[str, ...]:
        state = self._rules.machine.states.get(current)
        if state is None:
            raise RequestError(f"unknown state {current!r}")
        return state.next

    def _prepared(self, scene: Scene | PreparedScene) -> PreparedScene:
        if isinstance(scene, PreparedScene):
            return scene if scene.table is self._table else self._table.prepare(scene.scene)
        return self._table.prepare(scene)

    def _guarded(self, bucket: Bucket, scene: Scene, plan: Plan) -> Verdict:
        judgement, errors = judge_guarded(bucket.rules, self._table, scene, plan)
        decision, situation = judgement.decision, judgement.situation
        found = decision.verdict, decision.deciding, decision.limits
        verdict = Verdict(found, bucket.rules, self.circumstances, situation.scene, situation.plan, errors)
        verdict.judgement = judgement
        return verdict


class Law(Protocol):
    """Whatever can be asked for the law of a place and day: a RegulationDatabase."""

    def at(self, place: str, date: Day) -> View: ...


def judge(database: Law, scene: Scene, plan: Plan, place: str, date: Day) -> Verdict:
    """One verdict, for callers that ask once; keep the view (`database.at`) to ask again."""
    return database.at(place, date).judge(scene, plan)


class Calendar:
    """All regulations, ready to be narrowed to a place and day. Views of the same place and date interval share their rules."""

    def __init__(
        self, vocabulary: Vocabulary, machine: StateMachine, tree: JurisdictionTree, regulations: Iterable[Regulation],
        database_hash: str = "", threshold: int = BITMAPS_BEYOND,
    ) -> None:  # fmt: skip
        self.vocabulary, self.machine, self.tree = vocabulary, machine, tree
        self.database_hash, self._threshold = database_hash, threshold
        self.table = FactTable(vocabulary)
        self._generator = Generator(self.table)
        self._by_place: dict[str, list[Regulation]] = {}
        for rule in regulations:
            self._by_place.setdefault(rule.jurisdiction, []).append(rule)
        self._loaded = frozenset(self._by_place)
        self._intervals: dict[frozenset[str], list[int]] = {}
        self._rules: dict[tuple[frozenset[str], int], RulesInForce] = {}

    def at(self, place: str, date: Day) -> View:
        """The law of a place (jurisdiction id or code) on a day. Raises RequestError."""
        day = day_number(date)
        try:
            here = self.tree.get(place)
        except JurisdictionError as error:
            raise RequestError(str(error)) from None
        ids = self.tree.governing(here.id, self._loaded) & self._loaded
        key = ids, bisect_right(self._changes(ids), day)
        rules = self._rules.get(key)
        if rules is None:
            rules = self._rules[key] = RulesInForce(self._in_force(ids, day), self._generator, self.machine, self._threshold)
        iso = datetime.date.fromordinal(day).isoformat()
        return View(rules, Circumstances(self.vocabulary, here.id, iso, self._is_model(ids), self.database_hash))

    def _in_force(self, ids: frozenset[str], day: int) -> list[Regulation]:
        found = [rule for place in ids for rule in self._by_place.get(place, ()) if rule.in_force(day)]
        found.sort(key=lambda rule: rule.id)
        return found

    def _changes(self, ids: frozenset[str]) -> list[int]:
        """The days on which the law of these jurisdictions changes, ascending."""
        days = self._intervals.get(ids)
        if days is None:
            rules = [rule for place in ids for rule in self._by_place.get(place, ())]
            days = sorted({day for rule in rules for day in (rule.effective, rule.until) if day is not None})
            self._intervals[ids] = days
        return days

    def _is_model(self, ids: frozenset[str]) -> bool:
        loaded = [self.tree.get(name) for name in ids]
        return bool(loaded) and all(item.status == "model" for item in loaded)
