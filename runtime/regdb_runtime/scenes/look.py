"""One candidate's view of everybody around it: the strips of its own lane and of the lane it moves to, and who judges what is near."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

from regdb.interpretation import Interpretation
from regdb_runtime.interpretation import decide
from regdb_runtime.maneuver import Maneuver
from regdb_runtime.maps.road_map import Lane, RoadMap, Side
from regdb_runtime.observation import Footprint, Observation
from regdb_runtime.scenes.around import Around, Beside
from regdb_runtime.scenes.lane_facts import beside
from regdb_runtime.scenes.settings import SceneSettings, SensorRanges

Strip = tuple[float, float]
"""Between two offsets from the path, metres: right, left."""


@dataclass(frozen=True, eq=False)
class Look:
    """What roles are filled from. `own`: the lane the vehicle is in; `path_strip` is the strip of the lane that the path runs along."""

    road_map: RoadMap
    observation: Observation
    maneuver: Maneuver
    around: Around
    footprint: Footprint
    settings: SceneSettings
    ranges: SensorRanges
    profile: Interpretation
    own: Lane
    target: Lane | None
    side: Side | None
    own_strip: Strip
    target_strip: Strip | None
    path_strip: Strip

    @property
    def speed(self) -> float:
        """Of the vehicle, m/s."""
        return self.observation.ego.speed

    def judged(self, fact: str, measured: Mapping[str, float]) -> bool | None:
        """What the interpretation in use says of a fact; None where it leaves it open."""
        return decide(self.profile, fact, measured)

    def stands(self, speed: float) -> bool:
        """Whether somebody with this speed stands."""
        return abs(speed) < self.settings.standstill

    @cached_property
    def lead(self) -> Beside | None:
        """The nearest motor vehicle ahead in the vehicle's lane that does not come towards it."""
        for item in self.around.among(*self.own_strip):
            if item.is_motor and item.rear >= self.around.front - 1.0 and item.along > -self.settings.standstill:
                return item if item.rear - self.around.front <= self.ranges.vehicles else None
        return None

    def in_time(self, line: float, place: float, reach: float) -> bool:
        """Whether a place (stations) that sensors with a reach do not cover yet will be looked at early enough to stop before a line."""
        left = line - max(place - reach + self.footprint.length, self.around.front)
        speed = max(self.speed, self.own.speed_limit or 0.0)
        return left >= speed * self.settings.look_response + speed**2 / (2 * self.settings.look_braking)

    def strip_beside(self, side: Side) -> tuple[Lane, Strip] | None:
        """The neighbouring lane of the same direction and its strip, None without one."""
        lane = beside(self.road_map, self.own, side)
        return None if lane is None else (lane, _next_to(self.own_strip, _width(lane), side))


def _width(lane: Lane) -> float:
    return float(lane.widths.mean())


def _next_to(strip: Strip, width: float, side: Side) -> Strip:
    return (strip[1], strip[1] + width) if side == "left" else (strip[0] - width, strip[0])


def lanes_of(road_map: RoadMap, maneuver: Maneuver, here: str) -> tuple[Lane, Lane | None, Side | None]:
    """The vehicle's own lane, the lane it moves to and the side of it. `here`: the lane of the path beside the front bumper.

    A path of a change of lane runs along the target; then the own lane is the neighbour from which it is entered.
    """
    lanes = road_map.lanes
    own = lanes[maneuver.lane]
    if maneuver.target_lane is None or maneuver.target_lane == maneuver.lane:
        return (lanes[here] if here != maneuver.lane else own), None, None
    target = lanes[maneuver.target_lane]
    if target.id in (own.left, own.right):
        return own, target, "left" if own.left == target.id else "right"
    return own, target, "left" if maneuver.turn_signal == "left" or maneuver.next.endswith("left") else "right"


def strips(own: Lane, target: Lane | None, side: Side | None, here: Lane) -> tuple[Strip, Strip | None, Strip]:
    """Strips of the own lane, the target lane and the path's lane, in offsets from the path."""
    half = _width(here) / 2
    path_strip = (-half, half)
    if target is None or side is None:
        return path_strip, None, path_strip
    if here.id != own.id:  # the path runs along the target
        return _next_to(path_strip, _width(own), "right" if side == "left" else "left"), path_strip, path_strip
    return path_strip, _next_to(path_strip, _width(target), side), path_strip
