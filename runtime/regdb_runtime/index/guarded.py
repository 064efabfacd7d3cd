"""Judging when a rule cannot be evaluated: a prohibition then counts as broken, a permission as not given, and both are told."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from regdb.meaning import Judgement, LimitInForce
from regdb.regulation import Regulation
from regdb.situation import Plan, Scene, Situation
from regdb.truth import Truth
from regdb.vocabulary import FactError, Value
from regdb_runtime.index.slots import FactTable


class CheckedSituation(Situation):
    """A situation in which reading a value of the wrong type raises FactError."""

    def __init__(self, table: FactTable, scene: Scene, plan: Plan) -> None:
        scene_facts, lost, wrong = table.tidy(scene.facts)
        plan_facts, lost_too, wrong_too = table.tidy(plan.facts)
        tidied = Scene(scene_facts, scene.silent | lost | lost_too)
        super().__init__(table.vocabulary, tidied, Plan(plan.current, plan.next, plan_facts))
        self.wrong = (*wrong, *wrong_too)
        self._table = table

    def observed(self, fact: str) -> Value | None:
        value = super().observed(fact)
        if self.wrong and value is not None:
            problems = self._table.tidy({fact: value})[2]
            if problems:
                raise FactError(problems[0])
        return value


class GuardedJudgement(Judgement):
    """The reference judgement, except that what raises fails closed; `errors` says which rule and why."""

    def __init__(self, rules: Sequence[Regulation], situation: Situation) -> None:
        super().__init__(rules, situation)
        self._errors: dict[str, str] = {}

    @property
    def errors(self) -> tuple[str, ...]:
        """One sentence per rule that could not be evaluated."""
        return tuple(self._errors.values())

    def holds(self, rule: Regulation) -> Truth:
        try:
            return super().holds(rule)
        except Exception as error:  # noqa: BLE001  # whatever goes wrong in a rule must not make anything lawful
            self._note(rule, error)
            return not rule.legality

    def breaks(self, rule: Regulation) -> Truth:
        try:
            return super().breaks(rule)
        except Exception as error:  # noqa: BLE001
            self._note(rule, error)
            return not rule.legality

    def missing(self, rules: Iterable[Regulation]) -> tuple[str, ...]:
        try:
            return super().missing(rules)
        except Exception:  # noqa: BLE001  # the rule's own error has been noted
            return ()

    def _limits(self, *, wanted: Truth) -> tuple[LimitInForce, ...]:
        found: list[LimitInForce] = []
        for rule in self.concerned:
            if self.effective(rule) is wanted:
                found += self._limits_of(rule, wanted)
        return tuple(found)

    def _limits_of(self, rule: Regulation, wanted: Truth) -> list[LimitInForce]:
        single = GuardedJudgement((rule,), self.situation)
        single._effective[rule.id] = wanted
        try:
            return list(Judgement._limits(single, wanted=wanted))
        except Exception as error:  # noqa: BLE001
            self._note(rule, error)
            return []

    def _assumed(self) -> tuple[str, ...]:
        facts = dict.fromkeys(fact for rule in self.concerned for fact in rule.facts)
        return tuple(sorted(fact for fact in facts if self._is_assumed(fact)))

    def _is_assumed(self, fact: str) -> bool:
        try:
            return self.situation.observed(fact) is None and self.situation.assumed(fact) is not None
        except FactError:
            return False

    def _note(self, rule: Regulation, error: Exception) -> None:
        taken = "permits nothing" if rule.legality else "counts as broken"
        self._errors.setdefault(rule.id, f"{rule.citation or rule.id} could not be evaluated and {taken}: {error}")


def judge_guarded(rules: Sequence[Regulation], table: FactTable, scene: Scene, plan: Plan) -> tuple[GuardedJudgement, tuple[str, ...]]:
    """The judgement of one transition with every failure closed, and what went wrong, each once."""
    situation = CheckedSituation(table, scene, plan)
    judgement = GuardedJudgement(rules, situation)
    _ = judgement.decision
    return judgement, tuple(dict.fromkeys((*judgement.errors, *situation.wrong)))
