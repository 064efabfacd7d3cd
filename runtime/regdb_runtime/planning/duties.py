"""The order of duties, for the moment when no plan keeps them all: what is broken last, and how far a plan breaks each.

Rules are told apart by what the law itself says of them: the topic of their section and the attributes they limit. No rule is named. Most
parts of the order follow the law's own weighing (rules that protect persons before rules of order); it is a choice of design all the same.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from regdb.meaning import LimitInForce
from regdb.regulation import Regulation
from regdb.vocabulary import Value
from regdb_runtime.verdict import Verdict


@dataclass(frozen=True, slots=True)
class Duty:
    """One duty: rules whose section has one of `topics`, or which limit one of `attributes`."""

    name: str
    topics: frozenset[str] = frozenset()
    attributes: frozenset[str] = frozenset()

    def covers(self, rule: Regulation) -> bool:
        """Whether a rule belongs to this duty."""
        return rule.topic in self.topics or any(limit.attribute in self.attributes for limit in rule.limits)


def _topics(words: str) -> frozenset[str]:
    return frozenset(words.split())


DUTIES: tuple[Duty, ...] = (
    Duty("persons on foot", _topics(
        "reckless-driving speed-contest pedestrian-crosswalk pedestrian-due-care blind-pedestrian pass-stopped-at-crosswalk school-bus "
        "safety-zone pass-streetcar sidewalk driving-on-sidewalk equestrian-crossing crosswalk-blocking"
    )),
    Duty("persons on bicycles and at work", _topics(
        "passing-bicycle turn-across-bicycle-lane bicycle-lane pass-animals pass-waste-service fire-hose"
    ), _topics("min_clearance")),
    Duty("rail tracks", _topics("rail-crossing-stop rail-crossing-stop-classes rail-stop-sign rail-stop-classes")),
    Duty("signals and stops", _topics(
        "red-signal signal-stop stop-sign flashing-signal signal-not-at-intersection lane-control-signal green-signal obey-signals "
        "obey-officers obey-traffic-directors alley-stop"
    )),
    Duty("right of way", _topics(
        "emergency-vehicle-yield emergency-vehicle-care stop-sign-right-of-way yield-sign intersection-right-of-way left-turn-yield "
        "entering-highway turn-safely start-backing blocking-intersection move-over u-turn-view"
    )),
    Duty("direction of travel", _topics("one-way drive-right divided-highway meeting-vehicles pass-clear-view pass-on-grade")),
    Duty("distance", _topics("follow-too-closely truck-following-distance follow-emergency-vehicle"), _topics("min_following_distance")),
    Duty("markings and passing", _topics(
        "double-lines laned-roadway lane-use three-lane-roadway two-way-left-turn-lane pass-left pass-on-right pass-return "
        "being-overtaken hov-lane transit-lane lane-splitting"
    )),
    Duty("speed", _topics(
        "basic-speed maximum-speed maximum-speed-70 minimum-speed prima-facie-limits work-zone-speed variable-speed bridge-speed speed-over-100"
    ), _topics("max_speed min_speed")),
    Duty("signs and turns", _topics(
        "obey-signs turn-signs turn-bans turn-position turn-signal u-turn-intersection u-turn-residence u-turn-business"
    )),
)  # fmt: skip
"""Weightiest first; what none of them covers stands after the last. Not to collide stands above all of these and is no rule of a verdict:
a plan that touches somebody is not among the candidates at all."""


def violations(verdict: Verdict, duties: Sequence[Duty] = DUTIES) -> tuple[float, ...]:
    """How far a plan breaks each duty (where the verdict is unknown: may break it), weightiest first, one more number for what none covers;
    compare as tuples, the least is chosen.

    A duty kept is 0. A limit passed counts by how far (0 to 1: the share of the bound by which the plan is beyond it), so that 5 mph too fast
    is less than 10; any other rule counts 1 for each topic broken, so that a model code's twin of an enacted rule adds nothing.
    """
    if verdict.verdict == "legal":
        return (0.0,) * (len(duties) + 1)
    return count(verdict.deciding, verdict.limits, verdict.plan.facts, duties)


def count(
    rules: Iterable[Regulation], limits: Iterable[LimitInForce], facts: Mapping[str, Value], duties: Sequence[Duty] = DUTIES
) -> tuple[float, ...]:
    """The same from the rules broken, the limits in force and the plan's facts."""
    bounds = {(item.regulation.id, item.limit.attribute): item for item in limits}
    worst: list[dict[str, float]] = [{} for _ in range(len(duties) + 1)]
    for rule in rules:
        place = next((index for index, duty in enumerate(duties) if duty.covers(rule)), len(duties))
        topic = rule.topic or rule.id
        amount = _amount(rule, bounds, facts)
        worst[place][topic] = max(worst[place].get(topic, 0.0), amount)
    return tuple(sum(found.values()) for found in worst)


def _amount(rule: Regulation, bounds: dict[tuple[str, str], LimitInForce], facts: Mapping[str, Value]) -> float:
    """How far one rule is broken."""
    found = 0.0
    for limit in rule.limits:
        item = bounds.get((rule.id, limit.attribute))
        value = facts.get(limit.fact)
        if item is None or not isinstance(value, (int, float)):
            return 1.0
        beyond = value - item.bound if limit.direction == "max" else item.bound - value
        found = max(found, min(max(beyond, 0.0) / max(abs(item.bound), 1e-9), 1.0))
    return found if rule.limits else 1.0
