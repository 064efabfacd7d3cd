"""Speed limits along a path before anything is sampled: the law's, those it may impose, and what the interpretation calls safe."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from regdb.condition import linear_value
from regdb.interpretation import Interpretation
from regdb.meaning import UNKNOWN, Judgement
from regdb.regulation import NO_LIMIT_IN_FORCE, Regulation
from regdb.situation import Plan, Situation
from regdb.vocabulary import Value
from regdb_runtime.assessment.alike import Distinguished
from regdb_runtime.assessment.judged_facts import decided_by
from regdb_runtime.assessment.settings import AssessmentSettings
from regdb_runtime.index.slots import PreparedScene
from regdb_runtime.maneuver import Maneuver
from regdb_runtime.planning.goal import SpeedCap
from regdb_runtime.scenes.stretch import Stretch
from regdb_runtime.verdict import Verdict

SPEED = "plan.speed"
Cap = tuple[float, str]
"""A speed (m/s) and what asks for it."""


REMEMBERED = 1024
"""Answers kept: scenes stay the same from tick to tick, and so do the limits on them."""


class Caps:
    """Finds what binds the speed on each stretch; the law is asked once for the facts that its speed limits hang on."""

    def __init__(self, settings: AssessmentSettings, profile: Interpretation | None, distinguished: Distinguished) -> None:
        self.settings, self.profile, self._distinguished = settings, profile, distinguished
        self._known: dict[tuple[object, ...], tuple[PreparedScene, Cap | None]] = {}
        self._facts: dict[int, tuple[tuple[Regulation, ...], frozenset[str]]] = {}

    def of(self, maneuver: Maneuver, stretches: Sequence[Stretch], shared: Mapping[str, Value]) -> tuple[SpeedCap, ...]:
        """The caps along the path; neighbouring stretches with the same one are joined. Stretches without limit have none."""
        found: list[SpeedCap] = []
        for stretch in stretches:
            cap = self._strictest(maneuver, stretch, shared)
            if cap is None:
                continue
            speed, rule = cap
            held = found[-1] if found else None
            if held is not None and held.end == stretch.start and held.speed == speed and held.rule == rule:
                found[-1] = SpeedCap(held.start, stretch.end, speed, rule)
            else:
                found.append(SpeedCap(stretch.start, stretch.end, speed, rule))
        return tuple(found)

    def _strictest(self, maneuver: Maneuver, stretch: Stretch, shared: Mapping[str, Value]) -> Cap | None:
        """The law's, remembered, and what the profile asks."""
        rules = stretch.view.concerned(maneuver.current, maneuver.next)
        asked, roles = self._asked_of(rules), stretch.roles
        told = frozenset((name, shared.get(name, roles.get(name))) for name in asked & (roles.keys() | shared.keys()))
        key = id(stretch.prepared), id(rules), told
        held = self._known.get(key)
        if held is None or held[0] is not stretch.prepared:
            if len(self._known) >= REMEMBERED:
                self._known.clear()
            held = self._known[key] = stretch.prepared, self._of_law(maneuver, stretch, shared)
        return min((cap for cap in (held[1], self._seen_clear(stretch)) if cap is not None), default=None)

    def _asked_of(self, rules: tuple[Regulation, ...]) -> frozenset[str]:
        """Facts on which speed limits among some rules hang, through whatever defeats them too."""
        held = self._facts.get(id(rules))
        if held is None or held[0] is not rules:
            held = self._facts[id(rules)] = rules, frozenset(_facts_of_limits(rules, self._distinguished))
        return held[1]

    def _of_law(self, maneuver: Maneuver, stretch: Stretch, shared: Mapping[str, Value]) -> Cap | None:
        facts: dict[str, Value] = {**stretch.roles, **shared, SPEED: 0.0}
        verdict = stretch.view.judge(stretch.prepared, Plan(maneuver.current, maneuver.next, facts))
        found = [(item.bound, item.regulation.citation) for item in verdict.limits if _caps_speed(item.limit.fact, item.limit.direction)]
        least = min((bound for bound, _ in found), default=math.inf)
        found += self._possible(maneuver, stretch, facts, least)
        return min(found, default=None)

    def _possible(self, maneuver: Maneuver, stretch: Stretch, facts: dict[str, Value], bound: float) -> list[Cap]:
        """Limits below a bound that rules impose if something not known should hold: at the bound, their breach is not known."""
        at_bound = {**facts, SPEED: min(bound, _FASTER_THAN_ANY_LIMIT)}
        verdict = stretch.view.judge(stretch.prepared, Plan(maneuver.current, maneuver.next, at_bound))
        if verdict.verdict == UNKNOWN:
            return _bounds(verdict.deciding, verdict)
        return _bounds(_undecided(verdict), verdict) if verdict.deciding and verdict.verdict != "legal" else []

    def _seen_clear(self, stretch: Stretch) -> Cap | None:
        """The speed from which the vehicle can stop within the road seen to be clear, where the profile asks it."""
        decision = decided_by(self.profile, "speed.unsafe_for_conditions")
        if decision is None or decision.formula != "stop_in_sight":
            return None
        sight = stretch.measures.get("speed.unsafe_for_conditions", {}).get("sight_distance", self.settings.sensing_range)
        response, braking = decision.parameters["response_time"].si, decision.parameters["min_braking"].si
        speed = braking * (math.sqrt(response * response + 2.0 * sight / braking) - response)
        return speed, f"{self.profile.name}: {decision.because}" if self.profile is not None else ""


_FASTER_THAN_ANY_LIMIT = 100.0
"""m/s at which every limit of a road is broken."""


def _facts_of_limits(rules: Sequence[Regulation], distinguished: Distinguished) -> set[str]:
    """Facts that decide whether a limit on speed among these rules is in effect, and its bound."""
    defeaters: dict[str, list[Regulation]] = {}
    for rule in rules:
        for target in rule.targets:
            defeaters.setdefault(target, []).append(rule)
    queue = [rule for rule in rules if any(_caps_speed(limit.fact, limit.direction) for limit in rule.limits)]
    seen: dict[int, Regulation] = {}
    while queue:
        rule = queue.pop()
        if id(rule) not in seen:
            seen[id(rule)] = rule
            queue += defeaters.get(rule.id, [])
    return {fact for rule in seen.values() for fact in distinguished.facts(rule)} - {SPEED}


def _caps_speed(fact: str, direction: str) -> bool:
    return fact == SPEED and direction == "max"


def _undecided(verdict: Verdict) -> list[Regulation]:
    """Rules with a limit on speed whose effect is not known, by the reference: a verdict that is unlawful anyway does not name them."""
    judgement: Judgement = verdict.judgement
    limiting = [rule for rule in judgement.concerned if any(_caps_speed(limit.fact, limit.direction) for limit in rule.limits)]
    return [rule for rule in limiting if judgement.effective(rule) is None]


def _bounds(rules: Sequence[Regulation], verdict: Verdict) -> list[Cap]:
    situation = Situation(verdict.circumstances.vocabulary, verdict.scene, verdict.plan)
    found = []
    for rule in rules:
        for limit in rule.limits if not rule.legality and rule.force not in NO_LIMIT_IN_FORCE else ():
            bound = linear_value(limit.bound, situation) if _caps_speed(limit.fact, limit.direction) else None
            if bound is not None:
                found.append((bound, f"{rule.citation} (may apply)"))
    return found
