"""Where plans come to stand: the places of the law (CVC 22500) in which some part of the vehicle stops."""

from __future__ import annotations

import numpy as np

from regdb.vocabulary import Value
from regdb_runtime.assessment.extents import Extents
from regdb_runtime.assessment.measured import Column, word
from regdb_runtime.assessment.settings import AssessmentSettings
from regdb_runtime.maneuver import Junction
from regdb_runtime.trajectory import Floats

PLACES: tuple[Value, ...] = (frozenset(), frozenset({"intersection"}))


def stop_places(plans: Extents, speed: Floats, junction: Junction | None, settings: AssessmentSettings) -> Column:
    """`intersection` for plans at whose end the vehicle stands with some part between a junction's entrance and exit, (k,)."""
    stands = speed[:, -1] < settings.standstill
    if junction is None:
        return word(np.zeros(len(stands), dtype=np.intp), PLACES)
    tolerance = settings.line_tolerance
    within = (plans.front[:, -1] > junction.entrance + tolerance) & (plans.rear[:, -1] < junction.exit - tolerance)
    return word(np.where(stands & within, 1, 0), PLACES)
