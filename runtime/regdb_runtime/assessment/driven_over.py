"""What plans drive over: markings, the other half of the road, its edges, bicycle lanes; and which lane a pass is made from."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from regdb_runtime.assessment.cross_section import CrossSections
from regdb_runtime.assessment.extents import Extents
from regdb_runtime.assessment.measured import Bools, Column, number, truth
from regdb_runtime.assessment.others import Other, Pass
from regdb_runtime.assessment.settings import AssessmentSettings
from regdb_runtime.maneuver import Maneuver
from regdb_runtime.observation import Footprint
from regdb_runtime.trajectory import Candidates, Floats


def measure(
    columns: dict[str, Column], sections: CrossSections, plans: Extents, candidates: Candidates, rows: NDArray[np.intp],
    maneuver: Maneuver, settings: AssessmentSettings,
) -> None:  # fmt: skip
    """Facts about the lines across the road. Within junctions there are none, and nothing is driven over."""
    station, tolerance = candidates.station.take(rows, axis=0), settings.line_tolerance
    index = sections.columns(station)
    left, right = plans.left - tolerance, plans.right + tolerance
    lines = sections.at(sections.across, index)
    right_edge, dividers, center, left_edge = lines[0], lines[1:-2], lines[-2], lines[-1]
    on_divider = ((right < dividers) & (left > dividers)).any(axis=0)
    over_center = left > center
    straddled = over_center & (right < center)
    columns["plan.crosses_marking"] = truth((on_divider | straddled).any(axis=1))
    columns["plan.drives_left_of_center"] = truth(over_center.any(axis=1))
    columns["plan.leaves_roadway"] = truth(((right < right_edge) | (left > left_edge)).any(axis=1))
    changing = maneuver.target_lane is not None and maneuver.target_lane != maneuver.lane
    columns["plan.straddles_lanes"] = truth(np.zeros(len(rows)) if changing else _stays_on(np.asarray(on_divider)))
    steps = station[:, 1:] - station[:, :-1]
    if sections.has_opposing:
        columns["plan.distance_in_opposing_lane"] = number(_driven(over_center, steps), settings.decimals)
    for kind, fact in (("bicycle_lane", "plan.distance_in_bicycle_lane"), ("sidewalk", "plan.uses_sidewalk")):
        if kind in sections.kinds:
            near, far = sections.at(sections.kinds[kind], index)
            within = (left > near) & (right < far)
            columns[fact] = number(_driven(within, steps), settings.decimals) if kind == "bicycle_lane" else truth(within.any(axis=1))


def _stays_on(on_line: Bools) -> Bools:
    """Whether a plan that changes no lanes drives on a line: it comes onto one, or is on one now and does not leave it."""
    comes = (on_line[:, 1:] & ~on_line[:, :-1]).any(axis=1)
    return np.asarray(comes | on_line[:, -1])


def _driven(where: Bools, steps: Floats) -> Floats:
    """Metres driven while a condition holds at both ends of a step."""
    return np.asarray((steps * (where[:, 1:] & where[:, :-1])).sum(axis=1))


def shares_lane(sections: CrossSections, going: Pass, tolerance: float) -> Bools:
    """Whether some part of the vehicle is in the lane of who is passed, while alongside or, not having come so far, at the plan's end."""
    strip, plans, level = _lane_of(sections, going.other), going.plans, going.seen
    if strip is None:
        return np.ones(plans.front.shape[0], dtype=np.bool_)
    within = (plans.left - tolerance > strip[0]) & (plans.right + tolerance < strip[1])
    return np.asarray(np.where(level.any(axis=1), (within & level).any(axis=1), within[:, -1]))


def _lane_of(sections: CrossSections, passed: Other) -> tuple[float, float] | None:
    """Right and left boundary of the lane in which somebody is when first seen, beside him; None outside all lanes."""
    bounds = sections.at(sections.strips, sections.columns(np.atleast_1d((passed.front[:1] + passed.rear[:1]) / 2)))[..., 0]
    middle = float(passed.middle[0])
    for right, left in bounds:
        if right <= middle <= left:
            return float(right), float(left)
    return None


def no_room(sections: CrossSections, plans: Extents, passed: Other, footprint: Footprint, needed: float) -> Bools:
    """Whether nowhere on the roadway's half for this direction a vehicle of this width could go by with the clearance needed."""
    index = sections.columns(np.atleast_1d((passed.front[:1] + passed.rear[:1]) / 2))
    edges = [float(sections.at(line, index)[0]) for line in (sections.right_edge, sections.center, sections.left_edge)]
    right, left = edges[0], edges[1] if np.isfinite(edges[1]) else edges[2]
    room = max(left - float(passed.left[0]), float(passed.right[0]) - right) - footprint.width
    return np.full(plans.front.shape[0], bool(room < needed))
