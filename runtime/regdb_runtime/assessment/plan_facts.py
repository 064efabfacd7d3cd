"""Measures what plans say of themselves in the law's words, for many plans of one manoeuvre at once.

Claimed here: speed, clearance, following_distance, passing_distance, the distances in bicycle and opposing lanes, entering of intersection,
crosswalk, rail crossing and passing of a school bus, crosses_marking, drives_left_of_center, leaves_roadway, straddles_lanes, uses_sidewalk,
passes with its side and lane, unsafe_pass, reduces_speed, speeds_up, slows_suddenly, stop_reason, stop_places, turn_purpose, prepares_turn,
turn_lane, exit_lane, no_room_for_three_feet; and the facts of others that hang on the plan: lead.following_unsafe,
bicycle.endangered_by_pass, speed.unsafe_for_conditions. All others are left to what the scene tells or the vocabulary assumes.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from regdb.interpretation import Interpretation
from regdb.vocabulary import Value
from regdb_runtime.assessment import driven_over, judged_facts, others, passing
from regdb_runtime.assessment.cross_section import CrossSections
from regdb_runtime.assessment.extents import Extents, extents
from regdb_runtime.assessment.measured import Bools, Column, OfStretch, PlanFacts, number, truth
from regdb_runtime.assessment.others import Other
from regdb_runtime.assessment.passing import Passing
from regdb_runtime.assessment.settings import AssessmentSettings
from regdb_runtime.assessment.stopping import stop_places
from regdb_runtime.maneuver import Maneuver
from regdb_runtime.observation import Footprint
from regdb_runtime.planning.prediction import Predictions
from regdb_runtime.scenes.stretch import Stretch
from regdb_runtime.trajectory import Candidates, Floats

BESIDE = 15.0
"""Metres beside the path within which somebody may be overtaken: four lanes."""


@dataclass(frozen=True, eq=False)
class Measuring:
    """What measuring all plans of one manoeuvre needs: the manoeuvre, its stretches, the road across its path, the others on it.

    `lead`: who drives ahead, he that is to be passed as long as the vehicle is still behind him.
    """

    maneuver: Maneuver
    stretches: Sequence[Stretch]
    footprint: Footprint
    settings: AssessmentSettings
    profile: Interpretation | None
    sections: CrossSections | None
    shared: Mapping[str, Value]
    passing: Passing
    lead: Other | None


def measuring(
    maneuver: Maneuver, stretches: Sequence[Stretch], footprint: Footprint, settings: AssessmentSettings, profile: Interpretation | None,
    sections: CrossSections | None, shared: Mapping[str, Value], predictions: Predictions, ego: tuple[float, float], reach: float,
) -> Measuring:  # fmt: skip
    """Place the road users that matter on the path: those within `reach` metres of the vehicle, and those the manoeuvre names."""
    path = maneuver.lane_path.path
    lead_id = maneuver.lead or (maneuver.goal.follow.track if maneuver.goal.follow is not None else None)
    named = {maneuver.passes, lead_id} - {None}
    rows = _rows_near(predictions, named, ego, reach)
    placed = others.others(path, predictions, rows)
    by_id = {other.id: other for other in placed}
    near = tuple(other for other in placed if other.id != maneuver.passes and other.kind in passing.KIND_PASSED and abs(other.middle[0]) < BESIDE)
    passed = by_id.get(maneuver.passes) if maneuver.passes is not None else None
    lead = by_id.get(lead_id) if lead_id is not None else passed
    asked = _least_clearance(maneuver, stretches) if settings.claims_no_room else 0.0
    what = Passing(maneuver, passed, near, sections, footprint, settings, profile, asked)
    return Measuring(maneuver, stretches, footprint, settings, profile, sections, shared, what, lead)


def _rows_near(predictions: Predictions, named: set[str | None], ego: tuple[float, float], reach: float) -> list[int]:
    if not len(predictions.ids):
        return []
    around = np.hypot(predictions.x[:, 0] - ego[0], predictions.y[:, 0] - ego[1]) < reach
    return [row for row, name in enumerate(predictions.ids) if around[row] or name in named]


def measure(what: Measuring, candidates: Candidates, rows: NDArray[np.intp]) -> PlanFacts:
    """The facts of some plans (k rows of the candidates)."""
    settings = what.settings
    plans = extents(candidates, rows, what.maneuver.lane_path.path, what.footprint)
    speed = candidates.speed.take(rows, axis=0)
    columns: dict[str, Column] = {}
    _speeds(columns, speed, candidates.acceleration.take(rows, axis=0), settings)
    columns["plan.stop_places"] = stop_places(plans, speed, what.maneuver.junction, settings)
    if what.sections is not None:
        driven_over.measure(columns, what.sections, plans, candidates, rows, what.maneuver, settings)
    step = float(candidates.time[1] - candidates.time[0])
    passing.measure(columns, what.passing, plans, speed, step)
    _following(columns, what, plans, speed, candidates.time)
    reached, of_stretch = _by_stretch(what, plans, speed)
    borders = tuple((stretch.start, stretch.end) for stretch in what.stretches)
    return PlanFacts(what.shared, columns, of_stretch, reached, len(rows), speed, plans.front, borders)


def _speeds(columns: dict[str, Column], speed: Floats, acceleration: Floats, settings: AssessmentSettings) -> None:
    now = speed[:, :1]
    columns["plan.reduces_speed"] = truth((speed < now - settings.slows_by).any(axis=1) | (speed[:, -1] < settings.standstill))
    columns["plan.speeds_up"] = truth((speed > now + settings.slows_by).any(axis=1))
    columns["plan.slows_suddenly"] = truth((acceleration < -settings.sudden_braking).any(axis=1))


def _least_clearance(maneuver: Maneuver, stretches: Sequence[Stretch]) -> float:
    """The greatest clearance that any rule's limit asks of the pass, 0 when none does: the number is the law's, not ours."""
    rules = [rule for stretch in stretches for rule in stretch.view.concerned(maneuver.current, maneuver.next)]
    bounds = [limit.bound.constant for rule in rules for limit in rule.limits if limit.fact == "plan.clearance" and not limit.bound.terms]
    return max(bounds, default=0.0)


def _following(columns: dict[str, Column], what: Measuring, plans: Extents, speed: Floats, time: Floats) -> None:
    """The distance kept to who drives ahead: the manoeuvre's lead by its prediction, else whom the scene tells of, at his present speed."""
    if what.lead is not None:
        gap, ahead = others.gap_behind(plans, what.lead), what.lead.along
    else:
        roles = what.stretches[0].roles
        distance, pace = roles.get("lead.distance"), roles.get("lead.speed")
        if roles.get("lead.present") is not True or not isinstance(distance, float) or not isinstance(pace, float):
            return
        gap, ahead = distance + pace * time - (plans.front - plans.front[:, :1]), np.full(time.shape, pace)
    columns["plan.following_distance"] = number(np.maximum(gap.min(axis=1), 0.0), what.settings.decimals)
    decision = judged_facts.decided_by(what.profile, "lead.following_unsafe")
    if decision is not None:
        column = judged_facts.following_unsafe(decision, gap, speed, ahead, float(time[1] - time[0]), what.settings)
        if column is not None:
            columns["lead.following_unsafe"] = column


