"""The answer to one question: verdict, the rules behind it, the limits in force; reasons are worked out only when asked for."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

from regdb.explanation import Explanation, RuleReason, explain
from regdb.meaning import Decision, Judgement, LimitInForce, combine
from regdb.regulation import Regulation
from regdb.situation import Plan, Scene, Situation
from regdb.truth import spell
from regdb.units import from_si, show_number

if TYPE_CHECKING:
    from regdb.vocabulary import Vocabulary


class Circumstances:
    """What all verdicts of one place and day share: the vocabulary, the place and day, and where the law came from."""

    __slots__ = ("database_hash", "date", "model", "place", "vocabulary")

    def __init__(self, vocabulary: Vocabulary, place: str, date: str, model: bool, database_hash: str) -> None:
        self.vocabulary, self.place, self.date = vocabulary, place, date
        self.model, self.database_hash = model, database_hash


class Verdict:
    """The law's answer for one scene and plan.

    `verdict` is 'legal', 'illegal' or 'unknown'. `deciding`: illegal - the rules broken; unknown - those whose breach is
    unknown; legal - the exceptions in effect against rules that hold. `limits` are those in force, bounds in SI, in the
    order of their rules' ids. `errors` says which rules could not be evaluated and so failed closed.
    """

    def __init__(
        self,
        found: tuple[str, tuple[Regulation, ...], tuple[LimitInForce, ...]],
        rules: tuple[Regulation, ...],
        circumstances: Circumstances,
        scene: Scene,
        plan: Plan,
        errors: tuple[str, ...] = (),
    ) -> None:
        self.verdict, self.deciding, self.limits = found
        self._rules, self.circumstances = rules, circumstances
        self.scene, self.plan, self.errors = scene, plan, errors

    def __repr__(self) -> str:
        rules = ", ".join(rule.id for rule in self.deciding)
        return f"Verdict({self.verdict}, {self.plan.current} -> {self.plan.next}, deciding: {rules or 'none'})"

    @property
    def place(self) -> str:
        """The jurisdiction asked about."""
        return self.circumstances.place

    @property
    def date(self) -> str:
        """The day asked about, ISO."""
        return self.circumstances.date

    @property
    def model(self) -> bool:
        """Whether only a model code answered: no enacted code of the place is in the database."""
        return self.circumstances.model

    @property
    def database_hash(self) -> str:
        """The content hash of the database that answered; empty when it was not read from a file."""
        return self.circumstances.database_hash

    @property
    def combined(self) -> dict[str, LimitInForce]:
        """Attribute -> its strictest limit in force."""
        return combine(self.limits)

    @cached_property
    def judgement(self) -> Judgement:
        """The reference judgement of the same question; explanations are made from it."""
        return Judgement(self._rules, Situation(self.circumstances.vocabulary, self.scene, self.plan))

    @cached_property
    def _decision(self) -> Decision:
        return self.judgement.decision

    @property
    def possible(self) -> tuple[LimitInForce, ...]:
        """Limits of rules that may be in effect, for a planner that takes the strict reading."""
        return self._decision.possible

    @property
    def missing(self) -> tuple[str, ...]:
        """Facts not known that would settle an unknown verdict."""
        return self._decision.missing

    @property
    def assumed(self) -> tuple[str, ...]:
        """Facts not known for which the vocabulary's declared assumption stands in."""
        return self._decision.assumed

    def explain(self) -> Explanation:
        """Because, unless, unknown, near misses, and the smallest change that would turn the verdict."""
        if self.errors:
            return Explanation(self.verdict, (), (), self.missing, (), ())
        return explain(self.judgement)

    def to_dict(self) -> dict[str, Any]:
        """The verdict in its stable JSON form."""
        return {
            "verdict": self.verdict,
            "place": self.place,
            "date": self.date,
            "transition": {"current": self.plan.current, "next": self.plan.next},
            "model": self.model,
            "deciding": [rule_data(rule) for rule in self.deciding],
            "limits": [limit_data(item) for item in self.limits],
            "combined": {name: limit_data(item) for name, item in sorted(self.combined.items())},
            "possible": [limit_data(item) for item in self.possible],
            "missing": [self._fact_data(name) for name in self.missing],
            "assumed": [self._assumed_data(name) for name in self.assumed],
            "evidence": [reason_data(reason) for reason in self.explain().because],
            "errors": list(self.errors),
            "database": self.database_hash,
        }

    def _fact_data(self, name: str) -> dict[str, Any]:
        declared = self.circumstances.vocabulary.facts.get(name)
        return {"fact": name, "meaning": declared.meaning if declared else ""}

    def _assumed_data(self, name: str) -> dict[str, Any]:
        declared = self.circumstances.vocabulary.fact(name)
        found = declared.assumption
        if found is None:
            return {"fact": name}
        return {"fact": name, "value": declared.show(found.value), "within": found.within, "because": found.because}


def rule_data(rule: Regulation) -> dict[str, Any]:
    """A regulation as a verdict's JSON form cites it."""
    return {
        "id": rule.id,
        "citation": rule.citation,
        "title": rule.title,
        "jurisdiction": rule.jurisdiction,
        "legality": rule.legality,
        "condition": rule.condition,
        "result": rule.result,
        "quote": rule.quote,
        "vagueness": rule.vagueness,
    }


def limit_data(item: LimitInForce) -> dict[str, Any]:
    """A limit in force: `value` in the law's own `unit`, `si` in SI, its force and where it comes from."""
    limit, rule = item.limit, item.regulation
    return {
        "attribute": limit.attribute,
        "fact": limit.fact,
        "direction": limit.direction,
        "value": float(show_number(from_si(item.bound, limit.unit))),
        "unit": limit.unit,
        "si": item.bound,
        "force": rule.force,
        "id": rule.id,
        "citation": rule.citation,
    }


def reason_data(reason: RuleReason) -> dict[str, Any]:
    """What one rule contributed, in JSON."""
    return {
        "id": reason.regulation.id,
        "role": reason.role,
        "holds": spell(reason.holds),
        "breach": spell(reason.breach),
        "literals": [
            {"literal": item.literal, "truth": spell(item.truth), "values": dict(item.values), "assumed": list(item.assumed)}
            for item in reason.evidence
        ],
        "defeated_by": list(reason.defeated_by),
        "change": [str(change) for change in reason.smallest_change],
    }
