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
from regdb_runtime.planning.polynomials import Floats, quintic
from regdb_runtime.planning.settings import LatticeSettings
from regdb_runtime.planning.speed_profiles import speed_profiles
from regdb_runtime.trajectory import Candidates, FrenetState

SAME_OFFSET = 1e-3
BLOCK = 4096
"""Points worked on at a time: a dozen arrays of this size stay in a core's own cache."""
FIELDS = 9
SCRATCH = 7


class Workspace:
    """Memory kept between calls; the candidates of a call live in it until the next call with the same workspace."""

    def __init__(self) -> None:
        self._room = np.empty(0)
        self.scratch = np.empty((SCRATCH, 0))

    def fields(self, plans: int, points: int) -> Floats:
        """Room for `FIELDS` arrays (plans, points)."""
        size = FIELDS * plans * points
        if self._room.size < size:
            self._room = np.empty(size + size // 4)
        return self._room[:size].reshape(FIELDS, plans, points)

    def parts(self, width: int) -> Floats:
        """Scratch arrays of a width."""
        if self.scratch.shape[1] < width:
            self.scratch = np.empty((SCRATCH, width))
        return self.scratch[:, :width]


@dataclass(frozen=True, eq=False)
class _Sides:
    """Changes of offset (q,): where along the path they end, and their coefficients (q, 6) of the part (0 to 1) done."""

    lengths: Floats
    pieces: Floats


def sample(
    path: ReferencePath, start: FrenetState, goal: Goal, footprint: Footprint | None = None, settings: LatticeSettings | None = None,
    workspace: Workspace | None = None,
) -> Candidates:
    """All trajectories from a start state towards a goal: N = motions x changes of offset, motion by motion.

    Every one starts exactly in the start state; none goes backwards. Beyond its end the path is taken to go on straight. With a
    `workspace` the arrays are valid until its next use; without, they are the caller's own.
    """
    settings, footprint = settings or LatticeSettings(), footprint or Footprint()
    time = np.arange(settings.points) * settings.step
    station, speed, acceleration = speed_profiles(start, goal, footprint.front, settings, time)
    sides = _sides(start, goal, settings)
    motions, changes, points = len(station), len(sides.lengths), len(time)
    workspace = workspace or Workspace()
    room = workspace.fields(motions * changes, points)
    reach = float(station.max()) if station.size else start.s
    table = path.tabulated if reach <= path.end else path.extended(after=reach - path.end + 1.0).tabulated
    grid = room.reshape(FIELDS, motions, changes, points)
    rows = max(1, BLOCK // (changes * points))
    for begin in range(0, motions, rows):
        part = slice(begin, begin + rows)
        _in_plane(table, station[part], speed[part], acceleration[part], start.s, sides, grid[:, part], workspace)
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


def _in_plane(
    table: PathTable, station: Floats, speed: Floats, acceleration: Floats, begin: float, sides: _Sides, out: Floats, workspace: Workspace
) -> None:
    """Writes x, y, heading, speed, acceleration, (jerk), curvature, station, offset (9, p, q, t) of motions (p, t) with changes (q,)."""
    shape = out.shape[1:]
    d, slope, bend, scale, stretch, square, work = workspace.parts(math.prod(shape)).reshape(SCRATCH, *shape)
    _offsets(station, begin, sides, d, slope, bend, work)
    x, y, cos, sin, heading, curvature, rate = (value[:, None] for value in _along(table, station))
    np.multiply(d, sin, out=work)
    np.subtract(x, work, out=out[0])
    np.multiply(d, cos, out=work)
    np.add(y, work, out=out[1])
    np.multiply(d, curvature, out=scale)
    np.subtract(1.0, scale, out=scale)
    np.multiply(scale, scale, out=square)
    np.multiply(slope, slope, out=work)
    np.add(square, work, out=square)
    np.sqrt(square, out=stretch)
    np.divide(slope, scale, out=work)
    np.arctan(work, out=work)
    np.add(heading, work, out=out[2])
    np.multiply(stretch, speed[:, None], out=out[3])
    out[7], out[8] = station[:, None], d
    change = np.multiply(slope, curvature, out=work)  # -d(scale)/ds, from here on
    np.multiply(d, rate, out=d)
    np.add(change, d, out=change)
    np.multiply(bend, scale, out=d)  # curvature: ((bend * scale + change * slope) / stretch^2 + curvature) / stretch
    np.multiply(change, slope, out=out[6])
    np.add(out[6], d, out=out[6])
    np.divide(out[6], square, out=out[6])
    np.add(out[6], curvature, out=out[6])
    np.divide(out[6], stretch, out=out[6])
    np.multiply(slope, bend, out=d)  # acceleration: s_ddot * stretch + s_dot^2 * (slope * bend - scale * change) / stretch
    np.multiply(scale, change, out=change)
    np.subtract(d, change, out=d)
    np.divide(d, stretch, out=d)
    np.multiply(d, (speed * speed)[:, None], out=d)
    np.multiply(stretch, acceleration[:, None], out=stretch)
    np.add(stretch, d, out=out[4])


def _offsets(station: Floats, begin: float, sides: _Sides, d: Floats, slope: Floats, bend: Floats, part: Floats) -> None:
    """Offset and its first and second derivative by station (p, q, t), held after the end of the change."""
    np.multiply((station - begin)[:, None], (1.0 / sides.lengths)[:, None], out=part)
    np.minimum(part, 1.0, out=part)
    c = sides.pieces.T[:, :, None]
    per_metre = (1.0 / sides.lengths)[:, None]
    for out, factors in (
        (d, (c[5], c[4], c[3], c[2], c[1], c[0])),
        (slope, [factor * per_metre for factor in (5 * c[5], 4 * c[4], 3 * c[3], 2 * c[2], c[1])]),
        (bend, [factor * per_metre**2 for factor in (20 * c[5], 12 * c[4], 6 * c[3], 2 * c[2])]),
    ):
        np.multiply(part, factors[0], out=out)
        for factor in factors[1:-1]:
            np.add(out, factor, out=out)
            np.multiply(out, part, out=out)
        np.add(out, factors[-1], out=out)


def _along(table: PathTable, station: Floats) -> tuple[Floats, ...]:
    """x, y, cos, sin, heading, curvature and its rate of the path at stations (p, t), developed from the nearest entries."""
    place = (station - table.first) / table.step
    index = np.clip(np.rint(place), 0, len(table.x) - 1).astype(np.intp)
    step = (place - index) * table.step
    x, y, cos, sin, heading, curvature, rate = (
        values.take(index) for values in (table.x, table.y, table.cos, table.sin, table.heading, table.curvature, table.curvature_rate)
    )
    square = step * step
    ahead = step - curvature * curvature * square * step / 6
    aside = square * (curvature / 2 + rate * step / 6)
    turn = step * (curvature + rate * step / 2)
    bent_cos, bent_sin = 1.0 - turn * turn / 2, turn - turn * turn * turn / 6
    return (
        x + ahead * cos - aside * sin, y + ahead * sin + aside * cos, cos * bent_cos - sin * bent_sin, sin * bent_cos + cos * bent_sin,
        heading + turn, curvature + step * rate, rate,
    )  # fmt: skip


def _jerk(acceleration: Floats, jerk: Floats, step: float) -> None:
    """Mean jerk until the next instant; the last is that before it."""
    np.subtract(acceleration[:, 1:], acceleration[:, :-1], out=jerk[:, :-1])
    jerk[:, :-1] /= step
    jerk[:, -1] = jerk[:, -2]
