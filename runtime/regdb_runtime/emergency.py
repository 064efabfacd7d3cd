"""The emergency check: braking by distance alone, in a path that touches neither perception's model nor law nor map.

The corridor is what the vehicle's rectangle, widened by `side_margin`, sweeps when it goes on along its present curvature. The gap to a road
user is the way it could go until it touches that one's rectangle where it is now. Emergency means: moving, and for some road user
`gap + give < required`, with `required = max(floor, v tau + v^2 / 2b)` (paper, section III-C: distance alone).

`give` is what that user's own motion adds to the gap while both stop, along the corridor. Whoever goes the same way at speed u does not
stand where it is seen: even at its hardest braking it covers `u^2 / 2c` more. Without this, every car followed at two seconds would count
as a wall, and driving in traffic would be one emergency; with it the two distances are compared that the two vehicles need to stop, as in
RSS. Whoever comes towards us takes away what it covers while it reacts and brakes, `u tau + u^2 / 2b`, but only if it would still be in the
corridor where the two meet: oncoming traffic that follows its own lane round a bend leaves it. Who crosses neither gives nor takes.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from regdb_runtime.observation import EgoState, Footprint, Track
from regdb_runtime.trajectory import Trajectory

STRAIGHT: Final = 1e-5
"""Curvature (1/m) below which the corridor is taken as straight: 0.1 m off after 140 m."""


@dataclass(frozen=True, slots=True)
class EmergencyReport:
    """What the check measured: nearest gap in the swept corridor, the distance it must not fall below (metres), and the track it is to.

    `give`: what that track's own motion adds to the gap (negative when it comes nearer); compared is `gap + give` with `required`.
    """

    active: bool
    gap: float | None
    required: float
    track: str | None
    give: float = 0.0


@dataclass(frozen=True, slots=True)
class EmergencySettings:
    """Numbers of the check, SI. Sources: floor and form, issue and paper; braking, a dry road's full braking (about 8 m/s^2) and what an
    assured clear distance may count on (6.5); the response time is one motion tick and the build-up of brake pressure (0.2 s)."""

    floor: float = 3.0
    response_time: float = 0.3
    assured_braking: float = 6.5
    others_hardest_braking: float = 9.0
    full_braking: float = 8.0
    side_margin: float = 0.25
    release_distance: float = 1.0
    release_time: float = 0.5
    standing_speed: float = 0.1
    plan_step: float = 0.1
    plan_hold: float = 2.0

    def required(self, speed: float) -> float:
        """The distance that must lie free ahead at a speed."""
        return max(self.floor, speed * self.response_time + speed * speed / (2 * self.assured_braking))


class EmergencyBrake:
    """Holds whether an emergency is on, and since when the way has been free again; nothing else. Not shared between threads, so no lock."""

    def __init__(self, footprint: Footprint, settings: EmergencySettings | None = None) -> None:
        self.footprint, self.settings = footprint, settings or EmergencySettings()
        self.active = False
        self._free_since: float | None = None

    def check(self, ego: EgoState, tracks: Sequence[Track], time: float) -> EmergencyReport:
        """The state of emergency at `time` (seconds, injected, not falling).

        It begins only while the vehicle moves (a standing one, at a queue's end or before a crosswalk, has nothing to brake), and ends when
        the distance has been kept by `release_distance` more for `release_time`; once standing, `release_distance` is not asked for.
        """
        settings = self.settings
        required = settings.required(ego.speed)
        gap, give, track = nearest(ego, tracks, self.footprint, settings)
        slack = math.inf if gap is None else gap + give - required
        if slack < 0.0:
            self._free_since = None
            self.active = self.active or ego.speed > settings.standing_speed
        elif self.active:
            self._release(time, slack >= settings.release_distance or ego.speed <= settings.standing_speed)
        return EmergencyReport(self.active, gap, required, track, give)

    def _release(self, time: float, free: bool) -> None:
        if not free:
            self._free_since = None
        elif self._free_since is None:
            self._free_since = time
        elif time - self._free_since >= self.settings.release_time - 1e-9:
            self.active, self._free_since = False, None

    def brake(self, ego: EgoState) -> Trajectory:
        """Full braking along the present curvature to a stand, then held; stations count from here."""
        return full_braking(ego, self.settings)


Corners = tuple[tuple[float, float], ...]
"""Four corners (ahead of the rear axle, to the left of it) in order round the rectangle."""


def nearest(
    ego: EgoState, tracks: Sequence[Track], footprint: Footprint, settings: EmergencySettings
) -> tuple[float | None, float, str | None]:
    """Gap, give and id of the road user with the least gap + give; (None, 0, None) with none in the corridor. Among equals the first in `tracks`."""
    found: tuple[float | None, float, str | None] = None, 0.0, None
    least = math.inf
    for track, bound in _near(ego, tracks, footprint, settings):
        if bound > least:
            continue
        gap = _gap(_corners(ego, track), ego.curvature, footprint, settings)
        if gap < math.inf:
            give = _give(ego, track, gap, footprint, settings)
            if gap + give < least:
                found, least = (gap, give, track.id), gap + give
    return found


def _near(ego: EgoState, tracks: Sequence[Track], footprint: Footprint, settings: EmergencySettings) -> list[tuple[Track, float]]:
    """Tracks near enough to matter whose circle reaches the corridor's band, straight or round, each with a lower bound of gap + give."""
    cos, sin = math.cos(ego.heading), math.sin(ego.heading)
    outermost = footprint.width / 2 + settings.side_margin
    look = settings.required(ego.speed) + settings.release_distance + footprint.length
    bend = abs(ego.curvature) > STRAIGHT
    center = 1 / ego.curvature if bend else 0.0
    band = math.hypot(abs(center) + outermost, footprint.front) - abs(center) if bend else outermost
    floor, response, twice = settings.floor, settings.response_time, 2 * settings.assured_braking
    reach = math.hypot(footprint.front, footprint.width / 2 + settings.side_margin)
    found = []
    for track in tracks:
        dx, dy, radius = track.x - ego.x, track.y - ego.y, (track.length + track.width) / 2
        speed = track.speed
        theirs = max(floor, speed * response + speed * speed / twice)  # settings.required, in line: this runs for everybody about
        farthest = look + radius + theirs
        if dx * dx + dy * dy > farthest * farthest:
            continue
        along, across = dx * cos + dy * sin, dy * cos - dx * sin
        aside = abs(math.hypot(along, across - center) - abs(center)) if bend else abs(across)
        if aside <= band + radius and (bend or along > -radius):
            found.append((track, math.hypot(dx, dy) - reach - radius - theirs))
    return found


def _corners(ego: EgoState, track: Track, x: float | None = None, y: float | None = None, heading: float | None = None) -> Corners:
    """The track's corners as the vehicle sees them, from its rear axle; at another place if one is given."""
    cos, sin = math.cos(ego.heading), math.sin(ego.heading)
    dx, dy = (track.x if x is None else x) - ego.x, (track.y if y is None else y) - ego.y
    turn = (track.heading if heading is None else heading) - ego.heading
    along, across = dx * cos + dy * sin, dy * cos - dx * sin
    ahead = track.length / 2 * math.cos(turn), track.length / 2 * math.sin(turn)
    aside = -track.width / 2 * math.sin(turn), track.width / 2 * math.cos(turn)
    return tuple((along + i * ahead[0] + j * aside[0], across + i * ahead[1] + j * aside[1]) for i, j in ((1, 1), (-1, 1), (-1, -1), (1, -1)))


def _gap(corners: Corners, curvature: float, footprint: Footprint, settings: EmergencySettings) -> float:
    """Way of the rear axle until the rectangle touches the box: inf when the corridor misses it, 0 when it does already.

    Two convex shapes first touch where a corner of one meets a side of the other, so the gap is exact. The widened rectangle meets what
    lies ahead; the bare one also what lies within the margin beside it already, which only a turn reaches.
    """
    if max(along for along, _ in corners) <= 0.0:  # what lies behind the rear axle is no reason to brake
        return math.inf
    if _touches(corners, footprint):
        return 0.0
    wide, bare = footprint.width / 2 + settings.side_margin, footprint.width / 2
    if abs(curvature) <= STRAIGHT:
        return _straight(corners, footprint.front, wide)
    inward = tuple((along, math.copysign(across, across * curvature)) for along, across in corners)
    radius = 1 / abs(curvature)
    found = _bend(inward, radius, footprint.front, wide)
    beside = min(along for along, _ in corners) < footprint.front
    return min(found, _bend(inward, radius, footprint.front, bare)) if beside else found


def _touches(corners: Corners, footprint: Footprint) -> bool:
    """Whether the box overlaps the vehicle's own, bare rectangle (separating axes)."""
    front, rear, half = footprint.front, -footprint.rear_overhang, footprint.width / 2
    along, across = [corner[0] for corner in corners], [corner[1] for corner in corners]
    if min(along) > front or max(along) < rear or min(across) > half or max(across) < -half:
        return False
    own = ((front, half), (rear, half), (rear, -half), (front, -half))
    for start, end in ((corners[0], corners[1]), (corners[1], corners[2])):
        axis = end[0] - start[0], end[1] - start[1]
        low, high = sorted((start[0] * axis[0] + start[1] * axis[1], end[0] * axis[0] + end[1] * axis[1]))
        places = [x * axis[0] + y * axis[1] for x, y in own]
        if min(places) > high or max(places) < low:
            return False
    return True


def _straight(corners: Corners, front: float, half_width: float) -> float:
    """Corners within the strip, and where the box's sides cross its borders."""
    found = math.inf
    x0, y0 = corners[-1]
    for x, y in corners:
        if abs(y) <= half_width and front <= x < found:
            found = x
        for border in (half_width, -half_width):
            if (y0 - border) * (y - border) < 0.0:
                crossing = x0 + (x - x0) * (border - y0) / (y - y0)
                if front <= crossing < found:
                    found = crossing
        x0, y0 = x, y
    return found - front


def _bend(corners: Corners, radius: float, front: float, half_width: float) -> float:
    """The same on an arc, turning centre at (0, radius). Every point of the vehicle keeps its distance from the centre, so a corner of the
    box is met by the place of the front, or of the inner side, that has the same distance; the front's own corners run along circles."""
    inner, outer = max(radius - half_width, 0.0), radius + half_width
    farthest, turning = math.hypot(outer, front), math.hypot(inner, front)
    found = math.inf
    x0, y0 = corners[-1]
    for x, y in corners:
        away = math.hypot(x, radius - y)
        if inner <= away <= farthest and away > 0.0:
            own = math.asin(min(front / away, 1.0)) if away >= turning else math.acos(inner / away)
            found = _turned(x, radius - y, own, found)
        for circle, own in ((farthest, math.asin(front / farthest)), (turning, math.asin(front / turning))):
            for share in _crossings(x0, radius - y0, x, radius - y, circle):
                found = _turned(x0 + (x - x0) * share, radius - y0 - (y - y0) * share, own, found)
        x0, y0 = x, y
    return found * radius


def _turned(ahead: float, outward: float, own: float, found: float) -> float:
    """The angle the vehicle turns until its place at angle `own` reaches a point (seen from the turning centre), if less than `found`."""
    angle = math.atan2(ahead, outward) - own
    return angle if 0.0 <= angle < found else found


def _crossings(x0: float, y0: float, x1: float, y1: float, circle: float) -> list[float]:
    """Shares of a segment at which it crosses a circle about the origin."""
    dx, dy = x1 - x0, y1 - y0
    a, half_b, c = dx * dx + dy * dy, x0 * dx + y0 * dy, x0 * x0 + y0 * y0 - circle * circle
    under = half_b * half_b - a * c
    if a == 0.0 or under < 0.0:
        return []
    root = math.sqrt(under)
    return [share for share in ((-half_b - root) / a, (-half_b + root) / a) if 0.0 <= share <= 1.0]


def _give(ego: EgoState, track: Track, gap: float, footprint: Footprint, settings: EmergencySettings) -> float:
    """What the track's motion adds to the gap while both stop; see the module."""
    along = track.speed * math.cos(track.heading - ego.heading - ego.curvature * gap)
    if along >= 0.0:
        return along * along / (2 * settings.others_hardest_braking)
    takes = -along * settings.response_time + along * along / (2 * settings.assured_braking)
    until_met = min(takes, gap * -along / (ego.speed - along))
    turn = track.yaw_rate / track.speed * until_met / 2
    x, y = track.x + until_met * math.cos(track.heading + turn), track.y + until_met * math.sin(track.heading + turn)
    moved = _corners(ego, track, x, y, track.heading + 2 * turn)
    return -takes if _gap(moved, ego.curvature, footprint, settings) < math.inf else 0.0


def full_braking(ego: EgoState, settings: EmergencySettings) -> Trajectory:
    """Constant full braking from the present speed along the present arc, then standing for `plan_hold`; rows every `plan_step`."""
    braking, step = settings.full_braking, settings.plan_step
    stop = ego.speed / braking
    time: NDArray[np.float64] = np.arange(math.ceil((stop + settings.plan_hold) / step) + 1) * np.float64(step)
    moving = np.minimum(time, stop)
    station = ego.speed * moving - braking * moving * moving / 2
    speed = np.maximum(ego.speed - braking * time, 0.0)
    acceleration = np.where(time < stop, -braking, 0.0)
    turn = ego.curvature * station
    chord = station * np.sinc(turn / (2 * math.pi))
    direction = ego.heading + turn / 2
    x, y = ego.x + chord * np.cos(direction), ego.y + chord * np.sin(direction)
    nothing, bend = np.zeros_like(time), np.full_like(time, ego.curvature)
    return Trajectory(time, x, y, ego.heading + turn, speed, acceleration, nothing, bend, station, nothing.copy())
