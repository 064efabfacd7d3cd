"""Ground, roadway, markings, crosswalks and limit lines of a frame, flat on the plane z = 0."""

from __future__ import annotations

import math

import numpy as np

from regdb_runtime.maps.lines import at_stations, offset, stations
from regdb_runtime.maps.road_map import Lane, Marking, RoadMap, Side, StopLine
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


def draw_street(canvas: Canvas, road_map: RoadMap) -> None:
    """Everything on the ground, the road's surface first."""
    horizon = canvas.camera.horizon
    canvas.band(0, horizon + 1, SKY_HIGH, SKY_LOW)
    canvas.band(horizon, canvas.size[1], GRASS_FAR, GRASS_NEAR)
    near = [lane for lane in road_map.lanes.values() if _near(canvas, lane.center)]
    for lane in near:
        if lane.right is None and lane.junction is None:
            _walk(canvas, lane)
    for lane in near:
        _surface(canvas, lane)
    for crosswalk in road_map.crosswalks:
        if crosswalk.marked and _near(canvas, crosswalk.polygon):
            _crosswalk(canvas, crosswalk.polygon)
    for lane in near:
        if lane.junction is None:
            for side in ("left", "right"):
                _boundary(canvas, road_map, lane, "left" if side == "left" else "right")
    for line in {lane.stop_line.id: lane.stop_line for lane in near if lane.stop_line is not None and lane.stop_line.marked}.values():
        _limit_line(canvas, line)


def flat(points: Floats, height: float = 0.0) -> Floats:
    """Points of the plane (n, 2) at a height, (n, 3)."""
    return np.column_stack((points, np.full(len(points), height)))


def _near(canvas: Canvas, points: Floats) -> bool:
    away = points - canvas.camera.place[:2]
    ahead = away @ canvas.camera.axes[2][:2]
    return bool(((ahead > -15) & (np.hypot(*away.T) < FARTHEST)).any())


def _pieces(line: Floats, step: float = 4.0) -> Floats:
    """A polyline with a point every few metres, (n, 2)."""
    length = stations(line)[-1]
    return at_stations(line, np.linspace(0, length, max(2, math.ceil(length / step) + 1)))


def _surface(canvas: Canvas, lane: Lane) -> None:
    colour = BICYCLE_GREEN if "bicycle_lane" in lane.kinds else WALK if lane.kinds & {"sidewalk"} else ASPHALT
    left, right = _both(lane)
    for k in range(len(left) - 1):
        if _near(canvas, left[k : k + 2]):
            canvas.polygon(flat(np.array([left[k], left[k + 1], right[k + 1], right[k]])), colour)


def _both(lane: Lane) -> tuple[Floats, Floats]:
    """Left and right side at the same shares of the lane's length."""
    count = max(2, math.ceil(lane.length / 6.0) + 1)
    share = np.linspace(0, 1, count)
    left, right = (at_stations(side, share * stations(side)[-1]) for side in (lane.left_line, lane.right_line))
    return left, right


def _walk(canvas: Canvas, lane: Lane) -> None:
    edge = _pieces(lane.right_line, 8.0)
    kerb, back = offset(edge, -0.15), offset(edge, -0.15 - SIDEWALK)
    for inner, outer, colour in ((edge, kerb, KERB), (kerb, back, WALK)):
        for k in range(len(edge) - 1):
            if _near(canvas, edge[k : k + 2]):
                canvas.polygon(flat(np.array([inner[k], inner[k + 1], outer[k + 1], outer[k]])), colour)


def _boundary(canvas: Canvas, road_map: RoadMap, lane: Lane, side: Side) -> None:
    """A lane's own boundary; of one between two lanes of one direction, the left one draws it."""
    neighbour, same = (lane.left, lane.left_same_direction) if side == "left" else (lane.right, lane.right_same_direction)
    if side == "left" and neighbour is not None and same:
        return
    marking = lane.left_marking if side == "left" else lane.right_marking
    opposing = side == "left" and neighbour is not None and not same
    if opposing and neighbour is not None and neighbour in road_map.lanes and neighbour < lane.id:
        return
    _line(canvas, lane.left_line if side == "left" else lane.right_line, marking, YELLOW_PAINT if opposing else PAINT)


def _line(canvas: Canvas, line: Floats, marking: Marking, colour: Colour) -> None:
    if marking in {"none", "unknown", "curb"}:
        return
    broken = {"dashed": (True,), "solid": (False,), "edge": (False,)}
    parts = broken.get(marking) or {
        "double_solid": (False, False), "double_dashed": (True, True), "solid_dashed": (False, True), "dashed_solid": (True, False)
    }[marking]  # fmt: skip
    for index, dashed in enumerate(parts):
        aside = 0.0 if len(parts) == 1 else WIDE * (1 if index else -1)
        path = offset(line, aside) if aside else line
        for start, end in _dashes(stations(path)[-1]) if dashed else [(0.0, float(stations(path)[-1]))]:
            _strip(canvas, path, start, end, colour)


def _dashes(length: float) -> list[tuple[float, float]]:
    return [(at, min(at + DASH, length)) for at in np.arange(0.0, length, DASH + GAP).tolist()]


def _strip(canvas: Canvas, line: Floats, start: float, end: float, colour: Colour) -> None:
    points = at_stations(line, np.linspace(start, end, max(2, math.ceil((end - start) / 5.0) + 1)))
    if len(points) < 2 or np.hypot(*(points[-1] - points[0])) < 0.05:
        return
    left, right = offset(points, WIDE / 2), offset(points, -WIDE / 2)
    for k in range(len(points) - 1):
        if _near(canvas, points[k : k + 2]):
            canvas.polygon(flat(np.array([left[k], left[k + 1], right[k + 1], right[k]])), colour)


def _crosswalk(canvas: Canvas, polygon: Floats) -> None:
    """Bars along the direction of traffic across the area's longer side."""
    corners = polygon[:4]
    sides = np.diff(np.vstack((corners, corners[:1])), axis=0)
    longest = int(np.argmax(np.hypot(*sides.T)))
    start, along, across = corners[longest], sides[longest], -sides[(longest - 1) % 4]
    length = float(np.hypot(*along))
    count = max(2, int(length / 1.2))
    for k in range(count):
        near, far = start + along * ((k + 0.25) / count), start + along * ((k + 0.75) / count)
        canvas.polygon(flat(np.array([near, far, far + across, near + across])), PAINT)


def _limit_line(canvas: Canvas, line: StopLine) -> None:
    start, end = np.array(line.start), np.array(line.end)
    away = end - start
    normal = np.array([-away[1], away[0]]) / (np.hypot(*away) or 1.0) * LIMIT_LINE / 2
    canvas.polygon(flat(np.array([start + normal, end + normal, end - normal, start - normal])), PAINT)
