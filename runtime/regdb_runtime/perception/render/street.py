"""Ground, roadway, markings, crosswalks and limit lines: flat on the plane z = 0, laid out once for a map, projected at once for a frame."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from regdb_runtime.maps.lines import at_stations, offset, stations
from regdb_runtime.maps.road_map import Lane, Marking, RoadMap, Side, StopLine
from regdb_runtime.perception.render.camera import NEAREST
from regdb_runtime.perception.render.canvas import Canvas
from regdb_runtime.perception.render.sign_faces import Colour
from regdb_runtime.planning.trajectory import Floats

SKY_HIGH: Colour = (96, 150, 205)
SKY_LOW: Colour = (206, 224, 236)
GRASS_FAR: Colour = (146, 160, 126)
GRASS_NEAR: Colour = (104, 124, 82)
ASPHALT: Colour = (84, 86, 90)
BICYCLE_GREEN: Colour = (66, 112, 84)
WALK: Colour = (172, 170, 164)
KERB: Colour = (198, 196, 190)
PAINT: Colour = (232, 232, 226)
YELLOW_PAINT: Colour = (226, 178, 44)

WIDE = 0.12
"""Width of a longitudinal line, metres (4 to 6 in, MUTCD 3A.06)."""
DASH, GAP = 3.05, 9.15
"""Broken line: 10 ft of line, 30 ft of gap (MUTCD 3A.06)."""
LIMIT_LINE = 0.45
"""Width of a limit line, metres (12 to 24 in)."""
FARTHEST = 160.0
"""Metres beyond which nothing on the ground is drawn."""
SIDEWALK = 2.2
"""Width of the walk drawn behind a kerb, metres."""
BEHIND = 15.0
"""Metres behind the camera to which the ground is still projected: what begins there may reach before it."""

Quads = Iterator[tuple[Floats, Colour]]
"""Polygons of four points (4, 2) with their colours, in the order in which they are painted."""


class Ground:
    """Everything flat of one map, as quads in the order of painting: `corners` (n, 4, 2), `colours` (n)."""

    def __init__(self, road_map: RoadMap) -> None:
        quads = list(_quads(road_map))
        self.corners = np.array([corners for corners, _ in quads]).reshape(-1, 4, 2)
        self.colours = [colour for _, colour in quads]
        self._middles = self.corners.mean(axis=1)

    def draw(self, canvas: Canvas) -> None:
        """Sky, grass, and every quad in view."""
        camera = canvas.camera
        canvas.band(0, camera.horizon + 1, SKY_HIGH, SKY_LOW)
        canvas.band(camera.horizon, canvas.size[1], GRASS_FAR, GRASS_NEAR)
        near = self._near(canvas)
        points = np.zeros((len(near), 4, 3))
        points[:, :, :2] = self.corners[near]
        seen = camera.seen(points.reshape(-1, 3)).reshape(-1, 4, 3)
        whole = seen[:, :, 2].min(axis=1) > NEAREST
        pixels = np.zeros((len(near), 4, 2))
        pixels[whole] = camera.pixels(seen[whole].reshape(-1, 3)).reshape(-1, 4, 2)
        for row, index in enumerate(near.tolist()):
            if whole[row]:
                canvas.fill(pixels[row], self.colours[index])
            else:
                canvas.polygon(points[row], self.colours[index])

    def _near(self, canvas: Canvas) -> NDArray[np.intp]:
        """Quads within reach and not wholly behind."""
        away = self._middles - canvas.camera.place[:2]
        ahead = away @ canvas.camera.axes[2][:2]
        return np.flatnonzero((ahead > -BEHIND) & (np.einsum("nk,nk->n", away, away) < FARTHEST**2))


def _quads(road_map: RoadMap) -> Quads:
    lanes = list(road_map.lanes.values())
    for lane in lanes:
        if lane.right is None and lane.junction is None:
            yield from _walk(lane)
    for lane in lanes:
        yield from _surface(lane)
    for crosswalk in road_map.crosswalks:
        if crosswalk.marked:
            yield from _crosswalk(crosswalk.polygon)
    for lane in lanes:
        if lane.junction is None:
            yield from _boundary(road_map, lane, "left")
            yield from _boundary(road_map, lane, "right")
    for line in {lane.stop_line.id: lane.stop_line for lane in lanes if lane.stop_line is not None and lane.stop_line.marked}.values():
        yield _limit_line(line), PAINT


def _between(left: Floats, right: Floats, colour: Colour) -> Quads:
    """The strip between two polylines of as many points."""
    for k in range(len(left) - 1):
        yield np.array([left[k], left[k + 1], right[k + 1], right[k]]), colour


def _surface(lane: Lane) -> Quads:
    colour = BICYCLE_GREEN if "bicycle_lane" in lane.kinds else WALK if "sidewalk" in lane.kinds else ASPHALT
    share = np.linspace(0, 1, max(2, math.ceil(lane.length / 6.0) + 1))
    left, right = (at_stations(side, share * stations(side)[-1]) for side in (lane.left_line, lane.right_line))
    yield from _between(left, right, colour)


def _walk(lane: Lane) -> Quads:
    length = stations(lane.right_line)[-1]
    edge = at_stations(lane.right_line, np.linspace(0, length, max(2, math.ceil(length / 8.0) + 1)))
    kerb, back = offset(edge, -0.15), offset(edge, -0.15 - SIDEWALK)
    yield from _between(edge, kerb, KERB)
    yield from _between(kerb, back, WALK)


def _boundary(road_map: RoadMap, lane: Lane, side: Side) -> Quads:
    """A lane's own boundary; the one between two lanes is drawn once, by the lane to its left, or by the first of two that oppose."""
    neighbour, same = (lane.left, lane.left_same_direction) if side == "left" else (lane.right, lane.right_same_direction)
    if side == "left" and neighbour is not None and same:
        return
    opposing = side == "left" and neighbour is not None and not same
    if opposing and neighbour in road_map.lanes and str(neighbour) < lane.id:
        return
    marking = lane.left_marking if side == "left" else lane.right_marking
    yield from _line(lane.left_line if side == "left" else lane.right_line, marking, YELLOW_PAINT if opposing else PAINT)


