"""Where drivers and riders will be: along the lane they are in and on the way it leads, at the speed they have; everybody else straight on."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from regdb_runtime.maps.lane_graph import LaneGraph
from regdb_runtime.maps.lane_path import LanePath, LanePaths
from regdb_runtime.observation import Track
from regdb_runtime.planning.prediction import ConstantVelocity, Predictions
from regdb_runtime.trajectory import Floats

ON_LANES = frozenset(("car", "truck", "bus", "motorcycle", "bicycle"))
SLOWEST = 0.5
"""m/s under which nobody gets far enough within the horizon for a lane to matter."""
AGREES = math.radians(40.0)
"""A track whose heading is farther off its lane's course than this is doing something of its own."""

SHARP = 0.1
"""Least 1 - curvature * offset of a way to be followed: clear of the bends' centres."""


@dataclass(frozen=True, eq=False)
class AlongLanes:
    """Pure for a map: the same tracks give the same bytes. `otherwise` predicts those who are on no lane, or across it."""

    graph: LaneGraph
    built: LanePaths
    otherwise: ConstantVelocity = field(default_factory=ConstantVelocity)

    def predict(self, tracks: Sequence[Track], times: Floats) -> Predictions:
        """See `Predictor`. Offsets from the lane's centre are kept; at a fork the way the turn signal says, else the straightest."""
        found = self.otherwise.predict(tracks, times)
        rows = [row for row, track in enumerate(tracks) if track.kind in ON_LANES and track.speed >= SLOWEST]
        if not rows:
            return found
        x, y, heading = found.x.copy(), found.y.copy(), found.heading.copy()
        points = np.array([(tracks[row].x, tracks[row].y) for row in rows])
        places = self.graph.lanes_at(points, np.array([tracks[row].heading for row in rows]))
        for row, place in zip(rows, places, strict=True):
            if place is not None:
                self._follow(tracks[row], place, times, (x[row], y[row], heading[row]))
        return Predictions(found.ids, found.kinds, times, x, y, heading, found.speed, found.length, found.width, found.reach)

    def _follow(self, track: Track, place: tuple[str, float, float], times: Floats, row: tuple[Floats, Floats, Floats]) -> None:
        lane, station, offset = place
        turned = math.remainder(track.heading - self.graph.heading(lane, station), math.tau)
        if abs(turned) > AGREES:
            return
        way = track.speed * times
        path = self._path(lane, station + float(way[-1]), track)
        stations = station + way
        inside = np.minimum(stations, path.path.end)
        if not math.isfinite(offset):
            return
        there_x, there_y, course, sharp = path.path.drawn(inside, offset)
        if not (sharp > SHARP).all():
            return
        beyond = stations - inside
        x, y, heading = row
        x[:] = there_x + beyond * np.cos(course)
        y[:] = there_y + beyond * np.sin(course)
        heading[:] = course
        x += track.x - x[0]
        y += track.y - y[0]

    def _path(self, lane: str, length: float, track: Track) -> LanePath:
        """The lane and those that follow, as far as is driven."""
        lanes, driven = [lane], self.graph.road_map.lanes[lane].length
        while driven < length and (following := self._onward(lanes[-1], track)) is not None and following not in lanes:
            lanes.append(following)
            driven += self.graph.road_map.lanes[following].length
        return self.built.along(tuple(lanes))

    def _onward(self, lane: str, track: Track) -> str | None:
        ways = self.graph.successors(lane)
        if len(ways) < 2:
            return ways[0] if ways else None
        lanes = self.graph.road_map.lanes
        signalled = [name for name in ways if track.turn_signal in ("left", "right") and lanes[name].turn == track.turn_signal]
        return min(signalled or ways, key=lambda name: (self._bend(name), name))

    def _bend(self, lane: str) -> float:
        """How far a lane turns over its length, radians."""
        found = self.graph.road_map.lanes[lane]
        return abs(math.remainder(self.graph.heading(lane, found.length) - self.graph.heading(lane, 0.0), math.tau))
