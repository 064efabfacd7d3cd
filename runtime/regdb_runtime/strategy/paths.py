"""Paths along the route, built once and kept: the vehicle's place on them, their curves, junctions and ends."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from regdb_runtime.errors import RegdbRuntimeError
from regdb_runtime.maps.lane_graph import LaneGraph
from regdb_runtime.maps.lane_path import Junction, LanePath, LanePaths, LaneSpan, next_junction
from regdb_runtime.maps.reference_path import ReferencePath
from regdb_runtime.maps.road_map import RoadMap
from regdb_runtime.maps.route import Route
from regdb_runtime.observation import EgoState, Footprint
from regdb_runtime.planning.goal import SpeedCap, StopPoint
from regdb_runtime.strategy.settings import StrategySettings

CURVE_STEP = 5.0
"""Metres over which a curve's speed is taken as one."""
ALIKE = 0.25
"""Neighbouring stretches whose speeds differ by less than this share become one, at the lower speed."""
CURVE = "limit:curve"
"""What a cap for a curve cites: comfort, not law."""
CARRY = 7.5
"""Metres from a lane's centre at which the vehicle still counts as on the route's nearest lane: two lanes, for who passes on the other half."""


class OffRoad(RegdbRuntimeError):  # noqa: N818  # reads as what it says
    """The vehicle is on no lane of its route, nor near one."""


@dataclass(frozen=True, eq=False)
class Paths:
    """What is built from map and route, by lane. Holds caches; nothing in it depends on time."""

    road_map: RoadMap
    route: Route
    footprint: Footprint
    settings: StrategySettings
    graph: LaneGraph
    built: LanePaths
    _paths: dict[tuple[str, int], LanePath] = field(default_factory=dict, repr=False)
    _curves: dict[LanePath, tuple[SpeedCap, ...]] = field(default_factory=dict, repr=False)

    def locate(self, ego: EgoState, before: str, target: str | None) -> tuple[str, float]:
        """The lane of the route the vehicle is in, and its station there. Raises OffRoad.

        Where lanes overlap it is the one of the last tick, one beside it or one that follows it.
        """
        likely = self._likely(before, target)
        found = self.graph.lane_at(ego.x, ego.y, ego.heading, likely) if likely else None
        if found is None:
            on_route = [name for row in self.route.segments for name in row]
            found = self.graph.lane_at(ego.x, ego.y, ego.heading, on_route)
            found = found or self.graph.nearest(ego.x, ego.y, ego.heading, CARRY, on_route)
        if found is None:
            raise OffRoad(f"the vehicle at ({ego.x:.1f}, {ego.y:.1f}) is on no lane of its route to {self.route.goal}")
        return found[0], found[1]

    def _likely(self, before: str, target: str | None) -> list[str]:
        """The lane of the last tick, those beside and after it."""
        place = self.route.segment_of(before) if before else None
        if place is None:
            return []
        names = list(self.route.segments[place])
        for name in (before, target):
            if name is not None and name in self.road_map.lanes:
                names += [other for other in self.road_map.lanes[name].successors if self.route.segment_of(other) is not None]
        return names

    def along(self, lane: str, station: float = 0.0) -> LanePath:
        """The path along a lane and on along the route; the same object for as long as the vehicle's station asks for the same lanes."""
        settings = self.settings
        key = lane, int(station // settings.path_step)
        found = self._paths.get(key)
        if found is None:
            begin = key[1] * settings.path_step
            found = self._paths[key] = self.built.ahead(self.route, lane, settings.path_ahead, settings.path_behind, begin)
        return found

    def station(self, lane_path: LanePath, ego: EgoState) -> tuple[float, float]:
        """Station and offset of the rear axle on a path; beyond its ends it goes on straight."""
        stations, offsets = lane_path.path.project(np.array([(ego.x, ego.y)]), extend=True)
        return float(stations[0]), float(offsets[0])

    def onto(self, lane: str, here: str) -> str:
        """The lane that continues a lane on the segment of another one (where the vehicle is by now)."""
        place = self.route.segment_of(here)
        following: str | None = lane
        while following is not None and self.route.segment_of(following) != place:
            following = self.route.onward(following)
        return lane if following is None else following

    def need(self, lane_path: LanePath, lane: str) -> tuple[int, LaneSpan | None]:
        """The changes of lane that the route needs along a path from a lane on: positive to the left, and the span by whose end they are due."""
        begun = False
        for span in lane_path.spans:
            begun = begun or span.lane == lane
            if not begun:
                continue
            if span.lane in self.route.segments[-1]:
                break
            if self.route.segment_of(span.lane) is None or self.route.onward(span.lane) is None:
                return self.route.changes(span.lane), span
        return 0, None

    def junction(self, lane_path: LanePath, rear: float) -> Junction | None:
        """The junction that the rear bumper has not cleared, else the next one."""
        return next_junction(self.road_map, lane_path, rear)

    def curves(self, lane_path: LanePath) -> tuple[SpeedCap, ...]:
        """Speeds at which curves are comfortable, by station of the front bumper."""
        found = self._curves.get(lane_path)
        if found is None:
            found = self._curves[lane_path] = _curve_caps(lane_path.path, self.footprint, self.settings)
        return found

    def end(self, lane_path: LanePath, front: float) -> StopPoint | None:
        """Where the path ends, once it is near enough to matter."""
        last = lane_path.path.end - self.footprint.rear_overhang
        if last - front > self.settings.path_needed:
            return None
        return StopPoint(last, "route:end", self.settings.stop_slack, self.settings.stop_margin)


def paths_of(road_map: RoadMap, route: Route, footprint: Footprint, settings: StrategySettings) -> Paths:
    """The paths of a route."""
    return Paths(road_map, route, footprint, settings, LaneGraph(road_map), LanePaths(road_map))


def _curve_caps(path: ReferencePath, footprint: Footprint, settings: StrategySettings) -> tuple[SpeedCap, ...]:
    """Caps where a curve is tighter than the cruise speed allows; a cap holds for the whole vehicle, from its front to its rear axle."""
    stations = np.arange(path.start, path.end, 1.0)
    bend = np.maximum(np.abs(path.curvature(stations)), 1e-9)
    speeds = np.sqrt(settings.lateral_acceleration / bend)
    caps: list[SpeedCap] = []
    for begin in np.arange(path.start, path.end, CURVE_STEP).tolist():
        inside = speeds[(stations >= begin) & (stations < begin + CURVE_STEP)]
        least = float(inside.min()) if len(inside) else math.inf
        if least >= settings.cruise_speed:
            continue
        last = caps[-1] if caps else None
        end = begin + CURVE_STEP + footprint.front
        if last is not None and last.end >= begin and abs(last.speed - least) < ALIKE * last.speed:
            caps[-1] = SpeedCap(last.start, end, min(last.speed, least), last.rule)
        else:
            caps.append(SpeedCap(begin + footprint.front, end, least, CURVE))
    return _binding(caps, settings)


def _binding(caps: list[SpeedCap], settings: StrategySettings) -> tuple[SpeedCap, ...]:
    """Without those that gentle braking for the next slower one keeps anyway: the way into a bend is no bend of its own."""
    kept: list[SpeedCap] = []
    for cap in reversed(caps):
        after = next((item for item in reversed(kept) if item.speed < cap.speed), None)
        reached = math.inf if after is None else math.sqrt(after.speed**2 + 2 * settings.decision_braking * (after.start - cap.start))
        if reached > cap.speed:
            kept.append(cap)
    return tuple(reversed(kept))
