"""The lanes as a graph: which lane a place lies in, what follows, precedes and runs beside each lane."""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from functools import cached_property
from itertools import pairwise

import numpy as np

from regdb_runtime.maps.junctions import side_by_side
from regdb_runtime.maps.lines import SAME_POINT, angle, inside, project
from regdb_runtime.maps.road_map import Floats, Lane, RoadMap

NOT_DRIVEN = frozenset(("crosswalk", "sidewalk", "walkingarea", "border", "restricted_area"))
"""Kinds of lane on which no vehicle drives; `lane_at` names them only when asked among them."""
DRIVERS = frozenset(("vehicle", "car"))
"""A lane whose users are known is a car's when these are among them."""
OFF_ROUTE = NOT_DRIVEN | {"bicycle_lane", "bus_lane", "parking", "shoulder", "restricted", "tram", "rail"}
"""Kinds of lane that no route of a car runs along."""


def is_driven(lane: Lane) -> bool:
    """Whether a route of a car may run along the lane; users not known count as yes."""
    return not lane.kinds & OFF_ROUTE and (not lane.users or bool(lane.users & DRIVERS))


class LaneGraph:
    """Built once per map; every answer is the same for the same question, ties by id."""

    def __init__(self, road_map: RoadMap) -> None:
        self.road_map = road_map
        self._names = sorted(name for name, lane in road_map.lanes.items() if not lane.kinds & NOT_DRIVEN)
        self._outlines: dict[str, Floats] = {}

    @cached_property
    def _boxes(self) -> Floats:
        corners = [self._outline(name) for name in self._names]
        return np.array([(*outline.min(axis=0), *outline.max(axis=0)) for outline in corners]).reshape(-1, 4)

    def _outline(self, name: str) -> Floats:
        """The lane's polygon: its left side forth, its right side back."""
        if name not in self._outlines:
            lane = self.road_map.lanes[name]
            self._outlines[name] = np.vstack((lane.left_line, lane.right_line[::-1]))
        return self._outlines[name]

    def lane_at(
        self, x: float, y: float, heading: float | None = None, among: Collection[str] | None = None
    ) -> tuple[str, float, float] | None:
        """The lane in which (x, y) lies, with the station along its centre and the offset (positive left), metres; None outside all lanes.

        Where lanes overlap, the one whose course agrees best with `heading` (in steps of 20 degrees), then the one whose centre is nearest.
        `among` limits the question to some lanes; without it, lanes of kinds on which no vehicle drives are left out.
        """
        names = self._candidates(x, y) if among is None else sorted(name for name in among if name in self.road_map.lanes)
        point = np.array([[x, y]])
        within = [name for name in names if inside(point, self._outline(name))[0]]
        if not within:
            within = [name for name in names if self._on_edge(point, name)]
        if not within:
            return None
        best = min((self._fit(point, name, heading) for name in within), key=lambda fit: fit[0])
        return best[1:]

    def lanes_at(self, points: Floats, headings: Floats | None = None) -> list[tuple[str, float, float] | None]:
        """`lane_at` for many points (m, 2) and headings (m,), in one pass over the lanes."""
        hits: list[list[str]] = [[] for _ in points]
        boxes = self._boxes
        for row, name in enumerate(self._names):
            low, high = boxes[row, :2], boxes[row, 2:]
            near = np.flatnonzero(((points >= low) & (points <= high)).all(axis=1))
            if len(near):
                for index in near[inside(points[near], self._outline(name))]:
                    hits[index].append(name)
        found: list[tuple[str, float, float] | None] = []
        for index, names in enumerate(hits):
            heading = None if headings is None else float(headings[index])
            among = names or None
            found.append(self.lane_at(float(points[index, 0]), float(points[index, 1]), heading, among))
        return found

    def nearest(self, x: float, y: float, heading: float | None = None, reach: float = math.inf) -> tuple[str, float, float] | None:
        """The lane in which the place lies, else the driven one with the nearest centre within `reach` metres."""
        found = self.lane_at(x, y, heading)
        if found is not None:
            return found
        point = np.array([[x, y]])
        fits = [self._fit(point, name, heading) for name in self._names]
        fits = [fit for fit in fits if abs(fit[3]) <= reach]
        return min(fits, key=lambda fit: (abs(fit[3]), fit[0]))[1:] if fits else None

    def _candidates(self, x: float, y: float) -> list[str]:
        boxes = self._boxes
        near = (boxes[:, 0] <= x) & (x <= boxes[:, 2]) & (boxes[:, 1] <= y) & (y <= boxes[:, 3])
        return [self._names[row] for row in np.flatnonzero(near)]

    def _on_edge(self, point: Floats, name: str) -> bool:
        outline = self._outline(name)
        return abs(float(project(point, np.vstack((outline, outline[:1])))[1][0])) <= SAME_POINT

    def _fit(self, point: Floats, name: str, heading: float | None) -> tuple[tuple[int, float, str], str, float, float]:
        lane = self.road_map.lanes[name]
        station, away = (float(value[0]) for value in project(point, lane.center))
        off = 0.0 if heading is None else abs(angle(heading - self.heading(name, station)))
        return (round(off / math.radians(20)), abs(away), name), name, station, away

    def heading(self, lane: str, station: float) -> float:
        """Course of a lane's centre at a station, radians."""
        center, along = self.road_map.lanes[lane].center, self.road_map.lanes[lane].stations
        row = min(max(int(np.searchsorted(along, station, side="right")) - 1, 0), len(center) - 2)
        while row < len(center) - 2 and along[row + 1] - along[row] <= SAME_POINT:
            row += 1
        dx, dy = center[row + 1] - center[row]
        return math.atan2(dy, dx)

    def successors(self, lane: str) -> tuple[str, ...]:
        """Lanes that follow."""
        return self.road_map.lanes[lane].successors

    def predecessors(self, lane: str) -> tuple[str, ...]:
        """Lanes that lead here."""
        return self.road_map.lanes[lane].predecessors

    def neighbors(self, lane: str) -> tuple[str, ...]:
        """All lanes beside this one in its direction, without itself, from left to right."""
        return tuple(name for name in side_by_side(self.road_map.lanes, lane) if name != lane)

    def left(self, lane: str) -> str | None:
        """The lane to the left in the same direction."""
        found = self.road_map.lanes[lane]
        return found.left if found.left_same_direction else None

    def right(self, lane: str) -> str | None:
        """The lane to the right in the same direction."""
        found = self.road_map.lanes[lane]
        return found.right if found.right_same_direction else None

    def oncoming(self, lane: str) -> str | None:
        """The lane of the other direction beside the leftmost lane of this one, None without or unknown."""
        row = side_by_side(self.road_map.lanes, lane)
        edge = self.road_map.lanes[row[0]]
        return None if edge.left_same_direction else edge.left

    def junction_of(self, lane: str) -> str | None:
        """The junction a lane lies in."""
        return self.road_map.lanes[lane].junction

    def along(self, lanes: Sequence[str]) -> bool:
        """Whether each lane follows the one before."""
        return all(second in self.successors(first) for first, second in pairwise(lanes))
