"""A reference path: stations and offsets along a smooth line, both ways, for points and for the vehicle's motion.

Stations s are arc length, offsets d are positive to the left. Frenet conversion with curvature and acceleration after Werling et al.,
Optimal Trajectory Generation for Dynamic Street Scenarios in a Frenet Frame (ICRA 2010), with derivatives of the offset by station, which
hold at a stand as well.
"""

from __future__ import annotations

import math
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from regdb_runtime.errors import OutsideDomain
from regdb_runtime.maps.point_projection import project_one
from regdb_runtime.maps.smoothing import Floats, PathSettings, tabulate
from regdb_runtime.observation import EgoState
from regdb_runtime.trajectory import FrenetState

COARSE = 2.0
"""Metres between the points among which the nearest is sought first: less than any lane's radius of curvature."""
BLOCK = 2048
"""Points projected at a time, so that all that is held of them stays in the processor's cache."""
EDGE = 1e-6
"""Metres by which a station may pass an end: rounding, not geometry."""
CLOSEST = 0.05
"""Least 1 - curvature * offset at which a point's place is still sharp; at 0 it is the centre of curvature."""
SAME_POINT = 1e-6
FEW = 6
"""Points up to which one by one, in plain numbers, is faster than all together; the bits are the same."""


class ReferencePath:
    """A smooth line through waypoints (n, 2) in metres, in order, with places of it by station.

    `start` is 0 and `end` is `length`, unless the path was extended. Raises ValueError for fewer than two different points.
    """

    def __init__(self, points: ArrayLike, settings: PathSettings | None = None) -> None:
        line = np.asarray(points, dtype=np.float64)
        if line.ndim != 2 or line.shape[1] != 2 or not np.isfinite(line).all():
            raise ValueError("a path needs points as rows of two finite numbers")
        apart = np.hypot(*np.diff(line, axis=0).T) > SAME_POINT
        line = line[np.concatenate(([True], apart))] if len(line) else line
        if len(line) < 2:
            raise ValueError("a path needs two different points")
        self.tabulated = tabulate(line, settings or PathSettings())
        self.length = self.tabulated.last

    @property
    def start(self) -> float:
        """First station of the domain."""
        return self.tabulated.first

    @property
    def end(self) -> float:
        """Last station of the domain."""
        return self.tabulated.last

    def extended(self, before: float = 0.0, after: float = 0.0) -> ReferencePath:
        """The same path, going on straight for at least so many metres beyond its ends; stations stay what they were."""
        path = ReferencePath.__new__(ReferencePath)
        path.tabulated = self.tabulated.extended(before, after)
        path.length = self.length
        return path

    def to_plane(self, s: ArrayLike, d: ArrayLike = 0.0) -> Floats:
        """Points (m, 2) of stations and offsets (m,). Raises OutsideDomain."""
        stations, offsets = np.broadcast_arrays(np.atleast_1d(np.asarray(s, float)), np.atleast_1d(np.asarray(d, float)))
        index, step = self._nearest(self._checked(stations))
        table = self.tabulated
        bend, rate = table.curvature[index], table.curvature_rate[index]
        self._check_offsets(stations, offsets, bend + rate * step)
        along, across = _developed(bend, rate, step)
        cos, sin = table.cos[index], table.sin[index]
        turn_cos, turn_sin = _turned(cos, sin, bend * step + rate * step * step / 2)
        x = table.x[index] + along * cos - across * sin - offsets * turn_sin
        y = table.y[index] + along * sin + across * cos + offsets * turn_cos
        return np.column_stack((x, y))

    def drawn(self, s: Floats, d: float) -> tuple[Floats, Floats, Floats, Floats]:
        """x, y and the path's direction at stations (m,) with one offset, and 1 - curvature * offset there: how sharp those points are.

        As `to_plane` and `heading`, in one go; points at a centre of curvature are the caller's matter. Raises OutsideDomain for stations.
        """
        index, step = self._nearest(self._checked(s))
        table = self.tabulated
        bend, rate, turn = table.curvature.take(index), table.curvature_rate.take(index), table.heading.take(index)
        along, across = _developed(bend, rate, step)
        cos, sin = table.cos.take(index), table.sin.take(index)
        turn_cos, turn_sin = _turned(cos, sin, bend * step + rate * step * step / 2)
        x = table.x.take(index) + along * cos - across * sin - d * turn_sin
        y = table.y.take(index) + along * sin + across * cos + d * turn_cos
        return x, y, turn + step * (bend + step / 2 * rate), 1.0 - (bend + rate * step) * d

    def heading(self, s: ArrayLike) -> Floats:
        """Direction at stations, radians, continuous along the path."""
        if isinstance(s, float):
            place, left = self._entry(s)
            seen = self.tabulated
            return np.asarray(seen.heading.item(place) + left * (seen.curvature.item(place) + left / 2 * seen.curvature_rate.item(place)))
        index, step = self._nearest(self._checked(np.asarray(s, float)))
        table = self.tabulated
        return np.asarray(table.heading[index] + step * (table.curvature[index] + step / 2 * table.curvature_rate[index]))

    def curvature(self, s: ArrayLike) -> Floats:
        """Curvature at stations, 1/m, positive to the left."""
        if isinstance(s, float):
            place, left = self._entry(s)
            return np.asarray(self.tabulated.curvature.item(place) + left * self.tabulated.curvature_rate.item(place))
        index, step = self._nearest(self._checked(np.asarray(s, float)))
        return np.asarray(self.tabulated.curvature[index] + step * self.tabulated.curvature_rate[index])

    def curvature_rate(self, s: ArrayLike) -> Floats:
        """Derivative of the curvature by station, 1/m^2."""
        if isinstance(s, float):
            return np.asarray(self.tabulated.curvature_rate.item(self._entry(s)[0]))
        return np.asarray(self.tabulated.curvature_rate[self._nearest(self._checked(np.asarray(s, float)))[0]])

    def project(self, xy: ArrayLike, extend: bool = False) -> tuple[Floats, Floats]:
        """Station and offset (m,) of the nearest point of the path to each point (m, 2).

        Raises OutsideDomain for a point beyond the ends, or on the inside of a bend at its centre of curvature. With `extend` nothing is
        raised: beyond the ends the path goes on straight, and such a point has the distance for offset.
        """
        points = np.asarray(xy, dtype=np.float64).reshape(-1, 2)
        station, offset, sharp = np.empty((3, len(points)))
        if len(points) <= FEW and np.isfinite(points).all():
            self._project_few(points, station, offset, sharp)
        else:
            for begin in range(0, len(points), BLOCK):
                part = slice(begin, begin + BLOCK)
                self._project(points[part], station[part], offset[part], sharp[part])
        if not extend:
            self._checked(station)
            if len(points) and float(sharp.min()) < CLOSEST:
                worst = int(np.argmin(sharp))
                raise OutsideDomain(
                    f"offset {offset[worst]:.2f} m at station {station[worst]:.2f} m reaches the centre of curvature", offset=float(offset[worst])
                )
        return station, offset

    def frenet_state(self, ego: EgoState) -> FrenetState:
        """The vehicle's motion along the path. Raises OutsideDomain, also when it heads across or against the path."""
        station, offset = (float(value[0]) for value in self.project([(ego.x, ego.y)]))
        bend, rate = float(self.curvature(station)), float(self.curvature_rate(station))
        across = math.remainder(ego.heading - float(self.heading(station)), math.tau)
        if math.cos(across) < CLOSEST:
            raise OutsideDomain(f"heading {math.degrees(across):.0f} degrees off the path at station {station:.2f} m", station=station)
        scale = 1.0 - bend * offset
        slope = scale * math.tan(across)
        stretch = math.hypot(scale, slope)  # metres of the vehicle's way for each of the path
        change = rate * offset + bend * slope  # -d(scale)/ds
        curl = ((ego.curvature * stretch - bend) * stretch * stretch - change * slope) / scale
        s_dot = ego.speed / stretch
        s_ddot = (ego.acceleration - s_dot * s_dot * (slope * curl - scale * change) / stretch) / stretch
        return FrenetState(station, s_dot, s_ddot, offset, slope * s_dot, curl * s_dot**2 + slope * s_ddot, slope, curl)

    def ego_state(self, state: FrenetState) -> EgoState:
        """The vehicle whose motion along the path this is; the reverse of `frenet_state`. Raises OutsideDomain."""
        (x, y), bend, rate = self.to_plane(state.s, state.d)[0], float(self.curvature(state.s)), float(self.curvature_rate(state.s))
        slope, curl, scale = state.slope, state.bend, 1.0 - bend * state.d
        stretch = math.hypot(scale, slope)
        change = rate * state.d + bend * slope
        curvature = ((curl * scale + change * slope) / stretch**2 + bend) / stretch
        acceleration = state.s_ddot * stretch + state.s_dot**2 * (slope * curl - scale * change) / stretch
        heading = math.remainder(float(self.heading(state.s)) + math.atan2(slope, scale), math.tau)
        return EgoState(float(x), float(y), heading, state.s_dot * stretch, acceleration, curvature)

    def _nearest(self, stations: Floats) -> tuple[NDArray[np.intp], Floats]:
        """Index of the table's nearest entry, and the way on from there."""
        place = (stations - self.tabulated.first) / self.tabulated.step
        index = _within(np.rint(place), 0, len(self.tabulated.x) - 1).astype(np.intp)
        return index, (place - index) * self.tabulated.step

    def _entry(self, station: float) -> tuple[int, float]:
        """As `_nearest`, of one station of the domain. Raises OutsideDomain."""
        table = self.tabulated
        if not table.first - EDGE <= station <= table.last + EDGE:
            self._checked(np.asarray(station))
        place = (station - table.first) / table.step
        index = min(max(round(place), 0), len(table.x) - 1)
        return index, (place - index) * table.step

    def _checked(self, stations: Floats) -> Floats:
        table = self.tabulated
        out = (stations < table.first - EDGE) | (stations > table.last + EDGE)
        if np.any(out):
            wrong = float(stations[out].flat[0]) if stations.ndim else float(stations)
            raise OutsideDomain(f"station {wrong:.2f} m is not within {table.first:.2f} to {table.last:.2f} m", station=wrong)
        return stations

    def _check_offsets(self, stations: Floats, offsets: Floats, curvature: Floats) -> None:
        beyond = 1.0 - curvature * offsets < CLOSEST
        if beyond.any():
            at = int(np.argmax(beyond))
            message = f"offset {offsets[at]:.2f} m at station {stations[at]:.2f} m reaches the centre of curvature"
            raise OutsideDomain(message, offset=float(offsets[at]))

    @cached_property
    def _coarse(self) -> tuple[NDArray[np.intp], NDArray[np.float32], Floats]:
        """Entries of the table every `COARSE` metres, the factors (3, k) that give squared distances to them, and what they are relative to."""
        table = self.tabulated
        every = max(1, round(COARSE / table.step))
        index = np.append(np.arange(0, len(table.x) - 1, every), len(table.x) - 1)
        x, y = table.x[index], table.y[index]
        middle = np.array([x.mean(), y.mean()])
        x, y = x - middle[0], y - middle[1]
        return index, np.stack((-2 * x, -2 * y, x * x + y * y)).astype(np.float32), middle

    def _nearest_coarse(self, points: Floats) -> NDArray[np.intp]:
        """The nearest of the coarse entries to each point (m, 2), as entries of the table (m,)."""
        coarse, factors, middle = self._coarse
        homogeneous = np.ones((len(points), 3), dtype=np.float32)
        homogeneous[:, :2] = points - middle
        return np.asarray(coarse[np.argmin(homogeneous @ factors, axis=1)])

    def _project_few(self, points: Floats, station: Floats, offset: Floats, sharp: Floats) -> None:
        """As `_project`, point by point."""
        entries = self._nearest_coarse(points).tolist() if len(points) else []
        for row, ((px, py), index) in enumerate(zip(points.tolist(), entries, strict=True)):
            station[row], offset[row], sharp[row] = project_one(self.tabulated, px, py, index, COARSE)

    def _project(self, points: Floats, station: Floats, offset: Floats, sharp: Floats) -> None:
        """Nearest coarse entry, two steps of Newton's from entry to entry, two within the last; writes into the three arrays."""
        table = self.tabulated
        index = self._nearest_coarse(points)
        last, px, py = len(table.x) - 1, points[:, 0].copy(), points[:, 1].copy()
        for _ in range(2):
            along, across, bend = self._seen_from(px, py, index)
            move = along / np.maximum(1.0 - bend * across, 0.2)
            index = _within(index + np.rint(_within(move, -COARSE, COARSE) / table.step).astype(np.intp), 0, last)
        along, across, bend = self._seen_from(px, py, index)
        rate = table.curvature_rate.take(index)
        move = _within(along / np.maximum(1.0 - bend * across, 0.2), -COARSE, COARSE)
        for _ in range(2):
            ahead, aside = _developed(bend, rate, move)
            turn = move * (bend + rate * move / 2)
            cos, sin = 1.0 - turn * turn / 2, turn - turn * turn * turn / 6
            ahead, aside = along - ahead, across - aside
            miss, side = ahead * cos + aside * sin, aside * cos - ahead * sin
            scale = 1.0 - (bend + rate * move) * side
            move = move + miss / np.maximum(scale, 0.2)
        station[:] = table.first + index * table.step + move
        offset[:], sharp[:] = side, scale
        beyond = (station < table.first) | (station > table.last)
        if beyond.any():
            station[beyond] = np.where(index[beyond] == 0, table.first, table.last) + along[beyond]
            offset[beyond], sharp[beyond] = across[beyond], 1.0

    def _seen_from(self, px: Floats, py: Floats, index: NDArray[np.intp]) -> tuple[Floats, Floats, Floats]:
        """Points seen from entries of the table: how far ahead, how far to the left; and the curvature there."""
        table = self.tabulated
        dx, dy = px - table.x.take(index), py - table.y.take(index)
        cos, sin = table.cos.take(index), table.sin.take(index)
        return dx * cos + dy * sin, dy * cos - dx * sin, table.curvature.take(index)


def _within(values: Any, low: float, high: float) -> Any:
    """As np.clip, which takes thrice the time on the few points of a tick."""
    return np.minimum(np.maximum(values, low), high)


def _developed(bend: Floats, rate: Floats, step: Floats) -> tuple[Floats, Floats]:
    """How far along its direction and how far to its left a curve gets on a small step, to third order."""
    square = step * step
    return step - bend * bend * square * step / 6, square * (bend / 2 + rate * step / 6)


def _turned(cos: Floats, sin: Floats, turn: Floats) -> tuple[Floats, Floats]:
    """A direction turned by a small angle, to third order."""
    part_cos, part_sin = 1.0 - turn * turn / 2, turn - turn * turn * turn / 6
    return cos * part_cos - sin * part_sin, sin * part_cos + cos * part_sin
