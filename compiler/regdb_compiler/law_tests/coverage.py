"""Outcomes -> coverage: what passed tests have shown of every regulation version, by rule, by branch and by state.

by rule    held true, held false, broken (prohibitions), defeated (where something displaces it), each exception decided
by branch  each literal of its conditions true and false, each limit below, at and above
by state   each transition of its states as written: of `current: [stop], next: [turn_left, turn_right]` two
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

from regdb.condition import FALSE, TRUE, Literal, evaluate, linear_value, literals
from regdb.condition_text import show
from regdb.meaning import Judgement
from regdb.regulation import Regulation
from regdb.states import StateMachine
from regdb_compiler import documents
from regdb_compiler.diagnostics import Place
from regdb_compiler.law_tests.literal_place import place_of_literal
from regdb_compiler.law_tests.outcome import Outcome
from regdb_compiler.lower import Row

if TYPE_CHECKING:
    from regdb_compiler.driver import Build

KINDS = ("rule", "branch", "state")


@dataclass(frozen=True, slots=True)
class Item:
    """One thing a test can show: its kind, what it is in words, where it is written, and whether a test has shown it."""

    kind: str
    what: str
    place: Place
    covered: bool


@dataclass(frozen=True, slots=True)
class RowCoverage:
    """What tests have shown of one regulation in one version."""

    regulation: Regulation
    code: str
    items: tuple[Item, ...]


@dataclass(frozen=True)
class Coverage:
    """Coverage of a whole build."""

    rows: tuple[RowCoverage, ...]

    @cached_property
    def codes(self) -> tuple[str, ...]:
        return tuple(sorted({row.code for row in self.rows}))

    def count(self, code: str | None = None, kind: str | None = None) -> tuple[int, int]:
        """Covered and all items, of one code and kind or of all."""
        items = [item for row in self.rows if code in (None, row.code) for item in row.items if kind in (None, item.kind)]
        return sum(item.covered for item in items), len(items)

    @property
    def uncovered(self) -> tuple[tuple[RowCoverage, Item], ...]:
        return tuple((row, item) for row in self.rows for item in row.items if not item.covered)

    @property
    def percent(self) -> float:
        """Covered items of every kind in a hundred; a hundred where there is nothing to cover."""
        covered, total = self.count()
        return 100.0 * covered / total if total else 100.0


@dataclass
class _Seen:
    """What tests have shown of one row, while they are gone through."""

    marks: set[str] = field(default_factory=set)
    literals: set[tuple[str, Literal, bool]] = field(default_factory=set)
    limits: set[tuple[int, str]] = field(default_factory=set)
    transitions: set[tuple[str, str]] = field(default_factory=set)


@dataclass(frozen=True, slots=True)
class _Context:
    """What the items of one row depend on besides it: the machine, the other rows, what displaces an id."""

    machine: StateMachine
    by_id: dict[str, Regulation]
    displacers: dict[str, list[Regulation]]


def cover(build: Build, outcomes: Iterable[Outcome]) -> Coverage:
    """Count what the passed tests show; a failed or broken test shows nothing."""
    seen = {id(row.regulation): _Seen() for row in build.rows}
    for outcome in outcomes:
        if outcome.status == "passed" and outcome.judgement is not None:
            for rule in _shown(outcome, outcome.judgement):
                _record(seen[id(rule)], rule, outcome.judgement)
    displacers: dict[str, list[Regulation]] = {}
    for row in build.rows:
        for target in row.regulation.targets:
            displacers.setdefault(target, []).append(row.regulation)
    context = _Context(build.corpus.machine, {row.regulation.id: row.regulation for row in build.rows}, displacers)
    return Coverage(tuple(_row(row, seen[id(row.regulation)], context) for row in build.rows))


def _shown(outcome: Outcome, judgement: Judgement) -> Iterator[Regulation]:
    """The rules a test says something about: beside a regulation all that take part; in a case those it cites and those that hold.

    All the law of a place takes part in a case; that most of it is idle in a quiet scene shows nothing of it.
    """
    doc = outcome.test.doc
    if not isinstance(doc, documents.Case):
        yield from judgement.rules
        return
    for rule in judgement.concerned:
        if judgement.holds(rule) is True or any(rule.citation.startswith(cited) for cited in doc.cites):
            yield rule


def _record(seen: _Seen, rule: Regulation, judgement: Judgement) -> None:
    plan, situation = judgement.situation.plan, judgement.situation
    if not rule.concerns(plan.current, plan.next):
        seen.marks.add("false")
        return
    seen.transitions.add((plan.current, plan.next))
    holds = judgement.holds(rule)
    if holds is not None:
        seen.marks.add("true" if holds else "false")
    if judgement.breaks(rule) is True:
        seen.marks.add("broken")
    if judgement.defeated(rule) is True:
        seen.marks.add("defeated")
    if rule.targets and judgement.effective(rule) is True:
        held = {other.id for other in judgement.concerned if other.id in rule.targets and judgement.holds(other) is True}
        seen.marks.update(f"displaces {target}" for target in held)
    for part, node in _parts(rule):
        for literal in node:
            truth = evaluate(literal, situation)
            if truth is not None:
                seen.literals.add((part, literal, truth))
    _record_limits(seen, rule, judgement)


def _record_limits(seen: _Seen, rule: Regulation, judgement: Judgement) -> None:
    for position, limit in enumerate(rule.limits):
        quantity, bound = judgement.situation.value(limit.fact), linear_value(limit.bound, judgement.situation)
        if quantity is not None and bound is not None:
            number = float(quantity)  # type: ignore[arg-type]  # limits bound numbers, the compiler checked
            seen.limits.add((position, "below" if number < bound else "above" if number > bound else "at"))


def _parts(rule: Regulation) -> Iterator[tuple[str, tuple[Literal, ...]]]:
    """Each condition with its literals, each literal once."""
    for part, node in (("when", rule.when), ("unless", rule.unless)):
        if node is not None:
            yield part, tuple(dict.fromkeys(item for item in literals(node) if item not in (TRUE, FALSE)))


def _row(row: Row, seen: _Seen, context: _Context) -> RowCoverage:
    items = (*_rule_items(row, seen, context), *_branch_items(row, seen), *_state_items(row, seen, context.machine))
    return RowCoverage(row.regulation, row.entry.jurisdiction.code, items)


def _rule_items(row: Row, seen: _Seen, context: _Context) -> Iterator[Item]:
    rule, entry = row.regulation, row.entry
    name = entry.place("id")
    yield Item("rule", "never holds", name, "true" in seen.marks)
    if rule.when != TRUE or rule.unless is not None or rule.current is not None or rule.next is not None:
        yield Item("rule", "never fails to hold", name, "false" in seen.marks)
    if not rule.legality and rule.force != "advisory":
        yield Item("rule", "never broken", name, "broken" in seen.marks)
    if any(_meet(rule, other) for other in context.displacers.get(rule.id, ())):
        yield Item("rule", "never displaced", name, "defeated" in seen.marks)
    for kind, names in (("exception_to", entry.doc.exception_to), ("overrides", entry.doc.overrides)):
        for position, written in enumerate(names):
            shown = any(f"displaces {target}" in seen.marks for target in _targets_of(written, rule, context))
            yield Item("rule", f"never displaces {written}", entry.place(kind, position), shown)


def _meet(a: Regulation, b: Regulation) -> bool:
    """Whether there is a day on which both are in force."""
    first = max(a.effective or 1, b.effective or 1)
    return a.in_force(first) and b.in_force(first)


def _targets_of(written: str, rule: Regulation, context: _Context) -> Iterator[str]:
    """The targets one written name stands for: itself, or every member of its group."""
    group, _, word = written.partition(":")
    for target in rule.targets:
        other = context.by_id.get(target)
        if group in {"tag", "topic"} and word:
            if other is not None and word in (other.tags if group == "tag" else (other.topic,)):
                yield target
        elif target == written or target.endswith(f"-{written}"):
            yield target


def _branch_items(row: Row, seen: _Seen) -> Iterator[Item]:
    for part, found in _parts(row.regulation):
        for literal in found:
            place = place_of_literal(row.entry, part, literal)
            for truth in (True, False):
                what = f"{part} never {str(truth).lower()}: {show(literal)}"
                yield Item("branch", what, place, (part, literal, truth) in seen.literals)
    for position, limit in enumerate(row.regulation.limits):
        place = row.entry.place("attributes", limit.attribute)
        for side in ("below", "at", "above"):
            yield Item("branch", f"never {side} {limit.attribute}: {limit.text}", place, (position, side) in seen.limits)


def _state_items(row: Row, seen: _Seen, machine: StateMachine) -> Iterator[Item]:
    """A pair of written names counts once something in it is tested; a pair that the machine has no transition for is not asked."""
    states = row.entry.doc.states
    if not (states.current or states.next):
        return
    for first in states.current or ("any",):
        ours = machine.states if first == "any" else machine.expand(first)
        for then in states.next or ("any",):
            theirs = set(machine.states if then == "any" else machine.expand(then))
            pairs = {(state, other) for state in ours for other in machine.states[state].next if other in theirs}
            if pairs:
                yield Item("state", f"never tested: {first} -> {then}", row.entry.place("states"), not pairs.isdisjoint(seen.transitions))
