"""Downtrack distance: the station along the route (paper, section IV-A), and where on it lines, junctions and zones lie.

Made from the map's centre lines alone, so that what is measured by it does not depend on the planner.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from regdb_runtime.maps.road_map import Lane, RoadMap, Zone

Floats = NDArray[np.float64]
SLACK = 1e-6
"""Metres: a limit line drawn exactly through a point of the route, as at the end of a lane, is crossed there."""
_JOIN = 0.5
"""Metres under which the end of one lane and the beginning of the next are one point."""


@dataclass(frozen=True, slots=True)
class Span:
    """A stretch of the route: stations in metres."""

    start: float
    end: float


class Downtrack:
    """The route's centre line as one polyline; stations in metres from its first point."""

    def __init__(self, road_map: RoadMap, route: Sequence[str]) -> None:
        lanes = [road_map.lanes[name] for name in route]
        self.points, self.starts = _joined(lanes)
        steps = np.hypot(*np.diff(self.points, axis=0).T)
        self.stations: Floats = np.concatenate(([0.0], np.cumsum(steps)))
        self._directions = np.diff(self.points, axis=0) / steps[:, None]
        self._steps = steps
        self._lanes = dict(zip(route, lanes, strict=True))

    @property
    def length(self) -> float:
        """Metres from the route's beginning to its end."""
        return float(self.stations[-1])

    def locate(self, x: float, y: float, near: float | None = None, reach: float = 30.0) -> tuple[float, float]:
        """Station and offset (left positive) of a point: the nearest place of the route, within `reach` metres of station `near`."""
        first, last = 0, len(self._steps)
        if near is not None:
            first = max(0, int(np.searchsorted(self.stations, near - reach)) - 1)
            last = min(last, int(np.searchsorted(self.stations, near + reach)) + 1)
            first = min(first, last - 1)
        relative = np.array((x, y)) - self.points[first:last]
        along = np.einsum("ij,ij->i", relative, self._directions[first:last])
        clipped = np.clip(along, 0.0, self._steps[first:last])
        gaps = np.hypot(*(relative - clipped[:, None] * self._directions[first:last]).T)
        best = int(np.argmin(gaps))
        beyond = self._beyond(best + first, float(along[best]))
        direction = self._directions[best + first]
        offset = float(direction[0] * relative[best, 1] - direction[1] * relative[best, 0])
        return float(self.stations[best + first] + clipped[best] + beyond), offset

    def _beyond(self, index: int, along: float) -> float:
        """How far a point lies before the first or past the last point of the route, negative before."""
        if index == 0 and along < 0:
            return along
        past = along - float(self._steps[index])
        return past if index == len(self._steps) - 1 and past > 0 else 0.0

    def crossing(self, start: tuple[float, float], end: tuple[float, float], reach: float = 12.0) -> float | None:
        """The first station where the route crosses a line whose ends are lengthened by `reach` metres; None where it does not."""
        length = math.dist(start, end) or 1.0
        unit = (end[0] - start[0]) / length, (end[1] - start[1]) / length
        longer = (start[0] - reach * unit[0], start[1] - reach * unit[1]), (end[0] + reach * unit[0], end[1] + reach * unit[1])
        return next(iter(self._crossings(*longer, slack=SLACK)), None)

    def _crossings(self, start: tuple[float, float], end: tuple[float, float], slack: float = 0.0) -> list[float]:
        """Stations at which the route crosses a segment, in order; with `slack` also where rounding puts the crossing between two of its pieces."""
        (ax, ay), (bx, by) = start, end
        across = np.array((bx - ax, by - ay))
        relative = np.array((ax, ay)) - self.points[:-1]
        bottom = self._directions[:, 0] * across[1] - self._directions[:, 1] * across[0]
        with np.errstate(divide="ignore", invalid="ignore"):
            along = (relative[:, 0] * across[1] - relative[:, 1] * across[0]) / bottom
            part = (relative[:, 0] * self._directions[:, 1] - relative[:, 1] * self._directions[:, 0]) / bottom
        hit = (np.abs(bottom) > 1e-9) & (along >= -slack) & (along <= self._steps + slack) & (part >= 0) & (part <= 1)
        return [float(self.stations[i] + along[i]) for i in np.flatnonzero(hit)]

    def within(self, zone: Zone) -> tuple[Span, ...]:
        """The stretches of the route inside a zone's polygon."""
        ring = [(float(x), float(y)) for x, y in zone.polygon]
        edges = zip(ring, [*ring[1:], ring[0]], strict=True)
        cuts = sorted({0.0, self.length, *(station for start, end in edges for station in self._crossings(start, end))})
        spans = [Span(start, end) for start, end in itertools.pairwise(cuts) if _inside(self.point((start + end) / 2), ring)]
        return tuple(_merged(spans))

    def point(self, station: float) -> tuple[float, float]:
        """The place on the route at a station."""
        x, y = (np.interp(station, self.stations, self.points[:, axis]) for axis in (0, 1))
        return float(x), float(y)

    def lane_spans(self) -> dict[str, Span]:
        """Each lane of the route with the stretch it covers."""
        ends = [*self.starts[1:], self.length]
        return {name: Span(start, end) for (name, start), end in zip(zip(self._lanes, self.starts, strict=True), ends, strict=True)}

    def stop_line(self, name: str) -> float | None:
        """The station of a lane's stop line, None where it has none or the route does not cross it."""
        line = self._lanes[name].stop_line
        return None if line is None else self.crossing(line.start, line.end)


def _joined(lanes: Sequence[Lane]) -> tuple[Floats, list[float]]:
    """The lanes' centre points as one line without doubles, and the station at which each lane begins."""
    points: list[tuple[float, float]] = []
    starts, length = [], 0.0
    for lane in lanes:
        starts.append(length)
        for x, y in lane.center:
            here = float(x), float(y)
            step = math.dist(points[-1], here) if points else 0.0
            if points and (step < 1e-6 or (here == tuple(map(float, lane.center[0])) and step < _JOIN)):
                continue
            length += step
            points.append(here)
    return np.array(points), starts


def _inside(point: tuple[float, float], ring: Sequence[tuple[float, float]]) -> bool:
    """Whether a point lies in a polygon (even-odd rule)."""
    x, y = point
    found = False
    for (ax, ay), (bx, by) in zip(ring, [*ring[1:], ring[0]], strict=True):
        if (ay > y) != (by > y) and x < ax + (y - ay) / (by - ay) * (bx - ax):
            found = not found
    return found


def _merged(spans: Sequence[Span]) -> list[Span]:
    """Neighbouring spans as one."""
    found: list[Span] = []
    for span in spans:
        if found and math.isclose(found[-1].end, span.start):
            found[-1] = Span(found[-1].start, span.end)
        else:
            found.append(span)
    return found
