"""A plan made elsewhere, placed on a path of ours: its stations and offsets, so that it can be measured as our own plans are."""

from __future__ import annotations

import numpy as np

from regdb_runtime.maps.reference_path import ReferencePath
from regdb_runtime.trajectory import Candidates, Trajectory


def placed(plan: Trajectory, path: ReferencePath) -> Candidates:
    """The plan as the only one of its kind, (1, T); beyond the path's ends it runs along straight continuations."""
    station, offset = path.project(np.column_stack((plan.x, plan.y)), extend=True)
    rows = plan.x, plan.y, plan.heading, plan.speed, plan.acceleration, plan.jerk, plan.curvature, station, offset
    return Candidates(plan.time, *(row[None, :] for row in rows))
