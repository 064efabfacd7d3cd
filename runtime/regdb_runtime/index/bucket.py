"""The rules of one transition, sorted by what deciding needs of them, and their decision over a flat list of values."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass
from functools import cached_property

from regdb.meaning import ILLEGAL, LEGAL, UNKNOWN, LimitInForce
from regdb.regulation import NO_LIMIT_IN_FORCE, Regulation
from regdb_runtime.index.closures import Bounds, Condition, beyond, bounds, condition
from regdb_runtime.index.conjuncts import Conjuncts, conjuncts
from regdb_runtime.index.slots import FactTable, Values

Found = tuple[str, tuple[Regulation, ...], tuple[LimitInForce, ...]]
"""Verdict, deciding rules, limits in force."""
Decide = Callable[[Values], Found]
Finish = Callable[[list[int], list[int], list[int], Collection[int], Values], Found]
"""Indices of the rules broken, undecided, bringing limits, and of exceptions in effect, with the values -> the answer."""


@dataclass(frozen=True, slots=True)
class Part:
    """What one rule can do in this bucket: be broken, bring limits, be defeated, defeat."""

    index: int
    rule: Regulation
    breakable: bool
    limiting: bool
    defeaters: tuple[int, ...]
    targets: tuple[int, ...]

    @property
    def tangled(self) -> bool:
        """Whether it defeats, or is defeated by, another rule of the bucket."""
        return bool(self.defeaters or self.targets)

    @property
    def waits(self) -> bool:
        """Whether it matters only once one of its targets may hold (or never): it need not be looked at before."""
        return not (self.breakable or self.limiting or self.defeaters)


class Bucket:
    """The rules that concern one transition at one place and day, in the order of their ids."""

    def __init__(self, rules: Sequence[Regulation], table: FactTable) -> None:
        self.rules, self.table = tuple(rules), table
        self.parts = _parts(self.rules)
        self.candidates = tuple(part for part in self.parts if not part.waits)
        self._conditions: dict[int, Condition] = {}
        self._beyond: dict[int, Condition] = {}
        self.bounds: dict[int, Bounds] = {part.index: bounds(part.rule, table) for part in self.parts if part.limiting}

    @cached_property
    def conjuncts(self) -> dict[int, Conjuncts]:
        """Index -> the parts that must hold, for every rule that is looked at first."""
        return {part.index: conjuncts(part.rule) for part in self.candidates}

    def condition(self, index: int) -> Condition:
        """The exact truth of a rule's `when and not unless`."""
        found = self._conditions.get(index)
        if found is None:
            rule = self.rules[index]
            when = condition(rule.when, self.table)
            found = self._conditions[index] = when if rule.unless is None else _unless(when, condition(rule.unless, self.table))
        return found

    def beyond(self, index: int) -> Condition:
        """Whether the plan is past a limit of the rule."""
        found = self._beyond.get(index)
        if found is None:
            found = self._beyond[index] = beyond(self.rules[index], self.table)
        return found

    @cached_property
    def finish(self) -> Finish:
        """The function that turns indices into the answer: rules in the order of their ids, limits in that of their rules."""
        bounds, rule_at = self.bounds, self.rules.__getitem__
        fixed = {part.index: bounds[part.index]([]) for part in self.parts if part.limiting and _is_fixed(part.rule)}

        def finish(
            broken: list[int], undecided: list[int], limiting: list[int], excepting: Collection[int], values: Values
        ) -> Found:
            limits: tuple[LimitInForce, ...] = ()
            if limiting:
                if len(limiting) > 1:
                    limiting.sort()
                for index in limiting:
                    limits += fixed.get(index) or bounds[index](values)
            verdict, chosen = (ILLEGAL, broken) if broken else (UNKNOWN, undecided) if undecided else (LEGAL, sorted(excepting))
            if len(chosen) > 1:
                chosen.sort()
            return verdict, tuple(map(rule_at, chosen)), limits

        return finish


def _is_fixed(rule: Regulation) -> bool:
    return all(not limit.bound.terms for limit in rule.limits)


def _parts(rules: tuple[Regulation, ...]) -> tuple[Part, ...]:
    places: dict[str, list[int]] = {}
    for index, rule in enumerate(rules):
        places.setdefault(rule.id, []).append(index)
    targets = [tuple(i for target in dict.fromkeys(rule.targets) for i in places.get(target, ())) for rule in rules]
    defeaters: list[list[int]] = [[] for _ in rules]
    for index, aimed in enumerate(targets):
        for target in aimed:
            defeaters[target].append(index)
    return tuple(
        Part(
            index,
            rule,
            breakable=not rule.legality and rule.force != "advisory",
            limiting=bool(rule.limits) and rule.force not in NO_LIMIT_IN_FORCE,
            defeaters=tuple(defeaters[index]),
            targets=targets[index],
        )
        for index, rule in enumerate(rules)
    )


def _unless(when: Condition, unless: Condition) -> Condition:
    def run(values: Values) -> bool | None:
        held = when(values)
        if held is False:
            return False
        excluded = unless(values)
        if excluded is True:
            return False
        return None if held is None or excluded is None else True

    return run
