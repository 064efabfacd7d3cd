"""Polylines in the plane: lengths, headings, pairing of a lane's two sides, points in polygons, all in metres and radians."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from regdb_runtime.maps.road_map import Floats

SAME_POINT = 1e-6
"""Points nearer to each other than this, metres, are one."""


def stations(line: Floats) -> Floats:
    """Arc length at each point of a polyline (n, 2) -> (n,)."""
    return np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))))


def without_repeats(line: Floats, nearest: float = SAME_POINT) -> Floats:
    """The polyline without points that stand on the one before."""
    keep = [0]
    for index in range(1, len(line)):
        if np.hypot(*(line[index] - line[keep[-1]])) > nearest:
            keep.append(index)
    return line[keep]


def at_stations(line: Floats, wanted: Floats) -> Floats:
    """Points of a polyline at arc lengths (k,) -> (k, 2); the ends beyond them."""
    along = stations(line)
    return np.column_stack((np.interp(wanted, along, line[:, 0]), np.interp(wanted, along, line[:, 1])))


def paired(left: Floats, right: Floats) -> tuple[Floats, Floats]:
    """Both sides of a lane with the same number of rows: every vertex of either kept, at equal parts of the length."""
    if len(left) == len(right):
        return left, right
    shares = [along / along[-1] for along in (stations(left), stations(right))]
    both = np.union1d(*shares)
    both = both[np.concatenate(([True], np.diff(both) > 1e-9))]
    return at_stations(left, both * stations(left)[-1]), at_stations(right, both * stations(right)[-1])


def offset(line: Floats, distance: float) -> Floats:
    """The polyline moved to its left by `distance` metres (to its right below 0), with mitred corners."""
    steps = np.diff(line, axis=0)
    normals = np.column_stack((-steps[:, 1], steps[:, 0])) / np.hypot(*steps.T)[:, None]
    before, after = np.vstack((normals[:1], normals)), np.vstack((normals, normals[-1:]))
    miter = before + after
    miter /= np.maximum(np.einsum("ij,ij->i", miter, before), 0.5)[:, None]
    moved: Floats = line + distance * miter
    return moved


def headings(line: Floats) -> tuple[float, float]:
    """Heading of the first and the last step, radians."""
    first, last = line[1] - line[0], line[-1] - line[-2]
    return float(np.arctan2(first[1], first[0])), float(np.arctan2(last[1], last[0]))


def angle(radians: float) -> float:
    """The same angle in (-pi, pi]."""
    return float(-((np.pi - radians) % (2 * np.pi)) + np.pi)


def turned(line: Floats) -> float:
    """How far a polyline turns from its first step to its last, radians, positive to the left; whole turns count."""
    steps = np.diff(without_repeats(line), axis=0)
    directions = np.arctan2(steps[:, 1], steps[:, 0])
    return float(np.sum((np.diff(directions) + np.pi) % (2 * np.pi) - np.pi))


def inside(points: Floats, polygon: Floats) -> NDArray[np.bool_]:
    """Which points (m, 2) lie within a polygon (n, 2), by even-odd crossings -> (m,)."""
    x, y = points[:, 0][:, None], points[:, 1][:, None]
    x1, y1 = polygon[:, 0], polygon[:, 1]
    x2, y2 = np.roll(x1, -1), np.roll(y1, -1)
    spans = (y1 > y) != (y2 > y)
    with np.errstate(divide="ignore", invalid="ignore"):
        crossing = x < (x2 - x1) * (y - y1) / (y2 - y1) + x1
    odd: NDArray[np.bool_] = (np.count_nonzero(spans & crossing, axis=1) % 2).astype(bool)
    return odd


def project(points: Floats, line: Floats) -> tuple[Floats, Floats]:
    """Nearest place on a polyline for points (m, 2): its arc length (m,) and the signed offset (m,), positive to the left."""
    start, step = line[:-1], np.diff(line, axis=0)
    lengths = np.hypot(*step.T)
    unit = step / np.maximum(lengths, SAME_POINT)[:, None]
    relative = points[:, None, :] - start[None, :, :]
    along = np.clip(np.einsum("mnk,nk->mn", relative, unit), 0.0, lengths)
    foot = relative - along[:, :, None] * unit
    away = np.hypot(foot[..., 0], foot[..., 1])
    best = np.argmin(away, axis=1)
    row = np.arange(len(points))
    side = unit[best, 0] * relative[row, best, 1] - unit[best, 1] * relative[row, best, 0]
    station = np.concatenate(([0.0], np.cumsum(lengths)))[best] + along[row, best]
    return station, np.copysign(away[row, best], side)


def crossing(first: Floats, second: Floats) -> tuple[float, float] | None:
    """Arc lengths along two polylines where they first cross each other, None where they do not (touching ends count)."""
    a, b = first[:-1, None, :], np.diff(first, axis=0)[:, None, :]
    c, d = second[None, :-1, :], np.diff(second, axis=0)[None, :, :]
    between = c - a
    cross = b[..., 0] * d[..., 1] - b[..., 1] * d[..., 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        t = (between[..., 0] * d[..., 1] - between[..., 1] * d[..., 0]) / cross
        u = (between[..., 0] * b[..., 1] - between[..., 1] * b[..., 0]) / cross
    hits = np.argwhere((np.abs(cross) > 1e-12) & (t >= 0) & (t <= 1) & (u >= 0) & (u <= 1))
    if not len(hits):
        return None
    i, j = hits[0]
    along, across = stations(first), stations(second)
    return float(along[i] + t[i, j] * (along[i + 1] - along[i])), float(across[j] + u[i, j] * (across[j + 1] - across[j]))
