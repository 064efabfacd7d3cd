"""Facts without a number in law, decided by a named interpretation from measured quantities, with the numbers used."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace

from regdb.interpretation import FORMULAS, SAFE, Decision, Interpretation
from regdb.situation import Plan, Scene
from regdb_runtime import formulas

Numbers = Mapping[str, float]
SIGNED = frozenset(("left_lateral_speed", "right_lateral_speed"))
"""Measures that may be negative."""


@dataclass(frozen=True, slots=True)
class Judgement:
    """What a profile says of a fact: true, false or None (not decided), and by which numbers, all in SI.

    `measured` was compared: its `quantity` (a gap, a distance) with what is `required`. `missing` are the measures without which the
    formula says nothing. `because` is one sentence for people.
    """

    fact: str
    profile: str
    value: bool | None
    formula: str = ""
    quantity: str = ""
    required: float | None = None
    measured: Numbers = field(default_factory=dict)
    parameters: Numbers = field(default_factory=dict)
    missing: tuple[str, ...] = ()
    because: str = ""


def judge(profile: Interpretation, fact: str, measured: Numbers) -> Judgement:
    """Decide one fact from measures in SI (see `regdb.interpretation.FORMULAS` for their names).

    Raises ValueError for a measure that is no finite number, or negative where that means nothing.
    """
    decision = profile.decision(fact)
    if not decision.formula:
        return Judgement(fact, profile.name, None, because=decision.because or f"{profile.name} never decides it")
    wanted = FORMULAS[decision.formula].measures
    held = {name: _checked(fact, name, measured[name]) for name in wanted if name in measured}
    missing = tuple(name for name in wanted if name not in held)
    numbers = {name: item.si for name, item in decision.parameters.items()}
    if missing:
        said = f"{', '.join(missing)} {'is' if len(missing) == 1 else 'are'} not known"
        return Judgement(fact, profile.name, None, decision.formula, measured=held, parameters=numbers, missing=missing, because=said)
    return _decided(profile, decision, held, numbers)


def decide(profile: Interpretation, fact: str, measured: Numbers) -> bool | None:
    """The value that `judge` gives, without its reasons: for those who ask often. Measures are taken for finite and unsigned as they come."""
    decision = profile.decisions.get(fact)
    if decision is None or not decision.formula or any(name not in measured for name in FORMULAS[decision.formula].measures):
        return None
    numbers = {name: item.si for name, item in decision.parameters.items()}
    return _value(decision, measured, numbers, *_REQUIRED[decision.formula](measured, numbers))


def judge_all(profile: Interpretation, measured: Mapping[str, Numbers]) -> tuple[Judgement, ...]:
    """Every fact the profile speaks of, from the measures given for it (fact -> measures). Raises ValueError as `judge` does."""
    return tuple(judge(profile, fact, measured.get(fact, {})) for fact in profile.decisions)


def interpreted(scene: Scene, plan: Plan, judgements: Iterable[Judgement]) -> tuple[Scene, Plan]:
    """Scene and plan with the facts that were decided and that nobody has told; facts of the plan go to the plan."""
    told = {item.fact: item.value for item in judgements if item.value is not None}
    told = {fact: value for fact, value in told.items() if fact not in scene.facts and fact not in plan.facts}
    of_plan = {fact: value for fact, value in told.items() if fact.startswith("plan.")}
    of_scene = {fact: value for fact, value in told.items() if fact not in of_plan}
    return replace(scene, facts={**scene.facts, **of_scene}), replace(plan, facts={**plan.facts, **of_plan})


def _checked(fact: str, name: str, value: float) -> float:
    if not math.isfinite(value) or (value < 0 and name not in SIGNED):
        raise ValueError(f"{fact}: {name} is {value}, which cannot be measured")
    return float(value)


def _decided(profile: Interpretation, decision: Decision, held: Numbers, numbers: Numbers) -> Judgement:
    quantity, required = _REQUIRED[decision.formula](held, numbers)
    value = _value(decision, held, numbers, quantity, required)
    relation = "less than" if held[quantity] < required else "at least"
    said = f"{quantity.replace('_', ' ')} {held[quantity]:.2f} m is {relation} the {required:.2f} m that {decision.formula} asks"
    if value is None:
        said += f", but above {numbers['up_to_speed']:.2f} m/s it asks for more without saying how much"
    return Judgement(decision.fact, profile.name, value, decision.formula, quantity, required, held, numbers, because=said)


def _value(decision: Decision, held: Numbers, numbers: Numbers, quantity: str, required: float) -> bool | None:
    """Whether the quantity falls short, in the sense of the fact; None where enough of it says nothing at this speed."""
    unsafe = held[quantity] < required
    limit = numbers.get("up_to_speed")
    if not unsafe and limit is not None and held["speed"] > limit:
        return None
    return unsafe is not (decision.true_when == SAFE)


def _rss_longitudinal(held: Numbers, numbers: Numbers) -> tuple[str, float]:
    return "gap", formulas.rss_longitudinal(held["rear_speed"], held["front_speed"], **numbers)


def _rss_opposite(held: Numbers, numbers: Numbers) -> tuple[str, float]:
    return "gap", formulas.rss_opposite(held["own_speed"], held["other_speed"], **numbers)


def _rss_yield(held: Numbers, numbers: Numbers) -> tuple[str, float]:
    return "other_distance", formulas.rss_yield(held["other_speed"], **numbers)


def _rss_lateral(held: Numbers, numbers: Numbers) -> tuple[str, float]:
    return "lateral_gap", formulas.rss_lateral(held["left_lateral_speed"], held["right_lateral_speed"], **numbers)


def _time_gap(held: Numbers, numbers: Numbers) -> tuple[str, float]:
    return "gap", held["rear_speed"] * numbers["least_time"]


def _arrival_gap(held: Numbers, numbers: Numbers) -> tuple[str, float]:
    return "other_distance", held["other_speed"] * numbers["least_time"]


def _stop_in_sight(held: Numbers, numbers: Numbers) -> tuple[str, float]:
    return "sight_distance", formulas.stopping_distance(held["speed"], **numbers)


def _clearance(held: Numbers, numbers: Numbers) -> tuple[str, float]:  # noqa: ARG001  # one form for all
    return "lateral_gap", numbers["least_clearance"]


_REQUIRED: Mapping[str, Callable[[Numbers, Numbers], tuple[str, float]]] = {
    "rss_longitudinal": _rss_longitudinal, "rss_opposite": _rss_opposite, "rss_yield": _rss_yield, "rss_lateral": _rss_lateral,
    "time_gap": _time_gap, "arrival_gap": _arrival_gap, "stop_in_sight": _stop_in_sight, "clearance": _clearance,
}  # fmt: skip
"""Formula -> the measure it compares, and the length in metres that measure must reach."""