def _line(line: Floats, marking: Marking, colour: Colour) -> Quads:
    parts: dict[Marking, tuple[bool, ...]] = {
        "dashed": (True,), "solid": (False,), "edge": (False,), "double_solid": (False, False), "double_dashed": (True, True),
        "solid_dashed": (False, True), "dashed_solid": (True, False),
    }  # fmt: skip
    drawn = parts.get(marking, ())
    for index, dashed in enumerate(drawn):
        aside = 0.0 if len(drawn) == 1 else WIDE * (1 if index else -1)
        path = offset(line, aside) if aside else line
        length = float(stations(path)[-1])
        for start, end in _dashes(length) if dashed else [(0.0, length)]:
            yield from _strip(path, start, end, colour)


def _dashes(length: float) -> list[tuple[float, float]]:
    return [(at, min(at + DASH, length)) for at in np.arange(0.0, length, DASH + GAP).tolist()]


def _strip(line: Floats, start: float, end: float, colour: Colour) -> Quads:
    if end - start >= 0.05:
        points = at_stations(line, np.linspace(start, end, max(2, math.ceil((end - start) / 5.0) + 1)))
        yield from _between(offset(points, WIDE / 2), offset(points, -WIDE / 2), colour)


def _crosswalk(polygon: Floats) -> Quads:
    """Bars along the direction of traffic, side by side along the area's longer side."""
    corners = polygon[:4]
    sides = np.diff(np.vstack((corners, corners[:1])), axis=0)
    longest = int(np.argmax(np.hypot(*sides.T)))
    start, along, across = corners[longest], sides[longest], -sides[(longest - 1) % 4]
    count = max(2, int(np.hypot(*along) / 1.2))
    for k in range(count):
        near, far = start + along * ((k + 0.25) / count), start + along * ((k + 0.75) / count)
        yield np.array([near, far, far + across, near + across]), PAINT


def _limit_line(line: StopLine) -> Floats:
    start, end = np.array(line.start), np.array(line.end)
    away = end - start
    normal = np.array([-away[1], away[0]]) / (np.hypot(*away) or 1.0) * LIMIT_LINE / 2
    return np.array([start + normal, end + normal, end - normal, start - normal])
