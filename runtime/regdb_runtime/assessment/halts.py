"""Places ahead past which the law lets no plan go now: a crosswalk with somebody in it, a school bus, rails; found before plans are sampled."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from regdb.regulation import Regulation
from regdb.situation import Plan
from regdb.vocabulary import Value
from regdb_runtime.assessment.alike import Distinguished
from regdb_runtime.index.slots import PreparedScene
from regdb_runtime.maneuver import Maneuver
from regdb_runtime.planning.goal import StopPoint
from regdb_runtime.scenes.stretch import Stretch

PASSES: Mapping[str, str] = {
    "plan.enters_crosswalk": "crosswalk", "plan.enters_rail_crossing": "rail", "plan.passes_school_bus": "bus",
}  # fmt: skip
"""Facts that say whether the front bumper passes a place, and the name of that place in a stretch. Lines of junctions are the strategist's."""
BRAKING = 3.5
"""m/s2; a stop that asks for more is not made a goal of: each plan is then judged by itself. Firm, yet no emergency (ITE's 3.4 m/s2 deceleration)."""
REMEMBERED = 1024
"""Answers kept: the same scene asks the same from tick to tick."""


class Halts:
    """Finds where to stop; the law is asked once for the facts that its answer hangs on."""

    def __init__(self, distinguished: Distinguished) -> None:
        self._distinguished = distinguished
        self._known: dict[tuple[object, ...], tuple[PreparedScene, str]] = {}
        self._facts: dict[tuple[int, str], tuple[tuple[Regulation, ...], frozenset[str]]] = {}

    def of(self, maneuver: Maneuver, stretches: Sequence[Stretch], shared: Mapping[str, Value], speed: float) -> StopPoint | None:
        """The nearest such place that firm braking from `speed` (m/s) still stops before, None without one."""
        if not stretches:
            return None
        front, found = stretches[0].start, None
        for stretch in stretches:
            for fact, name in PASSES.items():
                place = getattr(stretch, name)
                if place is None or speed * speed > 2 * BRAKING * (place - front) or (found is not None and place >= found.station):
                    continue
                rule = self._forbids(maneuver, stretch, shared, fact)
                if rule:
                    found = StopPoint(place, rule)
        return found

    def _forbids(self, maneuver: Maneuver, stretch: Stretch, shared: Mapping[str, Value], fact: str) -> str:
        """The rule that forbids to pass a place, empty where none does."""
        rules = stretch.view.concerned(maneuver.current, maneuver.next)
        asked = self._asked_of(rules, fact)
        if not asked:
            return ""
        roles = stretch.roles
        told = frozenset((name, shared.get(name, roles.get(name))) for name in asked & (roles.keys() | shared.keys()))
        key = fact, id(stretch.prepared), id(rules), told
        held = self._known.get(key)
        if held is None or held[0] is not stretch.prepared:
            if len(self._known) >= REMEMBERED:
                self._known.clear()
            held = self._known[key] = stretch.prepared, self._of_law(maneuver, stretch, shared, fact)
        return held[1]

    def _of_law(self, maneuver: Maneuver, stretch: Stretch, shared: Mapping[str, Value], fact: str) -> str:
        """What is broken by a plan that passes and not by one that stays before the place."""
        facts: dict[str, Value] = {**stretch.roles, **shared, **dict.fromkeys(PASSES, False), "plan.speed": 0.0}
        stays, passes = (
            stretch.view.judge(stretch.prepared, Plan(maneuver.current, maneuver.next, {**facts, fact: does})) for does in (False, True)
        )  # fmt: skip
        if passes.verdict != "illegal":
            return ""
        anyway = {rule.id for rule in stays.deciding} if stays.verdict == "illegal" else set()
        return next((rule.citation for rule in passes.deciding if rule.id not in anyway), "")

    def _asked_of(self, rules: tuple[Regulation, ...], fact: str) -> frozenset[str]:
        """Facts on which rules that read this one hang, through whatever defeats them too."""
        held = self._facts.get((id(rules), fact))
        if held is None or held[0] is not rules:
            held = self._facts[id(rules), fact] = rules, frozenset(self._closure(rules, fact))
        return held[1]

    def _closure(self, rules: Sequence[Regulation], fact: str) -> set[str]:
        defeaters: dict[str, list[Regulation]] = {}
        for rule in rules:
            for target in rule.targets:
                defeaters.setdefault(target, []).append(rule)
        queue = [rule for rule in rules if fact in self._distinguished.facts(rule)]
        seen: dict[int, Regulation] = {}
        while queue:
            rule = queue.pop()
            if id(rule) not in seen:
                seen[id(rule)] = rule
                queue += defeaters.get(rule.id, [])
        return {name for rule in seen.values() for name in self._distinguished.facts(rule)} - {fact}
