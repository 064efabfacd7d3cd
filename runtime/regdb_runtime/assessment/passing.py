"""What plans overtake, on which side, from which lane, and how near they come; each plan for itself, whatever others are measured with it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from regdb.interpretation import Interpretation
from regdb.vocabulary import Value
from regdb_runtime.assessment import driven_over, judged_facts, others
from regdb_runtime.assessment.cross_section import CrossSections
from regdb_runtime.assessment.extents import Extents
from regdb_runtime.assessment.measured import Bools, Column, number, word
from regdb_runtime.assessment.others import Other, Pass
from regdb_runtime.assessment.settings import AssessmentSettings
from regdb_runtime.maneuver import Maneuver
from regdb_runtime.observation import Footprint
from regdb_runtime.trajectory import Floats

KIND_PASSED: Mapping[str, str] = {
    "car": "vehicle", "truck": "vehicle", "bus": "vehicle", "motorcycle": "vehicle", "bicycle": "bicycle", "animal": "animal",
}  # fmt: skip
"""What plan.passes calls a road user; pedestrians and things are not overtaken."""
PASSED: tuple[Value, ...] = ("none", "vehicle", "bicycle", "animal", "stopped_vehicle")
SIDES: tuple[Value, ...] = ("left", "right")
TRUTHS: tuple[Value, ...] = (False, True)


@dataclass(frozen=True, eq=False)
class Passing:
    """What it takes to say what plans pass: who the manoeuvre would pass, who else is near, the road, and the clearance some law asks."""

    maneuver: Maneuver
    passed: Other | None
    near: Sequence[Other]
    sections: CrossSections | None
    footprint: Footprint
    settings: AssessmentSettings
    profile: Interpretation | None
    least_clearance: float


def measure(columns: dict[str, Column], what: Passing, plans: Extents, speed: Floats, step: float) -> None:
    """Facts of the pass; `speed` (k, T), `step` seconds between instants.

    What the manoeuvre would pass is passed by all its plans. Otherwise a plan passes who it goes past: of several a bicycle before others,
    then the one it comes nearest to.
    """
    size = plans.front.shape[0]
    columns["plan.passes"] = word(np.zeros(size, dtype=np.intp), PASSED)
    if what.passed is not None:
        _fill(columns, _of(what, what.passed, plans, speed, step), np.ones(size, dtype=np.bool_))
        return
    gone = [(other, going) for other in what.near if (going := others.overtakes(plans, other, what.settings.passing_range)).any()]
    if not gone:
        return
    nearest = [(other.kind != "bicycle") * 1e3 + Pass(plans, other, intended=False).clearance for other, _ in gone]
    order = np.array([np.where(going, away, np.inf) for away, (_, going) in zip(nearest, gone, strict=True)])
    chosen = order.argmin(axis=0)
    for index, (other, going) in enumerate(gone):
        mine = going & (chosen == index)
        if mine.any():
            _fill(columns, _of(what, other, plans, speed, step), mine)


def _fill(columns: dict[str, Column], found: Iterable[tuple[str, Column]], mine: Bools) -> None:
    """Put some plans' values into columns; plans that nothing was said of do not tell the fact."""
    for name, column in found:
        held = columns.get(name)
        if held is None:
            blank = np.full(mine.shape, np.nan if column.is_number else -1, dtype=column.values.dtype)
            held = Column(blank, column.words)
        columns[name] = Column(np.where(mine, column.values, held.values), column.words)


def _of(what: Passing, passed: Other, plans: Extents, speed: Floats, step: float) -> Iterable[tuple[str, Column]]:
    """Facts of passing one road user, for all plans."""
    settings, size, going = what.settings, plans.front.shape[0], Pass(plans, passed, passed is what.passed)
    yield "plan.passes", word(np.full(size, PASSED.index(_kind(passed, settings))), PASSED)
    yield "plan.passing_side", word(_sides(what, going), SIDES)
    yield "plan.clearance", number(going.clearance, settings.decimals)
    yield "plan.passing_distance", number(others.passing_distance(plans, passed, speed), settings.decimals)
    if what.sections is not None:
        within = driven_over.shares_lane(what.sections, going, settings.line_tolerance)
        yield "plan.passes_in_same_lane", word(within.astype(np.intp), TRUTHS)
        if settings.claims_no_room:
            room = driven_over.no_room(what.sections, plans, passed, what.footprint, what.least_clearance)
            yield "plan.no_room_for_three_feet", word(room.astype(np.intp), TRUTHS)
    judged: list[tuple[object, Column]] = []
    for fact in ("plan.unsafe_pass", "bicycle.endangered_by_pass"):
        decision = judged_facts.decided_by(what.profile, fact)
        if decision is not None:
            alike = decision.formula, decision.parameters, decision.true_when
            column = next((held for key, held in judged if key == alike), None) or judged_facts.unsafe_pass(decision, going, step, speed)
            if column is not None:
                judged.append((alike, column))
                yield fact, column


def _kind(passed: Other, settings: AssessmentSettings) -> str:
    kind = KIND_PASSED.get(passed.kind, "none")
    return "stopped_vehicle" if kind == "vehicle" and float(passed.speed.max()) < settings.standstill else kind


def _sides(what: Passing, going: Pass) -> NDArray[np.intp]:
    """The side on which the vehicle is while alongside, else at the plan's end, as a place in SIDES; the manoeuvre's own where it says one."""
    named, plans = what.maneuver.passing_side, going.plans
    if going.intended and named != "none":
        return np.full(plans.front.shape[0], SIDES.index(named))
    middle = (plans.left + plans.right) / 2 - going.other.middle
    aside = np.where(going.seen.any(axis=1), np.where(going.seen, middle, 0.0).sum(axis=1), middle[:, -1])
    return np.asarray(np.where(aside < 0.0, 1, 0), dtype=np.intp)
