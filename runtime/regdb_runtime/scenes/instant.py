"""What all candidates of one observation share: everybody placed on each path once, who walks where, who arrives at which junction."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from regdb.vocabulary import Value
from regdb_runtime.maps.reference_path import ReferencePath
from regdb_runtime.maps.road_map import RoadMap
from regdb_runtime.observation import Footprint, Observation
from regdb_runtime.scenes.around import Around, around
from regdb_runtime.scenes.crossing import Arriving, Crossings
from regdb_runtime.scenes.eye_facts import EyeReport
from regdb_runtime.scenes.settings import SceneSettings, SensorRanges
from regdb_runtime.scenes.walkers import Walkers

if TYPE_CHECKING:
    from regdb_runtime.scenes.course import Part
    from regdb_runtime.scenes.roles import OnPart, Viewpoint
    from regdb_runtime.scenes.stretches import Encoded


Viewed = tuple["Viewpoint", list[tuple["Part", "Encoded", "OnPart"]], float | None]
"""One way to go: the view from it, the parts of its path with scenes and roles, and the station of the line ahead."""


class Instant:
    """One observation, looked at from each path only once."""

    def __init__(
        self, observation: Observation, road_map: RoadMap, footprint: Footprint, settings: SceneSettings, ranges: SensorRanges, eye: EyeReport,
        clock: Mapping[str, Value],
    ) -> None:  # fmt: skip
        self.observation, self.eye, self.clock = observation, eye, clock
        self._footprint, self._reach = footprint, max(ranges.vehicles, ranges.bicycles, ranges.pedestrians) + settings.approach
        crosswalks = {walk.id: walk for walk in road_map.crosswalks}
        self.walkers = Walkers(observation.ego, observation.tracks, crosswalks, ranges.pedestrians, settings.about_to_cross)
        self._around: dict[ReferencePath, Around] = {}
        self._arriving: dict[Crossings, tuple[Arriving, ...]] = {}
        self.views: dict[tuple[object, ...], Viewed] = {}

    def around(self, path: ReferencePath) -> Around:
        """The vehicle and everybody else on a path."""
        if path not in self._around:
            self._around[path] = around(path, self.observation.ego, self._footprint, self.observation.tracks, self._reach)
        return self._around[path]

    def arriving(self, crossings: Crossings) -> tuple[Arriving, ...]:
        """Who is on the ways that meet one planned way."""
        if crossings not in self._arriving:
            self._arriving[crossings] = crossings.arriving(self.observation.tracks)
        return self._arriving[crossings]
