"""One piece of a path over which the law's facts do not change, with the law in force there and what a plan adds to it."""

from __future__ import annotations

import datetime
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from regdb.situation import Scene
from regdb.vocabulary import Value
from regdb_runtime.index.slots import PreparedScene
from regdb_runtime.legality import View

Stage = Literal["road", "approach", "inside"]
"""On the road between junctions, before the line of one, or past its line and not yet clear of it."""


@dataclass(frozen=True, eq=False, slots=True)
class Stretch:
    """From station `start` to `end` along the path, metres, of the front bumper; the first begins where the front is now.

    `place` and `clock`: jurisdiction, and local time of arrival at `start` at the present speed; `view`: the law there and then.
    `scene`: what holds for every plan on it; `prepared`: the same, encoded for `View.judge`. `roles`: facts that depend on the candidate or
    change with every observation; they go into `Plan.facts`, with the plan's own measured facts over them.

    Where a plan is measured against (stations of the front bumper, None: nothing of that kind lies ahead on this stretch):
    `line` for `plan.enters_intersection`, `crosswalk` for `plan.enters_crosswalk` (the first one with a pedestrian, else the first),
    `rail` for `plan.enters_rail_crossing`, `bus` for `plan.passes_school_bus`. A plan whose front stays before it does not enter.

    `measures`: fact -> the quantities (SI) that do not depend on the plan, for facts that an interpretation judges by the plan's own too:
    `speed.unsafe_for_conditions` and `plan.lacks_due_care` wait for `speed`, `plan.unsafe_pass` for `lateral_gap` and lateral speeds.
    """

    start: float
    end: float
    place: str
    clock: datetime.datetime
    view: View
    scene: Scene
    prepared: PreparedScene
    roles: Mapping[str, Value]
    lane: str
    stage: Stage = "road"
    line: float | None = None
    crosswalk: float | None = None
    rail: float | None = None
    bus: float | None = None
    measures: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
