"""Statements fused over time into what is held to be so: injected time and odometer, no clock, no randomness, evidence kept for every fact."""

from __future__ import annotations

from bisect import insort
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from regdb.fusion_policy import FusionPolicy
from regdb.situation import quiet_facts
from regdb.vocabulary import Fact, Value, Vocabulary
from regdb_runtime.perception.evidence import Question, Reading, Snapshot, Statement
from regdb_runtime.perception.policies import Belief, Held, Moment, believe, outlived, restricts
from regdb_runtime.perception.questions import open_question
from regdb_runtime.perception.zones import ZoneEnds

_MODEL = ("model", "scripted")
_LOOKING = (*_MODEL, "detector")
_TELLS_MODEL = frozenset(("perception", "map"))


@dataclass(frozen=True, slots=True)
class FusionSettings:
    """Bounds of the fusion itself; what concerns one fact stands in its policy.

    `alive`: s without any answer after which perception counts as silent (three looks of a model that answers once in 1.5 s).
    `ahead`: s by which a frame may seem to come from the future (two clocks are never the same). `spare`: statements kept beyond those
    that a confirmation needs, of each source and value. `step_slack`: share of a step by which a number may miss it (rounding to SI).
    """

    alive: float = 4.5
    ahead: float = 0.05
    spare: int = 8
    step_slack: float = 0.02


@dataclass(frozen=True, slots=True)
class Refusal:
    """A statement that was not taken in, and why."""

    statement: Statement
    reason: str


class Fusion:
    """Holds the live statements on every fact. Use it from one thread; snapshots are immutable and may go anywhere.

    `tells`: the facts that perception is to report (default: all facts of the source perception), silent while they are not known.
    """

    def __init__(self, vocabulary: Vocabulary, settings: FusionSettings | None = None, tells: Iterable[str] | None = None) -> None:
        self.vocabulary, self.settings = vocabulary, settings or FusionSettings()
        own = (fact.name for fact in vocabulary if fact.source == "perception") if tells is None else tells
        self._tells = frozenset(own)
        self._held: dict[str, list[Held]] = {}
        self._ends = ZoneEnds(vocabulary)
        self._quiet = quiet_facts(vocabulary)
        self._heard: float | None = None
        self.refused: tuple[Refusal, ...] = ()

    def update(self, reading: Reading, travelled: float, now: float) -> tuple[Refusal, ...]:
        """Take in what one answer or measurement said. `travelled`: odometer (m) where its frame was taken; `now`: seconds, when it is read.

        Returns what was refused, with reasons (also in `refused`). An answer that says nothing still shows that perception is alive.
        """
        refused = []
        taken: list[Statement] = []
        for statement in reading.statements:
            reason = self._objection(statement, now)
            if reason:
                refused.append(Refusal(statement, reason))
            else:
                self._keep(statement, travelled)
                taken.append(statement)
        self._heard = max([now if not taken else max(item.captured for item in taken), *([self._heard] if self._heard is not None else [])])
        moment = Moment(now, travelled)
        self._ends.note(_by_fact(taken), lambda name: self._believe(self.vocabulary.facts[name], moment))
        self.refused = tuple(refused)
        return self.refused

    def snapshot(self, now: float, travelled: float, relevant: frozenset[str] | None = None) -> Snapshot:
        """What holds now. `relevant`: the facts that map and state make matter here (see `relevance`), None for all.

        A fact that matters and is not known is silent: nothing may be assumed of it. One that does not matter and of which nobody says
        anything takes its quiet value while perception is alive, and is named in `assumed`.
        """
        moment = Moment(now, travelled)
        self._forget(moment)
        beliefs = {name: found for name in sorted(self._held) if (found := self._believe(self.vocabulary.facts[name], moment)) is not None}
        facts: dict[str, Value] = {name: found.value for name, found in beliefs.items()}
        why = self._degraded(now)
        assumed: frozenset[str] = frozenset()
        if not why and relevant is not None:
            idle = (self._tells - relevant).difference(self._held)
            assumed = frozenset(name for name in idle if name in self._quiet)
            facts |= {name: self._quiet[name] for name in sorted(assumed)}
        return Snapshot(
            now, facts, {name: found.evidence for name, found in beliefs.items()},
            {name: now - max(item.captured for item in found.evidence) for name, found in beliefs.items()},
            self._tells.difference(facts), why, assumed, self.questions(now, travelled, relevant),
        )  # fmt: skip

    def questions(self, now: float, travelled: float, relevant: frozenset[str] | None = None) -> tuple[Question, ...]:
        """Closed questions that the look-alikes now in view ask for, by fact; those that restrict come first: until answered they stand."""
        moment = Moment(now, travelled)
        found = []
        for name in sorted(self._held):
            fact = self.vocabulary.facts[name]
            question = open_question(self.vocabulary, fact, self._held[name], moment) if relevant is None or name in relevant else None
            if question is not None and fact.fusion is not None:
                found.append((not restricts(fact.fusion, value=True), question))
        return tuple(question for _, question in sorted(found, key=lambda item: (item[0], item[1].fact)))

    def _believe(self, fact: Fact, moment: Moment) -> Belief | None:
        held = self._held.get(fact.name, ())
        if fact.fusion is None:
            latest = [item for item in held if moment.time - item.captured <= self.settings.alive]
            return Belief(latest[-1].statement.value, (latest[-1].statement,)) if latest else None
        return believe(fact, fact.fusion, self._ends.open(fact.name, held), moment)

    def _objection(self, statement: Statement, now: float) -> str:
        """Why a statement cannot be taken in; empty when it can."""
        fact = self.vocabulary.facts.get(statement.fact)
        if fact is None:
            return f"no fact is called {statement.fact}"
        if statement.captured > now + self.settings.ahead:
            return f"captured {statement.captured - now:.2f} s in the future"
        if statement.source in _LOOKING and fact.source not in _TELLS_MODEL:
            return f"{fact.name} is the {fact.source}'s to tell, nobody sees it"
        return _misfit(fact, statement.value) or _implausible(fact, fact.fusion, statement.value, self.settings.step_slack)

    def _keep(self, statement: Statement, travelled: float) -> None:
        """Insert by time, and let go of what a nearer one of the same source and value makes superfluous."""
        items = self._held.setdefault(statement.fact, [])
        new = Held(statement, travelled)
        if new in items:
            return
        insort(items, new, key=_key)
        alike = [item for item in items if _alike(item.statement, statement)]
        policy = self.vocabulary.facts[statement.fact].fusion
        if policy is None:
            self._held[statement.fact] = items[-1:]
            return
        gone = _superfluous(alike, policy.apart, 2 * policy.confirmations + self.settings.spare)
        if gone:
            self._held[statement.fact] = [item for item in items if item not in gone]

    def _forget(self, moment: Moment) -> None:
        for name in list(self._held):
            policy = self.vocabulary.facts[name].fusion
            if policy is not None:
                left = [item for item in self._held[name] if not outlived(policy, item, moment)]
                if left:
                    self._held[name] = left
                else:
                    del self._held[name]

    def _degraded(self, now: float) -> str:
        if self._heard is None:
            return "perception has not said anything yet"
        silent = now - self._heard
        return f"perception has not said anything for {silent:.1f} s" if silent > self.settings.alive else ""


