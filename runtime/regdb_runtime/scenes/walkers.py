"""Roles of people on foot: in the crosswalk that the path crosses, upon the roadway in its way, beside it."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping

import numpy as np

from regdb.vocabulary import Value
from regdb_runtime.maps.lines import inside
from regdb_runtime.maps.road_map import Crosswalk, Floats
from regdb_runtime.observation import EgoState, Track
from regdb_runtime.scenes.look import Look

STEP_ASIDE = 0.5
"""Metres beside the lane that still are in the way of what drives in it."""
AHEAD_IN_TIME = 2.0
"""Seconds within which a person walking towards the lane enters it: the vehicle's time to respond and a step."""
NEAR_ROADWAY = 3.0
"""Metres from the lane's edge within which a person stands beside the roadway."""


class Walkers:
    """Everybody on foot at one instant, and which crosswalks they are in; shared by all candidates."""

    def __init__(self, ego: EgoState, tracks: Iterable[Track], crosswalks: Mapping[str, Crosswalk], reach: float, about_to: float) -> None:
        self._walkers = [item for item in tracks if item.kind == "pedestrian"]
        self._points = np.array([(item.x, item.y) for item in self._walkers]).reshape(-1, 2)
        self._ego, self._crosswalks, self._reach, self._about_to = ego, crosswalks, reach, about_to
        self._known: dict[str, bool | None] = {}
        self._in_crosswalk: set[str] = set()

    def in_crosswalk(self, name: str) -> bool | None:
        """Whether somebody is crossing in a crosswalk or about to; None where it is too far to be seen."""
        if name not in self._known:
            self._known[name] = self._look(self._crosswalks[name].polygon)
        return self._known[name]

    def is_crossing(self, walker: str) -> bool:
        """Whether this person was found in one of the crosswalks asked about."""
        return walker in self._in_crosswalk

    def _look(self, polygon: Floats) -> bool | None:
        found = False
        if self._walkers:
            within = inside(self._points, polygon)
            for row, walker in enumerate(self._walkers):
                if within[row] or self._about_to_enter(walker, polygon):
                    self._in_crosswalk.add(walker.id)
                    found = True
        if found:
            return True
        away = float(np.hypot(polygon[:, 0] - self._ego.x, polygon[:, 1] - self._ego.y).max())
        return False if away <= self._reach else None

    def _about_to_enter(self, walker: Track, polygon: Floats) -> bool:
        """Near the crosswalk and walking into it."""
        if walker.speed < 0.1:
            return False
        way = np.array([math.cos(walker.heading), math.sin(walker.heading)]) * self._about_to
        ahead = np.array([walker.x, walker.y]) + np.array([way / 2, way])
        return bool(inside(ahead, polygon).any())


def walker_roles(look: Look, walkers: Walkers) -> dict[str, Value]:
    """People outside crosswalks: in the strip of the path's lane or about to enter it, and beside it."""
    right, left = look.path_strip[0] - STEP_ASIDE, look.path_strip[1] + STEP_ASIDE
    on, near = False, False
    for item in look.around.others:
        if item.track.kind != "pedestrian" or item.front < look.around.front or item.rear - look.around.front > look.settings.reach:
            continue
        near = near or item.overlaps(right - NEAR_ROADWAY, left + NEAR_ROADWAY)
        if walkers.is_crossing(item.track.id):
            continue
        drift = item.across * AHEAD_IN_TIME
        on = on or item.overlaps(right - max(0.0, drift), left - min(0.0, drift))
    facts: dict[str, Value] = {"pedestrian.near_roadway": near, "pedestrian.on_sidewalk": False}
    if on or look.ranges.pedestrians >= look.settings.reach:
        facts["pedestrian.on_roadway"] = on
    return facts