LINES: tuple[tuple[str, str], ...] = (
    ("plan.enters_intersection", "line"), ("plan.enters_crosswalk", "crosswalk"), ("plan.enters_rail_crossing", "rail"),
    ("plan.passes_school_bus", "bus"),
)  # fmt: skip
"""Facts that say whether the front bumper passes a place, and the name of that place in a stretch."""


def _by_stretch(what: Measuring, plans: Extents, speed: Floats) -> tuple[Bools, list[OfStretch]]:
    """Whether each plan reaches each stretch, and what it does there; nothing is worked out for stretches that none reaches."""
    front = plans.front
    last = front[:, -1]
    farthest = float(last.max())
    reached = np.zeros((len(what.stretches), front.shape[0]), dtype=np.bool_)
    found: list[OfStretch] = []
    for index, stretch in enumerate(what.stretches):
        committed = what.maneuver.commits and stretch.line is not None  # it will get there, wherever its horizon ends
        reached[index] = (last >= stretch.start) if index and not committed else True
        if index and not committed and farthest < stretch.start:
            found.append(OfStretch({}, {}))
            continue
        fastest = _fastest(front, speed, stretch.start if index else -np.inf, stretch.end if index + 1 < len(what.stretches) else np.inf)
        if committed:
            fastest = np.where(last < stretch.start, speed[:, -1], fastest)
        found.append(_in_stretch(what, stretch, np.where(reached[index], fastest, np.nan), last))
    return reached, found


def _in_stretch(what: Measuring, stretch: Stretch, fastest: Floats, last: Floats) -> OfStretch:
    settings = what.settings
    columns: dict[str, Column] = {"plan.speed": number(fastest, settings.decimals)}
    shared: dict[str, Value] = {}
    for fact, name in LINES:
        line = getattr(stretch, name)
        if line is None:
            shared[fact] = False
        elif what.maneuver.commits and name == "line":
            shared[fact] = True
        else:
            columns[fact] = truth(last > line + settings.line_tolerance)
    decision = judged_facts.decided_by(what.profile, "speed.unsafe_for_conditions")
    if decision is not None and stretch.roles.get("speed.unsafe_for_conditions") is not False:
        seen = stretch.measures.get("speed.unsafe_for_conditions", {}).get("sight_distance", settings.sensing_range)
        column = judged_facts.too_fast_to_stop(decision, np.nan_to_num(columns["plan.speed"].values), seen)
        if column is not None:
            columns["speed.unsafe_for_conditions"] = column
    return OfStretch(shared, columns)


def _fastest(front: Floats, speed: Floats, start: float, end: float) -> Floats:
    """Greatest speed while the front bumper is from `start` to before `end`, (k,), -inf for plans that never are.

    Between instants the speed is taken to change evenly, so what a plan still has on crossing the border counts. The speed at the first
    instant is a fact, no plan; it does not count.
    """
    first, last = float(front[:, 0].min()), float(front[:, -1].max())
    if start <= first and last < end:
        return np.asarray(speed[:, 1:].max(axis=1))
    inside = (front[:, 1:] >= start) & (front[:, 1:] < end)
    found = np.where(inside, speed[:, 1:], -np.inf).max(axis=1)
    for border in (start, end):
        if first < border <= last:
            found = np.maximum(found, _speed_at(front, speed, border))
    return np.asarray(found)


def _speed_at(front: Floats, speed: Floats, station: float) -> Floats:
    """Speed when the front crosses a station, (k,), -inf for plans that do not cross it. Fronts do not go back."""
    after = (front < station).sum(axis=1)
    crosses = (after > 0) & (after < front.shape[1])
    upper = np.clip(after, 1, front.shape[1] - 1)
    row = np.arange(front.shape[0])
    ahead, behind = front[row, upper], front[row, upper - 1]
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.where(ahead > behind, (station - behind) / (ahead - behind), 0.0)
    return np.asarray(np.where(crosses, speed[row, upper - 1] + share * (speed[row, upper] - speed[row, upper - 1]), -np.inf))
