"""The strategist's picture of one instant: the vehicle on its path, the others along it, the junction ahead, what must be followed."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

from regdb_runtime.maps.lane_graph import is_driven
from regdb_runtime.maps.lane_path import Junction, LanePath
from regdb_runtime.maps.road_map import Lane, RoadMap
from regdb_runtime.maps.route import Route
from regdb_runtime.observation import Footprint, Observation
from regdb_runtime.planning.goal import Follow, SpeedCap, StopPoint
from regdb_runtime.strategy.memory import Memory
from regdb_runtime.strategy.paths import Paths
from regdb_runtime.strategy.settings import StrategySettings
from regdb_runtime.strategy.surroundings import Placed, lead, place


@dataclass(frozen=True, slots=True)
class Need:
    """Changes of lane that the route needs: how many, to which side, within how many metres of the front bumper."""

    changes: int = 0
    side: Literal["left", "right"] | None = None
    room: float = math.inf


@dataclass(frozen=True, eq=False)
class Picture:
    """Everything about now, stations along `lane_path` (the vehicle's own lane, on to the route's end).

    `station`, `offset`: of the rear axle; `lane_station`: along the lane itself; `free_speed`: what it would drive here without others (m/s).
    """

    observation: Observation
    road_map: RoadMap
    route: Route
    paths: Paths
    memory: Memory
    settings: StrategySettings
    footprint: Footprint
    lane: str
    lane_station: float
    lane_path: LanePath
    station: float
    offset: float
    free_speed: float

    @property
    def front(self) -> float:
        """Station of the front bumper."""
        return self.station + self.footprint.front

    @property
    def rear(self) -> float:
        """Station of the rear bumper."""
        return self.station - self.footprint.rear_overhang

    @property
    def speed(self) -> float:
        """Of the vehicle, m/s."""
        return self.observation.ego.speed

    @property
    def here(self) -> Lane:
        """The lane driven in."""
        return self.road_map.lanes[self.lane]

    @cached_property
    def placed(self) -> tuple[Placed, ...]:
        """The others along the path."""
        return place(self.lane_path.path, self.observation.tracks)

    @cached_property
    def junction(self) -> Junction | None:
        """The junction being crossed, else the next one on the path."""
        return self.paths.junction(self.lane_path, self.rear)

    @cached_property
    def need(self) -> Need:
        """The changes of lane that the route needs from here."""
        count, span = self.paths.need(self.lane_path, self.lane)
        if span is None or count == 0:
            return Need()
        return Need(abs(count), "left" if count > 0 else "right", span.end - self.front)

    @cached_property
    def makes_room(self) -> Literal["left", "right"] | None:
        """The side to change lanes to, away from what stands beside the lane ahead with its warning lights on; None without.

        Not where the route needs a change, nor where what stands is nearer than a change takes, nor where the junction comes before it.
        """
        if self.need.side is not None or self.handling:
            return None
        half, reach = float(self.here.widths.min()) / 2, self.settings.stands_beside
        for item in self.placed:
            ahead = item.rear - self.front
            if item.track.warning_lights == "none" or item.track.speed > 0.5 or not 0.0 < ahead <= self.settings.lane_change_distance:
                continue
            if item.left < half and -half - reach < item.left <= -half + 0.3:
                return "left"
            if item.right > -half and half - 0.3 <= item.right < half + reach:
                return "right"
        return None

    @cached_property
    def handling(self) -> bool:
        """Whether the intersection ahead is near enough to be handled; with hysteresis."""
        if self.junction is None:
            return False
        settings = self.settings
        reach = max(settings.handling_distance, settings.handling_time * self.speed)
        if self.memory.handling:
            reach += settings.handling_hysteresis
        return self.junction.stop_station - self.front <= reach

    @cached_property
    def lead(self) -> Placed | None:
        """What is followed: the nearest ahead in the lane that is near, or that the gap to closes soon."""
        found = self.ahead(0.0)
        return found if found is not None and self.is_near(found) else None

    def ahead(self, offset: float, passed: str | None = None) -> Placed | None:
        """The nearest ahead in the strip driven through at an offset, however far."""
        margins = self.settings.corridor_margin, self.settings.rider_margin
        return lead(self.placed, self.front, self.footprint, offset, margins, passed)

    def is_near(self, item: Placed) -> bool:
        """Whether it must be followed: near for the speed, or the gap closes soon."""
        return self.is_near_at(item, self.front)

    def is_near_at(self, item: Placed, front: float) -> bool:
        """The same on another path, on which the front bumper is at `front`."""
        settings = self.settings
        gap, closing = item.rear - front, self.speed - item.along
        reach = settings.follow_distance + settings.follow_time * self.speed
        if item.track.id == self.memory.followed:
            reach *= settings.follow_hysteresis
        return gap <= reach or (closing > 0 and gap <= closing * settings.closing_time)

    @cached_property
    def curves(self) -> tuple[SpeedCap, ...]:
        """What curves allow, along the path."""
        return self.paths.curves(self.lane_path)

    def beside(self, side: Literal["left", "right"]) -> str | None:
        """The lane beside on which the route may be driven as well; None without."""
        graph = self.paths.graph
        found = graph.left(self.lane) if side == "left" else graph.right(self.lane)
        return found if found is not None and self.route.segment_of(found) is not None and is_driven(self.road_map.lanes[found]) else None

    @property
    def inside(self) -> bool:
        """Whether the front bumper is past the line of the junction that is being handled."""
        return self.handling and self.junction is not None and self.front > self.junction.stop_station

    @cached_property
    def halt(self) -> StopPoint | None:
        """Where a manoeuvre that is no crossing ends at the latest: the line of the junction being handled, else the path's end."""
        if not self.handling or self.junction is None or self.inside:
            return self.end
        return StopPoint(self.junction.stop_station, f"stop:{self.junction.id}", self.settings.stop_slack, self.settings.stop_margin)

    @cached_property
    def end(self) -> StopPoint | None:
        """The end of the path, where it lies within what is planned: the destination, or where the route cannot be followed further."""
        return self.paths.end(self.lane_path, self.front)


def follow(item: Placed | None) -> Follow | None:
    """A road user as something to keep behind; what comes towards the vehicle counts as standing."""
    if item is None:
        return None
    return Follow(item.track.id, item.rear, max(item.along, 0.0), item.track.acceleration)
