"""The lattice: every motion along the path with every change of offset, as trajectories in the plane, in one batch.

Offsets are quintics of the station, not of time, at every speed: a standing or creeping vehicle then has a heading and a curvature like any
other, and no switch of mode lies between two plans (Werling's low-speed mode, used throughout). What depends on the station alone is worked
out once for each motion, and what the plane needs of trigonometry comes from the path's table.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from regdb_runtime.maps.reference_path import ReferencePath
from regdb_runtime.maps.smoothing import PathTable
from regdb_runtime.observation import Footprint
from regdb_runtime.planning.goal import Goal
from regdb_runtime.planning.polynomials import FIRST, SECOND, Floats, quintic
from regdb_runtime.planning.settings import LatticeSettings
from regdb_runtime.planning.speed_profiles import speed_profiles
from regdb_runtime.trajectory import Candidates, FrenetState

SAME_OFFSET = 1e-3
BLOCK = 65536
"""Points worked on at a time: fewer, longer steps won over smaller ones that stay nearer to the core."""
FIELDS = 9
CLOSEST = 0.05
"""Least 1 - curvature * offset that a plan may come to."""


class Workspace:
    """Memory kept between calls; the candidates of a call live in it until the next call with the same workspace."""

    def __init__(self) -> None:
        self._room = np.empty(0)
        self._parts = np.empty(0)

    def fields(self, plans: int, points: int) -> Floats:
        """Room for `FIELDS` arrays (plans, points)."""
        size = FIELDS * plans * points
        if self._room.size < size:
            self._room = np.empty(size + size // 4)
        return self._room[:size].reshape(FIELDS, plans, points)

    def parts(self, changes: int, width: int) -> tuple[Floats, Floats]:
        """Scratch: offsets (changes, 3, width) and powers (changes, 6, width)."""
        size = changes * width
        if self._parts.size < 9 * size:
            self._parts = np.empty(9 * size)
        return self._parts[: 3 * size].reshape(changes, 3, width), self._parts[3 * size : 9 * size].reshape(changes, 6, width)


@dataclass(frozen=True, eq=False)
class _Sides:
    """Changes of offset (q,): where along the path they end, and their coefficients (q, 6) of the part (0 to 1) done."""

    lengths: Floats
    pieces: Floats


def sample(
    path: ReferencePath, start: FrenetState, goal: Goal, footprint: Footprint | None = None, settings: LatticeSettings | None = None,
    workspace: Workspace | None = None,
) -> Candidates:
    """All trajectories from a start state towards a goal: N = changes of offset x motions, change by change.

    Every one starts exactly in the start state; none goes backwards. Beyond its end the path is taken to go on straight. With a
    `workspace` the arrays are valid until its next use; without, they are the caller's own.
    """
    settings, footprint = settings or LatticeSettings(), footprint or Footprint()
    time: Floats = np.arange(settings.points, dtype=np.float64) * settings.step
    motions = speed_profiles(start, goal, footprint.front, settings, time)
    sides = _sides(start, goal, settings)
    count, points = motions[0].shape
    workspace = workspace or Workspace()
    room = workspace.fields(len(sides.lengths) * count, points)
    reach = float(motions[0].max()) if count else start.s
    table = path.tabulated if reach <= path.end else path.extended(after=reach - path.end + 1.0).tabulated
    changes = len(sides.lengths)
    whole = room.reshape(FIELDS, changes, count * points)
    width = points * max(1, BLOCK // (points * changes))
    station, speed, acceleration = (values.ravel() for values in motions)
    for first in range(0, count * points, width):
        part = slice(first, first + width)
        along = _Along.of(table, station[part], speed[part], acceleration[part], start.s)
        _in_plane(along, sides, whole[:, :, part], workspace)
    _jerk(room[4], room[5], settings.step)
    return Candidates(time, *room)


def _sides(start: FrenetState, goal: Goal, settings: LatticeSettings) -> _Sides:
    """Changes to each offset, ending at stations that are the same for the next plan; one only where nothing is left to change."""
    reference = max(start.s_dot, settings.slowest)
    grid = settings.lateral_grid * max(1, round(reference / settings.lateral_grid))
    shortest, longest = (start.s + seconds * reference for seconds in settings.lateral_times)
    ends = [grid * number for number in range(math.ceil(shortest / grid), math.floor(longest / grid) + 1)]
    pairs = []
    for offset in goal.offsets:
        straight = abs(offset - start.d) < SAME_OFFSET and abs(start.slope) < SAME_OFFSET and abs(start.bend) < SAME_OFFSET / 10
        pairs += [(offset, end - start.s) for end in (ends[len(ends) // 2 :][:1] if straight else ends)]
    offsets, lengths = np.array(pairs).T
    return _Sides(lengths, quintic((start.d, start.slope * lengths, start.bend * lengths**2), (offsets, 0.0, 0.0), 1.0))


@dataclass(frozen=True, eq=False)
class _Along:
    """What depends on the station alone, for a block of motions (k,): way since the start, motion along the path, the path itself there."""

    way: Floats
    station: Floats
    speed: Floats
    square: Floats
    acceleration: Floats
    x: Floats
    y: Floats
    cos: Floats
    sin: Floats
    heading: Floats
    curvature: Floats
    rate: Floats

    @classmethod
    def of(cls, table: PathTable, station: Floats, speed: Floats, acceleration: Floats, begin: float) -> _Along:
        """The path at stations, developed from the nearest entries of its table to third order."""
        place = (station - table.first) / table.step
        index = np.minimum(np.maximum(np.rint(place), 0), len(table.x) - 1).astype(np.intp)
        step = (place - index) * table.step
        x, y, cos, sin, heading, curvature, rate = (
            values.take(index) for values in (table.x, table.y, table.cos, table.sin, table.heading, table.curvature, table.curvature_rate)
        )
        square = step * step
        ahead = step - curvature * curvature * square * step / 6
        aside = square * (curvature / 2 + rate * step / 6)
        turn = step * (curvature + rate * step / 2)
        bent_cos, bent_sin = 1.0 - turn * turn / 2, turn - turn * turn * turn / 6
        return cls(
            station - begin, station, speed, speed * speed, acceleration, x + ahead * cos - aside * sin, y + ahead * sin + aside * cos,
            cos * bent_cos - sin * bent_sin, sin * bent_cos + cos * bent_sin, heading + turn, curvature + step * rate, rate,
        )  # fmt: skip


def _in_plane(along: _Along, sides: _Sides, out: Floats, workspace: Workspace) -> None:
    """Writes x, y, heading, speed, acceleration, (jerk), curvature, station, offset (9, q, k) of a block of motions with each change."""
    x, y, heading, speed, acceleration, _, curvature, station, d = out
    station[:] = along.station
    if not sides.pieces.any():
        x[:], y[:], heading[:], speed[:], acceleration[:] = along.x, along.y, along.heading, along.speed, along.acceleration
        curvature[:], d[:] = along.curvature, 0.0
        return
    offsets, powers = workspace.parts(*x.shape)
    _offsets(along.way, sides, offsets, powers)
    slope, bend = offsets[:, 1], offsets[:, 2]
    scale, stretch, square, work = (powers[:, row] for row in range(4))
    d[:] = offsets[:, 0]
    np.multiply(d, along.sin, out=work)
    np.subtract(along.x, work, out=x)
    np.multiply(d, along.cos, out=work)
    np.add(along.y, work, out=y)
    np.multiply(d, along.curvature, out=scale)
    np.subtract(1.0, scale, out=scale)
    np.multiply(scale, scale, out=square)
    np.multiply(slope, slope, out=work)
    np.add(square, work, out=square)
    np.sqrt(square, out=stretch)
    np.divide(slope, scale, out=work)
    np.arctan(work, out=work)
    np.add(along.heading, work, out=heading)
    np.multiply(stretch, along.speed, out=speed)
    np.multiply(slope, along.curvature, out=acceleration)  # change = -d(scale)/ds, kept here for a while
    np.multiply(d, along.rate, out=work)
    change_of_scale = np.add(acceleration, work, out=acceleration)
    np.multiply(change_of_scale, slope, out=curvature)  # ((bend * scale + change * slope) / stretch^2 + path's curvature) / stretch
    np.multiply(bend, scale, out=work)
    np.add(curvature, work, out=curvature)
    np.divide(curvature, square, out=curvature)
    np.add(curvature, along.curvature, out=curvature)
    np.divide(curvature, stretch, out=curvature)
    np.multiply(scale, change_of_scale, out=work)  # s_ddot * stretch + s_dot^2 * (slope * bend - scale * change) / stretch
    np.multiply(slope, bend, out=slope)
    np.subtract(slope, work, out=slope)
    np.divide(slope, stretch, out=slope)
    np.multiply(slope, along.square, out=slope)
    np.multiply(stretch, along.acceleration, out=acceleration)
    np.add(acceleration, slope, out=acceleration)
    if float(scale.min()) < CLOSEST:
        curvature[scale < CLOSEST] = np.inf  # at the centre of the path's curvature or beyond it: nothing can drive there


def _offsets(way: Floats, sides: _Sides, out: Floats, powers: Floats) -> None:
    """Offset and its first and second derivative by station (q, 3, k), held after the end of the change; `powers` is room for (q, 6, k)."""
    lengths = sides.lengths[:, None]
    powers[:, 0] = 1.0
    part, square, cube = powers[:, 1], powers[:, 2], powers[:, 3]
    np.multiply(way, 1.0 / lengths, out=part)
    np.minimum(part, 1.0, out=part)
    np.multiply(part, part, out=square)
    np.multiply(square, part, out=cube)
    np.multiply(square, square, out=powers[:, 4])
    np.multiply(square, cube, out=powers[:, 5])
    factors = np.zeros((len(lengths), 3, 6))
    factors[:, 0] = sides.pieces
    factors[:, 1, :5] = FIRST * sides.pieces[:, 1:] / lengths
    factors[:, 2, :4] = SECOND * sides.pieces[:, 2:] / lengths**2
    np.matmul(factors, powers, out=out)


def _jerk(acceleration: Floats, jerk: Floats, step: float) -> None:
    """Mean jerk until the next instant; the last is that before it."""
    np.subtract(acceleration[:, 1:], acceleration[:, :-1], out=jerk[:, :-1])
    jerk[:, :-1] /= step
    jerk[:, -1] = jerk[:, -2]
