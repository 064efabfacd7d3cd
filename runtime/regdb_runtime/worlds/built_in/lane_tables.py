"""Lanes as tables at even stations: the pose at a station in constant time, and all lanes under a point at once."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

import numpy as np

from regdb_runtime.maps.road_map import CROSSABLE, Lane, RoadMap

STEP = 0.5
"""Distance between a table's rows, metres."""
LATERAL_COMFORT = 1.8
"""Sideways acceleration people turn with, m/s^2 (AASHTO's low-speed turns: 1.5-2.5)."""


class LaneTable:
    """One lane: poses at every half metre, its neighbours' room, and the speed its curve lets people drive."""

    def __init__(self, lane: Lane, road_map: RoadMap) -> None:
        self.id, self.length = lane.id, lane.length
        self.inner = lane.junction is not None
        self.junction, self.turn = lane.junction, lane.turn
        self.bicycle = "bicycle_lane" in lane.kinds
        self.limit = lane.speed_limit if lane.speed_limit is not None else 13.4
        self.successors = lane.successors
        self.predecessors = lane.predecessors
        self.lights = lane.lights
        self.control = str(lane.facts.get("intersection.control", "none"))
        count = max(2, math.ceil(lane.length / STEP) + 1)
        stations = np.linspace(0.0, lane.length, count)
        self.step = float(stations[1])
        x, y = (np.interp(stations, lane.stations, lane.center[:, axis]) for axis in (0, 1))
        steps = np.diff(lane.center, axis=0)
        middles = (lane.stations[1:] + lane.stations[:-1]) / 2
        headings = np.interp(stations, middles, np.unwrap(np.arctan2(steps[:, 1], steps[:, 0])))
        self.points = np.column_stack([x, y])
        self.x, self.y, self.heading = x.tolist(), y.tolist(), headings.tolist()
        self.half_width = float(lane.widths.min()) / 2
        bend = float(np.abs(np.gradient(headings, self.step)).max()) if count > 2 else 0.0
        self.curve_speed = min(40.0, math.sqrt(LATERAL_COMFORT / max(bend, 1e-4)))
        self.stop_station = _stop_station(lane)
        left = road_map.lanes.get(lane.left) if lane.left is not None and lane.left_marking in CROSSABLE else None
        self.left = None if left is None else left.id
        self.left_same_direction = lane.left_same_direction
        self.left_room = 0.0 if left is None else float(left.widths.min())

    def pose(self, station: float, offset: float = 0.0) -> tuple[float, float, float]:
        """(x, y, heading) at a station, `offset` metres to the left; straight on beyond the ends."""
        at = station / self.step
        index = min(max(int(at), 0), len(self.x) - 2)
        part = at - index
        x = self.x[index] + part * (self.x[index + 1] - self.x[index])
        y = self.y[index] + part * (self.y[index + 1] - self.y[index])
        inside = min(max(part, 0.0), 1.0)
        heading = self.heading[index] + inside * (self.heading[index + 1] - self.heading[index])
        if offset == 0.0:
            return x, y, heading
        return x - offset * math.sin(heading), y + offset * math.cos(heading), heading

    def bend(self, station: float) -> float:
        """Curvature at a station, 1/m."""
        index = min(max(int(station / self.step), 0), len(self.x) - 2)
        return float((self.heading[index + 1] - self.heading[index]) / self.step)

    def project(self, x: float, y: float, index: int) -> tuple[float, float]:
        """Station and offset of a point whose nearest row is `index`; stations run on beyond the ends."""
        cos, sin = math.cos(self.heading[index]), math.sin(self.heading[index])
        dx, dy = x - self.x[index], y - self.y[index]
        return index * self.step + cos * dx + sin * dy, cos * dy - sin * dx


class LaneTables(Mapping[str, LaneTable]):
    """Every lane's table by id, and the search for lanes under a point."""

    def __init__(self, road_map: RoadMap) -> None:
        self._tables = {name: LaneTable(lane, road_map) for name, lane in road_map.lanes.items()}
        self._list = list(self._tables.values())
        self._points = np.concatenate([table.points for table in self._list])
        self._starts = np.cumsum([0, *(len(table.points) for table in self._list)])[:-1]

    def __getitem__(self, name: str) -> LaneTable:
        return self._tables[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._tables)

    def __len__(self) -> int:
        return len(self._tables)

    def under(self, x: float, y: float, reach: float) -> list[tuple[LaneTable, float, float]]:
        """(lane, station, offset) of every lane whose middle comes within `reach` metres of a point and that runs beside it."""
        gaps = np.square(self._points[:, 0] - x) + np.square(self._points[:, 1] - y)
        nearest = np.minimum.reduceat(gaps, self._starts)
        found = []
        for place in np.flatnonzero(nearest < reach * reach).tolist():
            table = self._list[place]
            begin = self._starts[place]
            index = int(np.argmin(gaps[begin : begin + len(table.x)]))
            station, offset = table.project(x, y, index)
            if -2.0 <= station <= table.length + 2.0:
                found.append((table, station, offset))
        return found


def _stop_station(lane: Lane) -> float | None:
    """Where a vehicle's front stands at the lane's limit line; None without one."""
    if lane.stop_line is None:
        return None
    x, y = (np.array(lane.stop_line.start) + np.array(lane.stop_line.end)) / 2
    steps = np.diff(lane.center, axis=0)
    lengths = np.hypot(steps[:, 0], steps[:, 1])
    along = np.clip(((x - lane.center[:-1, 0]) * steps[:, 0] + (y - lane.center[:-1, 1]) * steps[:, 1]) / lengths, 0.0, lengths)
    feet = lane.center[:-1] + steps * (along / lengths)[:, None]
    nearest = int(np.argmin(np.hypot(feet[:, 0] - x, feet[:, 1] - y)))
    return float(lane.stations[nearest] + along[nearest])
