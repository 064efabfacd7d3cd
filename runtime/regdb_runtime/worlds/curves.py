"""Middle lines with curvature that never jumps: chains of straights and curves, and the connection of two poses across a junction."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

from regdb_runtime.maps.road_map import Floats
from regdb_runtime.worlds.road_spec import Piece, Pose

TRANSITION = 20.0
"""Longest clothoid at each end of a curve, metres; a third of the curve's length at most."""
_FINE = 0.05
"""Step of the integration, metres: the error over a kilometre of curves stays under a millimetre."""
_RAMP = 0.3
"""Share of a connection's curve that each of its two clothoids takes."""


def straight(length: float) -> Piece:
    """A straight piece, metres."""
    return Piece(length)


def curve(degrees: float, radius: float) -> Piece:
    """A curve that turns by `degrees` in all (to the left when positive) with `radius` metres between its clothoids."""
    arc = abs(math.radians(degrees)) * radius
    length = min(arc * 1.5, arc + TRANSITION)
    return Piece(length, math.copysign(radius, degrees))


def middle_line(start: Pose, pieces: Iterable[Piece], step: float = 2.0) -> tuple[Floats, Floats]:
    """Points (n, 2) about `step` metres apart along a chain of pieces, and their headings (n,) in radians."""
    stations, curvatures = _curvature(pieces)
    headings = math.radians(start.degrees) + _integral(stations, curvatures)
    x = start.x + _integral(stations, np.cos(headings))
    y = start.y + _integral(stations, np.sin(headings))
    samples = np.linspace(0.0, stations[-1], max(2, math.ceil(stations[-1] / step) + 1))
    points = np.column_stack([np.interp(samples, stations, x), np.interp(samples, stations, y)])
    return points, np.interp(samples, stations, headings)


def aside(points: Floats, headings: Floats, offset: float | Floats) -> Floats:
    """Points (n, 2) `offset` metres to the left of a line (to the right when negative)."""
    return np.asarray(points + np.column_stack([-np.sin(headings), np.cos(headings)]) * np.reshape(offset, (-1, 1)))


def connection(start: tuple[float, float, float], end: tuple[float, float, float], step: float = 0.5) -> tuple[Floats, Floats]:
    """A smooth way (n, 2) from one (x, y, heading) to another, with headings (n,): a curve between clothoids and a straight on the
    longer leg where the directions cross ahead; an S of fifth degree where they hardly differ or cross behind."""
    turn = math.remainder(end[2] - start[2], 2 * math.pi)
    legs = _legs(start, end, turn)
    if abs(turn) < math.radians(12) or legs is None:
        return _s_curve(start, end, step)
    shape, shape_headings, leg = _unit_turn(turn)
    scale = min(legs) / leg
    before = legs[0] - min(legs)
    count = max(8, math.ceil(scale / step) + 1)
    picks = np.linspace(0, len(shape) - 1, count).round().astype(int)
    spin = np.array([[math.cos(start[2]), math.sin(start[2])], [-math.sin(start[2]), math.cos(start[2])]])
    ahead = np.array([math.cos(start[2]), math.sin(start[2])])
    curved = shape[picks] * scale @ spin + np.array(start[:2]) + before * ahead
    headings = shape_headings[picks] + start[2]
    return _with_straights(start, end, curved, headings, before, legs[1] - min(legs), step)


def _curvature(pieces: Iterable[Piece]) -> tuple[Floats, Floats]:
    stations, curvatures, begin = [np.zeros(1)], [np.zeros(1)], 0.0
    for piece in pieces:
        along = np.linspace(0.0, piece.length, max(2, math.ceil(piece.length / _FINE) + 1))
        ramp = min(TRANSITION, piece.length / 3)
        bend = 0.0 if piece.radius == 0.0 else 1.0 / piece.radius
        stations.append(begin + along[1:])
        curvatures.append(bend * np.clip(np.minimum(along, piece.length - along)[1:] / ramp, 0.0, 1.0))
        begin += piece.length
    return np.concatenate(stations), np.concatenate(curvatures)


def _integral(stations: Floats, values: Floats) -> Floats:
    steps = np.diff(stations) * (values[1:] + values[:-1]) / 2
    return np.concatenate(([0.0], np.cumsum(steps)))


def _legs(start: tuple[float, float, float], end: tuple[float, float, float], turn: float) -> tuple[float, float] | None:
    """From the start ahead, and from the end back, to where the directions cross; None when they do not ahead and back."""
    if abs(math.sin(turn)) < 1e-3:
        return None
    dx, dy = end[0] - start[0], end[1] - start[1]
    first = (dx * math.sin(end[2]) - dy * math.cos(end[2])) / math.sin(turn)
    second = (dy * math.cos(start[2]) - dx * math.sin(start[2])) / math.sin(turn)
    return (first, second) if min(first, second) > 1.0 else None


def _unit_turn(turn: float) -> tuple[Floats, Floats, float]:
    """A clothoid, an arc and a clothoid of length 1 in all, from (0, 0) along +x, turning by `turn`; and the legs of its tangents."""
    along = np.linspace(0.0, 1.0, 2001)
    profile = np.clip(np.minimum(along, 1 - along) / _RAMP, 0.0, 1.0)
    headings = _integral(along, profile * turn / (1 - _RAMP))
    points = np.column_stack([_integral(along, np.cos(headings)), _integral(along, np.sin(headings))])
    return points, headings, float(points[-1, 0] - points[-1, 1] / math.tan(turn))


def _with_straights(
    start: tuple[float, float, float], end: tuple[float, float, float], curved: Floats, headings: Floats, before: float, after: float, step: float
) -> tuple[Floats, Floats]:
    lines, angles = [curved], [headings]
    if before > 1e-6:
        lines.insert(0, np.linspace(start[:2], curved[0], math.ceil(before / step) + 1)[:-1])
        angles.insert(0, np.full(len(lines[0]), start[2]))
    if after > 1e-6:
        lines.append(np.linspace(curved[-1], end[:2], math.ceil(after / step) + 1)[1:])
        angles.append(np.full(len(lines[-1]), headings[-1]))
    return np.concatenate(lines), np.concatenate(angles)


def _s_curve(start: tuple[float, float, float], end: tuple[float, float, float], step: float) -> tuple[Floats, Floats]:
    """A quintic Hermite curve without curvature at its ends."""
    reach = math.hypot(end[0] - start[0], end[1] - start[1])
    t = np.linspace(0.0, 1.0, max(4, math.ceil(reach / step) + 1))[:, None]
    p, q = np.array(start[:2]), np.array(end[:2])
    u = reach * np.array([math.cos(start[2]), math.sin(start[2])])
    v = reach * np.array([math.cos(end[2]), math.sin(end[2])])
    points = p + u * (t - 6 * t**3 + 8 * t**4 - 3 * t**5) + (q - p) * (10 * t**3 - 15 * t**4 + 6 * t**5) + v * (-4 * t**3 + 7 * t**4 - 3 * t**5)
    slopes = u * (1 - 18 * t**2 + 32 * t**3 - 15 * t**4) + (q - p) * (30 * t**2 - 60 * t**3 + 30 * t**4) + v * (-12 * t**2 + 28 * t**3 - 15 * t**4)
    return points, np.unwrap(np.arctan2(slopes[:, 1], slopes[:, 0]))
