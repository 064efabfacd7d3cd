"""Waypoints of a map to a smooth line through them: evenly spaced points, then a cubic spline by arc length, tabulated."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
GAUSS = (np.array([-np.sqrt(0.6), 0.0, np.sqrt(0.6)]), np.array([5 / 9, 8 / 9, 5 / 9]))
"""Nodes and weights of the three-point rule on [-1, 1]."""


@dataclass(frozen=True, slots=True)
class PathSettings:
    """How a line is made of waypoints, metres.

    `smoothing_length`: bends shorter than about six times this are noise of the map (a lane's corner is 10 m long and more); 0 takes the
    waypoints as they are. `tolerance`: the line stays this near to every waypoint, whatever the smoothing would like: a sixth of what
    a 1.8 m car has on each side in a 3 m lane. `longest_chord`: along longer legs the map means them straight, and the line may not bulge.
    `node_spacing`: of the spline's knots. `table_spacing`: of the table; between entries the path is developed to third order.
    """

    smoothing_length: float = 3.0
    tolerance: float = 0.1
    longest_chord: float = 5.0
    node_spacing: float = 0.5
    table_spacing: float = 0.1


@dataclass(frozen=True, eq=False)
class PathTable:
    """A path at even stations `first + i * step`, all (n,): position, direction, heading (continuous), curvature and its rate by station."""

    first: float
    step: float
    x: Floats
    y: Floats
    cos: Floats
    sin: Floats
    heading: Floats
    curvature: Floats
    curvature_rate: Floats

    @property
    def last(self) -> float:
        """Station of the last entry."""
        return self.first + self.step * (len(self.x) - 1)

    def extended(self, before: float, after: float) -> PathTable:
        """The same with straight pieces of at least these lengths at the ends; stations keep their meaning."""
        front, back = (max(0, int(np.ceil(length / self.step - 1e-9))) for length in (before, after))
        lead, tail = np.arange(-front, 0) * self.step, np.arange(1, back + 1) * self.step

        def straight(line: Floats, slope: Floats) -> Floats:
            return np.concatenate((line[0] + slope[0] * lead, line, line[-1] + slope[-1] * tail))

        def held(line: Floats, ends: tuple[float, float]) -> Floats:
            return np.concatenate((np.full(front, ends[0]), line, np.full(back, ends[1])))

        ends = [(float(line[0]), float(line[-1])) for line in (self.cos, self.sin, self.heading)]
        return PathTable(
            self.first - front * self.step, self.step, straight(self.x, self.cos), straight(self.y, self.sin),
            held(self.cos, ends[0]), held(self.sin, ends[1]), held(self.heading, ends[2]),
            held(self.curvature, (0.0, 0.0)), held(self.curvature_rate, (0.0, 0.0)),
        )  # fmt: skip


def tabulate(points: Floats, settings: PathSettings) -> PathTable:
    """The table of the line through waypoints (n, 2), n >= 2, none of them twice in a row."""
    from scipy.interpolate import CubicSpline  # type: ignore[import-untyped]  # 0.4 s to import, and only who plans needs it

    origin = points[0]
    points = points - origin  # maps in geographic grids are millions of metres from theirs
    knots = smoothed(points, settings) if settings.smoothing_length > 0.0 and len(points) > 2 else points
    chord = _chord(knots)
    spline = CubicSpline(chord, knots, axis=0)
    pieces = max(4, int(np.ceil(chord[-1] / settings.table_spacing)))
    edges = np.linspace(0.0, chord[-1], pieces + 1)
    arc = _arc_length(spline(_gauss_nodes(edges), 1), edges)
    step = float(arc[-1]) / pieces
    at = np.interp(np.arange(pieces + 1) * step, arc, edges)
    place, first, second = spline(at), spline(at, 1), spline(at, 2)
    speed = np.hypot(first[:, 0], first[:, 1])
    curvature = (first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]) / speed**3
    heading = np.unwrap(np.arctan2(first[:, 1], first[:, 0]))
    return PathTable(
        0.0, step, place[:, 0] + origin[0], place[:, 1] + origin[1], first[:, 0] / speed, first[:, 1] / speed, heading, curvature,
        np.gradient(curvature, step),
    )  # fmt: skip


def smoothed(points: Floats, settings: PathSettings) -> Floats:
    """Evenly spaced nodes (k, 2) of the line that balances distance from the waypoints against change of curvature.

    Minimises the integral of `|line - waypoints|^2 + L^6 |line'''|^2` with L the smoothing length, so straights, parabolas and all bends
    much longer than L pass as they are; L shrinks until every waypoint is within the tolerance.
    """
    chord = _chord(points)
    count = max(8, int(np.ceil(chord[-1] / settings.node_spacing)) + 1)
    data, at = _densified(points, chord, settings.longest_chord)
    own = _Weights(chord, chord[-1], count)
    fit = _Weights(at, chord[-1], count)
    length = settings.smoothing_length
    while True:
        nodes = fit.solve(data, length)
        off = own.values(nodes) - points
        if float(np.max(np.hypot(off[:, 0], off[:, 1]))) <= settings.tolerance or length < settings.node_spacing / 4:
            return nodes
        length *= 0.7


class _Weights:
    """Where data lie between evenly spaced nodes, and how much each counts."""

    def __init__(self, at: Floats, total: float, count: int) -> None:
        self.count, self.spacing = count, total / (count - 1)
        self.left = np.minimum((at / self.spacing).astype(np.intp), count - 2)
        self.share = at / self.spacing - self.left
        self.weight = np.gradient(at) if len(at) > 2 else np.full(len(at), total / 2)

    def values(self, nodes: Floats) -> Floats:
        return np.asarray(nodes[self.left] * (1 - self.share)[:, None] + nodes[self.left + 1] * self.share[:, None])

    def solve(self, data: Floats, length: float) -> Floats:
        """The nodes (count, 2) that fit data best; the normal equations have seven diagonals."""
        from scipy.linalg import solveh_banded  # type: ignore[import-untyped]

        own, other, weight = 1 - self.share, self.share, self.weight
        banded = _roughness(self.count) * (length**6 / self.spacing**5)
        banded[3] += np.bincount(self.left, weight * own**2, self.count) + np.bincount(self.left + 1, weight * other**2, self.count)
        banded[2, 1:] += np.bincount(self.left, weight * own * other, self.count - 1)
        right = np.column_stack([
            np.bincount(self.left, weight * own * axis, self.count) + np.bincount(self.left + 1, weight * other * axis, self.count)
            for axis in data.T
        ])  # fmt: skip
        solved: Floats = solveh_banded(banded, right, check_finite=False)
        return solved


def _roughness(count: int) -> Floats:
    """Upper diagonals (4, count) of D'D, D the third differences; row 3 is the main diagonal."""
    banded = np.zeros((4, count))
    difference = np.array([-1.0, 3.0, -3.0, 1.0])
    for apart in range(4):
        for first in range(4 - apart):
            product = difference[first] * difference[first + apart]
            banded[3 - apart, first + apart : first + apart + count - 3] += product
    return banded


def _densified(points: Floats, chord: Floats, longest: float) -> tuple[Floats, Floats]:
    """The polyline's points and further ones on its long legs, with the chord length of each."""
    parts = np.maximum(1, np.ceil(np.diff(chord) / longest - 1e-9).astype(np.intp))
    steps = np.concatenate([np.arange(number) / number for number in parts.tolist()])
    leg = np.repeat(np.arange(len(parts)), parts)
    at = np.append(chord[leg] + steps * np.diff(chord)[leg], chord[-1])
    return np.column_stack([np.interp(at, chord, axis) for axis in points.T]), at


def _chord(points: Floats) -> Floats:
    steps = np.diff(points, axis=0)
    return np.concatenate(([0.0], np.cumsum(np.hypot(steps[:, 0], steps[:, 1]))))


def _gauss_nodes(edges: Floats) -> Floats:
    half = np.diff(edges)[:, None] / 2
    return np.asarray((edges[:-1, None] + half + half * GAUSS[0]).ravel())


def _arc_length(tangent: Floats, edges: Floats) -> Floats:
    speed = np.hypot(tangent[:, 0], tangent[:, 1]).reshape(-1, 3)
    return np.concatenate(([0.0], np.cumsum(speed @ GAUSS[1] * np.diff(edges) / 2)))
