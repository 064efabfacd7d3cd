"""The lanes of one neighbourhood as flat arrays, so that a place is tested against all of them at once."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from regdb_runtime.maps.lines import SAME_POINT
from regdb_runtime.maps.road_map import Floats, Lane

COURSE_STEP = math.radians(20)
"""Courses that differ from the asked one by about the same, in steps of this, are equally good."""
Place = tuple[str, float, float]
"""A lane, the station along its centre and the offset from it (positive left), metres."""


class LaneCell:
    """Lanes by name, in order: the edges of their outlines and the segments of their centres, one after the other."""

    def __init__(self, names: Sequence[str], lanes: Mapping[str, Lane]) -> None:
        self.names = tuple(names)
        outlines = [np.vstack((lanes[name].left_line, lanes[name].right_line[::-1])) for name in names]
        self._edge_starts = np.cumsum([0, *(len(outline) for outline in outlines)])[:-1]
        self._x1, self._y1 = _stacked(outlines).T
        self._x2, self._y2 = _stacked([np.roll(outline, -1, axis=0) for outline in outlines]).T
        rise = self._y2 - self._y1
        self._slope = (self._x2 - self._x1) / np.where(rise == 0.0, 1.0, rise)
        pieces = [_segments(lanes[name].center) for name in names]
        self._bounds = np.cumsum([0, *(len(piece) for piece in pieces)])
        self._segments = np.vstack(pieces) if pieces else np.empty((0, 7))

    def find(self, x: float, y: float, heading: float | None) -> Place | None:
        """The best lane around a place, None where it lies in none."""
        if not self.names:
            return None
        within = self._within(x, y)
        if not len(within):
            within = self._on_edge(x, y)
        fits = [self.fit(int(row), x, y, heading) for row in within]
        return min(fits)[3:] if fits else None

    def fit(self, row: int, x: float, y: float, heading: float | None) -> tuple[int, float, int, str, float, float]:
        """How well a lane fits (less is better: course, distance from the centre, order), and the place on it."""
        part = self._segments[self._bounds[row] : self._bounds[row + 1]]
        dx, dy = x - part[:, 0], y - part[:, 1]
        along = np.minimum(np.maximum(dx * part[:, 2] + dy * part[:, 3], 0.0), part[:, 4])
        ax, ay = dx - along * part[:, 2], dy - along * part[:, 3]
        squared = ax * ax + ay * ay
        best = int(squared.argmin())
        away = math.sqrt(squared[best])
        side = float(part[best, 2] * dy[best] - part[best, 3] * dx[best])
        off = 0.0 if heading is None else abs(math.remainder(heading - float(part[best, 6]), math.tau))
        return round(off / COURSE_STEP), away, row, self.names[row], float(part[best, 5] + along[best]), math.copysign(away, side)

    def _within(self, x: float, y: float) -> NDArray[np.intp]:
        """Rows of the lanes in whose outline the place lies, by even-odd crossings."""
        met = ((self._y1 > y) != (self._y2 > y)) & (x < self._slope * (y - self._y1) + self._x1)
        return np.flatnonzero(np.add.reduceat(met, self._edge_starts, dtype=np.intp) & 1)

    def _on_edge(self, x: float, y: float) -> NDArray[np.intp]:
        """Rows of the lanes on whose outline the place lies."""
        ex, ey = self._x2 - self._x1, self._y2 - self._y1
        dx, dy = x - self._x1, y - self._y1
        share = np.clip((dx * ex + dy * ey) / np.maximum(ex * ex + ey * ey, SAME_POINT**2), 0.0, 1.0)
        near = np.hypot(dx - share * ex, dy - share * ey) <= SAME_POINT
        return np.flatnonzero(np.logical_or.reduceat(near, self._edge_starts))


def _stacked(lines: list[Floats]) -> Floats:
    return np.vstack(lines) if lines else np.empty((0, 2))


def _segments(center: Floats) -> Floats:
    """x, y, direction (x, y), length, station and heading of each segment of a centre line that has a length (n, 7)."""
    step = np.diff(center, axis=0)
    length = np.hypot(step[:, 0], step[:, 1])
    station = np.concatenate(([0.0], np.cumsum(length)))[:-1]
    real = length > 0.0
    unit = step[real] / length[real, None]
    return np.column_stack((center[:-1][real], unit, length[real], station[real], np.arctan2(unit[:, 1], unit[:, 0])))
