"""The lanes as a graph: which lane a place lies in, what follows, precedes and runs beside each lane."""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from functools import cached_property
from itertools import pairwise

import numpy as np

from regdb_runtime.maps.junctions import side_by_side
from regdb_runtime.maps.lane_cells import LaneCell, Place
from regdb_runtime.maps.lines import SAME_POINT
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


CELL = 10.0
"""Side of the squares by which lanes are found, metres: about three lanes, so that a square holds few."""
CHOICES = 512
"""Sets of lanes asked for by `among` whose arrays are kept."""


class LaneGraph:
    """Built once per map; every answer is the same for the same question, ties by id."""

    def __init__(self, road_map: RoadMap) -> None:
        self.road_map = road_map
        self._driven = sorted(name for name, lane in road_map.lanes.items() if not lane.kinds & NOT_DRIVEN)
        self._cells: dict[tuple[int, int], LaneCell] = {}
        self._chosen: dict[tuple[str, ...], LaneCell] = {}

    def lane_at(self, x: float, y: float, heading: float | None = None, among: Collection[str] | None = None) -> Place | None:
        """The lane in which (x, y) lies, with the station along its centre and the offset (positive left), metres; None outside all lanes.

        Where lanes overlap, the one whose course agrees best with `heading` (in steps of 20 degrees), then the one whose centre is nearest.
        `among` limits the question to some lanes; without it, lanes of kinds on which no vehicle drives are left out.
        """
        if among is not None:
            return self._among(tuple(sorted(name for name in among if name in self.road_map.lanes))).find(x, y, heading)
        return self._cell(x, y).find(x, y, heading)

    def lanes_at(self, points: Floats, headings: Floats | None = None) -> list[Place | None]:
        """`lane_at` for many points (m, 2) and headings (m,)."""
        courses = [None] * len(points) if headings is None else headings.tolist()
        return [self._cell(x, y).find(x, y, heading) for (x, y), heading in zip(points.tolist(), courses, strict=True)]

    def nearest(
        self, x: float, y: float, heading: float | None = None, reach: float = math.inf, among: Collection[str] | None = None
    ) -> Place | None:
        """The lane in which the place lies, else the driven one (with `among`: one of those) with the nearest centre within `reach` metres."""
        found = self.lane_at(x, y, heading, among)
        if found is not None:
            return found
        cell = self._among(tuple(self._driven) if among is None else tuple(sorted(name for name in among if name in self.road_map.lanes)))
        fits = [cell.fit(row, x, y, heading) for row in range(len(cell.names))]
        best = min(fits, key=lambda fit: (fit[1], fit), default=None)
        return None if best is None or best[1] > reach else best[3:]

    def lanes_around(self, x: float, y: float, heading: float, reach: float) -> list[tuple[Place, float]]:
        """Every driven lane whose centre runs within `reach` metres (at most CELL) of a place, by id.

        Each comes with how far `heading` is off its course, radians.
        """
        found: dict[str, Place] = {}
        for across in sorted({math.floor((x - reach) / CELL), math.floor((x + reach) / CELL)}):
            for up in sorted({math.floor((y - reach) / CELL), math.floor((y + reach) / CELL)}):
                cell = self._cell((across + 0.5) * CELL, (up + 0.5) * CELL)
                fits = (cell.fit(index, x, y, heading) for index, name in enumerate(cell.names) if name not in found)
                found.update((fit[3], fit[3:]) for fit in fits if fit[1] <= reach)
        places = [found[name] for name in sorted(found)]
        return [(place, abs(math.remainder(heading - self.heading(place[0], place[1]), math.tau))) for place in places]

    @cached_property
    def _boxes(self) -> Floats:
        """Least and greatest x and y of each driven lane (n, 4)."""
        lanes = (self.road_map.lanes[name] for name in self._driven)
        sides = [np.vstack((lane.left_line, lane.right_line)) for lane in lanes]
        return np.array([(*side.min(axis=0), *side.max(axis=0)) for side in sides]).reshape(-1, 4)

    def _cell(self, x: float, y: float) -> LaneCell:
        """The lanes whose boxes touch the square around a place."""
        key = (math.floor(x / CELL), math.floor(y / CELL))
        found = self._cells.get(key)
        if found is None:
            low, high = np.array(key) * CELL - SAME_POINT, (np.array(key) + 1) * CELL + SAME_POINT
            boxes = self._boxes
            near = (boxes[:, :2] <= high).all(axis=1) & (boxes[:, 2:] >= low).all(axis=1)
            found = self._cells[key] = LaneCell([self._driven[row] for row in np.flatnonzero(near)], self.road_map.lanes)
        return found

    def _among(self, names: tuple[str, ...]) -> LaneCell:
        found = self._chosen.get(names)
        if found is None:
            if len(self._chosen) >= CHOICES:
                self._chosen.clear()
            found = self._chosen[names] = LaneCell(names, self.road_map.lanes)
        return found

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
