"""Facts of a plan that the law leaves to judgement, decided for many plans at once by the interpretation in use.

The formulas are those of `regdb_runtime.formulas`, over arrays; a fact the profile does not decide stays unknown.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from regdb.interpretation import SAFE, Decision, Interpretation
from regdb_runtime.assessment.measured import Bools, Column, word
from regdb_runtime.assessment.others import Pass
from regdb_runtime.assessment.settings import AssessmentSettings
from regdb_runtime.trajectory import Floats

Needs = Callable[[Floats, Floats, Mapping[str, float]], Floats]
UNDECIDED, NO, YES = -1, 0, 1


def _rss_longitudinal(rear: Floats, front: Floats, numbers: Mapping[str, float]) -> Floats:
    response, most = numbers["response_time"], numbers["max_acceleration"]
    reached = rear + most * response
    covered = rear * response + most * response**2 / 2
    return np.maximum(0.0, covered + reached**2 / (2 * numbers["min_braking"]) - front**2 / (2 * numbers["max_braking"]))


def _time_gap(rear: Floats, front: Floats, numbers: Mapping[str, float]) -> Floats:  # noqa: ARG001  # one form for all
    return np.asarray(rear * numbers["least_time"])


_BEHIND: Mapping[str, Needs] = {"rss_longitudinal": _rss_longitudinal, "time_gap": _time_gap}
"""Formula -> the gap needed at the speeds of the vehicle behind and the one ahead."""


def _rss_lateral(left: Floats, right: Floats, numbers: Mapping[str, float]) -> Floats:
    response, most = numbers["response_time"], numbers["max_lateral_acceleration"]
    braking = 2 * numbers["min_lateral_braking"]
    left_reached, right_reached = left + most * response, right - most * response
    left_covered, right_covered = left * response + most * response**2 / 2, right * response - most * response**2 / 2
    space = left_covered + left_reached**2 / braking - (right_covered - right_reached**2 / braking)
    return numbers["fluctuation_margin"] + np.maximum(0.0, space)


def following_unsafe(
    decision: Decision, gap: Floats, speed: Floats, lead_speed: Floats, step: float, settings: AssessmentSettings
) -> Column | None:
    """Whether the distance kept to the vehicle ahead falls short, (k,); gap and speeds (k, T), the gap infinite while not behind him, `step` in
    seconds. None when the profile does not say.

    Short at any instant is short. Of a gap that is too small from the first (another has cut in) it is asked that it be restored: once the
    vehicle has had time to respond it is no smaller than it was, measured by what is needed, and at the end of the plan it has grown, unless
    the vehicle all but stands. Nobody can do more.
    """
    needs = _BEHIND.get(decision.formula)
    if needs is None:
        return None
    margin = gap - needs(speed, np.broadcast_to(np.maximum(lead_speed, 0.0), speed.shape), _numbers(decision))
    now = margin[:, 0]
    responded = min(round(settings.response / step), margin.shape[1] - 1)
    falls_short = margin.min(axis=1) < -settings.line_tolerance
    stands = speed[:, -1] <= settings.crawl
    grown = (margin[:, -1] >= 0.0) | (margin[:, -1] >= now + settings.recovery) | stands
    restored = (now < 0.0) & grown & (margin[:, responded:].min(axis=1) >= now - settings.line_tolerance)
    return _decided(decision, np.asarray(falls_short & ~restored))


def unsafe_pass(decision: Decision, going: Pass, step: float, speed: Floats) -> Column | None:
    """Whether the gap to the side of what is passed falls short at any instant alongside, (k,). None when the profile does not say."""
    gap, numbers, passed = going.side_gap, _numbers(decision), going.other
    if decision.formula == "rss_lateral":
        middle = (going.plans.left + going.plans.right) / 2
        own, other = -_rate(middle, step), -_rate(passed.middle, step)
        on_left = middle > passed.middle
        need = _rss_lateral(np.where(on_left, own, other), np.where(on_left, other, own), numbers)
        return _decided(decision, np.asarray((gap < need).any(axis=1)))
    if decision.formula == "clearance":
        short = (gap < numbers["least_clearance"]).any(axis=1)
        too_fast = (np.isfinite(gap) & (speed > numbers["up_to_speed"])).any(axis=1) if "up_to_speed" in numbers else False
        return _decided(decision, np.asarray(short), np.asarray(~short & too_fast))
    return None


def _rate(values: Floats, step: float) -> Floats:
    """Change per second over the last axis, between each instant and the one before; the first as the second."""
    found = np.empty_like(values)
    np.subtract(values[..., 1:], values[..., :-1], out=found[..., 1:])
    found[..., 0] = found[..., 1]
    found /= step
    return found


def too_fast_to_stop(decision: Decision, speed: Floats, sight: float) -> Column | None:
    """Whether stopping from each plan's greatest speed, (k,), takes more than the road seen to be clear. None when the profile does not say."""
    if decision.formula != "stop_in_sight":
        return None
    numbers = _numbers(decision)
    need = speed * numbers["response_time"] + speed**2 / (2 * numbers["min_braking"])
    return _decided(decision, np.asarray(need > sight))


def decided_by(profile: Interpretation | None, fact: str) -> Decision | None:
    """How the profile decides a fact; None when it does not."""
    decision = profile.decision(fact) if profile is not None else None
    return decision if decision is not None and decision.formula in {*_BEHIND, "rss_lateral", "clearance", "stop_in_sight"} else None


def _numbers(decision: Decision) -> dict[str, float]:
    return {name: item.si for name, item in decision.parameters.items()}


def _decided(decision: Decision, unsafe: Bools, undecided: Bools | None = None) -> Column:
    held = ~unsafe if decision.true_when == SAFE else unsafe
    places = np.where(held, YES, NO)
    return word(places if undecided is None else np.where(undecided, UNDECIDED, places), (False, True))