def _by_fact(statements: Sequence[Statement]) -> Mapping[str, Sequence[Statement]]:
    found: dict[str, list[Statement]] = {}
    for item in statements:
        found.setdefault(item.fact, []).append(item)
    return found


def _key(item: Held) -> tuple[float, str, str, str, str]:
    statement, value = item.statement, item.statement.value
    said = ",".join(sorted(value)) if isinstance(value, frozenset) else str(value)
    return statement.captured, statement.source, statement.rule, statement.frame, said


def _alike(one: Statement, other: Statement) -> bool:
    """Whether the newer of two statements can stand for the older in every count."""
    return (one.value, one.source, one.certainty, one.rule == "choice") == (other.value, other.source, other.certainty, other.rule == "choice")


def _superfluous(alike: Sequence[Held], apart: float, most: int) -> frozenset[Held]:
    """Statements between two that are nearer than `apart`, and the oldest beyond `most`; the first and the newest always stay."""
    kept: list[Held] = []
    for item in alike:
        if len(kept) >= 2 and item.captured - kept[-2].captured < apart:
            kept[-1] = item
        else:
            kept.append(item)
    return frozenset(alike) - frozenset(kept[-most:])


def _misfit(fact: Fact, value: Value) -> str:
    """Why a value is none of the fact's; empty when it is one."""
    if fact.kind == "boolean":
        fits = isinstance(value, bool)
    elif fact.kind == "enumeration":
        fits = isinstance(value, str) and value in fact.values
    elif fact.kind == "set":
        fits = isinstance(value, frozenset) and value <= frozenset(fact.values)
    else:
        fits = isinstance(value, (int, float)) and not isinstance(value, bool) and value == value and abs(value) != float("inf")
    return "" if fits else f"{value!r} is no value of {fact.name}"


def _implausible(fact: Fact, policy: FusionPolicy | None, value: Value, slack: float) -> str:
    """Why a number cannot be true; empty when it can."""
    if policy is None or isinstance(value, (bool, str, frozenset)):
        return ""
    shown = fact.show(value)
    if policy.least is not None and value < policy.least * (1 - slack):
        return f"{fact.name} of {shown} is less than {fact.show(policy.least)}, the least there is"
    if policy.most is not None and value > policy.most * (1 + slack):
        return f"{fact.name} of {shown} is more than {fact.show(policy.most)}, the most there is"
    if policy.step and abs(value / policy.step - round(value / policy.step)) > slack:
        return f"{fact.name} of {shown} is no multiple of {fact.show(policy.step)}"
    return ""
