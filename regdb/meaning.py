"""What a rule means: holds, defeated, effective, breaks, verdict, written as plainly as section 4 of the design says it.

This is the reference. The runtime's index answers the same and is tested against it; explanations are built from it.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property

from regdb.condition import COMPARISONS, evaluate, linear_value, unknown_facts
from regdb.jurisdiction import JurisdictionTree
from regdb.regulation import NO_LIMIT_IN_FORCE, Limit, Regulation
from regdb.situation import Situation
from regdb.truth import Truth, conjoin, disjoin, negate

LEGAL, ILLEGAL, UNKNOWN = "legal", "illegal", "unknown"


@dataclass(frozen=True, slots=True)
class LimitInForce:
    """A limit that binds now, resolved to a number in SI; `attribute`'s strictest one decides."""

    limit: Limit
    bound: float
    regulation: Regulation


@dataclass(frozen=True)
class Decision:
    """The answer for one transition: the verdict, the rules that decided it, the limits in force, what was assumed.

    `deciding`: illegal - the rules broken; unknown - the rules whose breach is unknown; legal - the exceptions in effect
    against rules that would hold. `possible` are limits of rules that may be in effect, for a planner that takes the strict reading.
    """

    verdict: str
    deciding: tuple[Regulation, ...]
    limits: tuple[LimitInForce, ...]
    possible: tuple[LimitInForce, ...]
    missing: tuple[str, ...]
    assumed: tuple[str, ...]

    @property
    def combined(self) -> dict[str, LimitInForce]:
        """Attribute -> its strictest limit in force: of the max_ the least, of the min_ the greatest."""
        return combine(self.limits)


def combine(limits: Iterable[LimitInForce]) -> dict[str, LimitInForce]:
    """Attribute -> strictest; of equal bounds the first by citation order of arrival."""
    found: dict[str, LimitInForce] = {}
    for item in limits:
        held = found.get(item.limit.attribute)
        if held is None or (item.bound < held.bound if item.limit.direction == "max" else item.bound > held.bound):
            found[item.limit.attribute] = item
    return found


def governing(regulations: Iterable[Regulation], tree: JurisdictionTree, place: str, day: int) -> tuple[Regulation, ...]:
    """The rules in force on the day that govern the place, sorted by id; a model code's only where no enacted code governs."""
    items = tuple(regulations)
    ids = tree.governing(place, frozenset(item.jurisdiction for item in items))
    return tuple(sorted((r for r in items if r.jurisdiction in ids and r.in_force(day)), key=lambda r: r.id))


class Judgement:
    """The rules of a place and day applied to one situation; every step of the meaning is a method here."""

    def __init__(self, rules: Sequence[Regulation], situation: Situation) -> None:
        plan = situation.plan
        self.rules, self.situation = rules, situation
        self.concerned = tuple(rule for rule in rules if rule.concerns(plan.current, plan.next))
        self._defeaters: dict[str, list[Regulation]] = {}
        for rule in self.concerned:
            for target in rule.targets:
                self._defeaters.setdefault(target, []).append(rule)
        self._effective: dict[str, Truth] = {}

    def holds(self, rule: Regulation) -> Truth:
        """when and not unless; date, place and states are settled by which rules are concerned."""
        unless: Truth = False if rule.unless is None else evaluate(rule.unless, self.situation)
        return conjoin((evaluate(rule.when, self.situation), negate(unless)))

    def defeaters(self, rule: Regulation) -> list[Regulation]:
        """The rules whose exception_to or overrides name this one."""
        return self._defeaters.get(rule.id, [])

    def defeated(self, rule: Regulation) -> Truth:
        return disjoin(self.effective(other) for other in self.defeaters(rule))

    def effective(self, rule: Regulation) -> Truth:
        """holds and not defeated. The relation is acyclic: the compiler refuses cycles."""
        if rule.id not in self._effective:
            self._effective[rule.id] = conjoin((self.holds(rule), negate(self.defeated(rule))))
        return self._effective[rule.id]

    def beyond(self, limit: Limit) -> Truth:
        """Whether the plan's quantity is past the bound; unknown when either number is."""
        quantity, bound = self.situation.value(limit.fact), linear_value(limit.bound, self.situation)
        if quantity is None or bound is None:
            return None
        return COMPARISONS[">" if limit.direction == "max" else "<"](float(quantity), bound)  # type: ignore[arg-type]

    def breaks(self, rule: Regulation) -> Truth:
        """A permission and an advisory limit are never broken; a prohibition is while in effect, a limit when passed too."""
        if rule.legality or rule.force == "advisory":
            return False
        if not rule.limits:
            return self.effective(rule)
        return conjoin((self.effective(rule), disjoin(self.beyond(limit) for limit in rule.limits)))

    @cached_property
    def decision(self) -> Decision:
        breaches = [(rule, self.breaks(rule)) for rule in self.concerned]
        broken = tuple(rule for rule, breach in breaches if breach is True)
        undecided = tuple(rule for rule, breach in breaches if breach is None)
        verdict = ILLEGAL if broken else UNKNOWN if undecided else LEGAL
        deciding = broken or undecided or self._exceptions_in_effect()
        missing = self.missing(undecided) if verdict == UNKNOWN else ()
        return Decision(verdict, deciding, self._limits(wanted=True), self._limits(wanted=None), missing, self._assumed())

    def _exceptions_in_effect(self) -> tuple[Regulation, ...]:
        held = {rule.id for rule in self.concerned if self.holds(rule) is True}
        return tuple(r for r in self.concerned if self.effective(r) is True and any(t in held for t in r.targets))

    def _limits(self, *, wanted: Truth) -> tuple[LimitInForce, ...]:
        found = []
        for rule in self.concerned:
            if rule.limits and rule.force not in NO_LIMIT_IN_FORCE and self.effective(rule) is wanted:
                for limit in rule.limits:
                    bound = linear_value(limit.bound, self.situation)
                    if bound is not None:
                        found.append(LimitInForce(limit, bound, rule))
        return tuple(found)

    def missing(self, rules: Iterable[Regulation]) -> tuple[str, ...]:
        """Facts not known on which the undecided rules, their bounds and their exceptions hang."""
        names: list[str] = []
        for rule in self._with_defeaters(rules):
            if self.holds(rule) is None:
                names += unknown_facts(rule.when, self.situation)
                names += unknown_facts(rule.unless, self.situation) if rule.unless is not None else ()
            if self.effective(rule) is not False and not rule.legality:
                for limit in rule.limits:
                    facts = (limit.fact, *(fact for _, fact in limit.bound.terms))
                    names += [fact for fact in facts if self.situation.value(fact) is None]
        return tuple(dict.fromkeys(names))

    def _with_defeaters(self, rules: Iterable[Regulation]) -> list[Regulation]:
        queue, seen = list(rules), set()
        found: list[Regulation] = []
        while queue:
            rule = queue.pop(0)
            if rule.id not in seen:
                seen.add(rule.id)
                found.append(rule)
                queue += [other for other in self.defeaters(rule) if self.effective(other) is None]
        return found

    def _assumed(self) -> tuple[str, ...]:
        facts = dict.fromkeys(fact for rule in self.concerned for fact in rule.facts)
        situation = self.situation
        return tuple(sorted(f for f in facts if situation.observed(f) is None and situation.assumed(f) is not None))


def decide(rules: Sequence[Regulation], situation: Situation) -> Decision:
    """The reference verdict for a situation under the rules of one place and day (see `governing`)."""
    return Judgement(rules, situation).decision
