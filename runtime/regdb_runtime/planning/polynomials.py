"""Polynomials of time in batches: changes of speed (quartics of the station), ways to a point (quintics), and chains of them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]
FIRST, SECOND = np.arange(1.0, 6.0), np.array([2.0, 6.0, 12.0, 20.0])
"""Factors of a polynomial's coefficients in its derivatives."""


def change_speed(speed: ArrayLike, acceleration: ArrayLike, end_speed: ArrayLike, duration: ArrayLike) -> Floats:
    """Coefficients (n, 6), lowest first, of the quartic from station 0 that ends with a speed and no acceleration (least integral of jerk^2)."""
    v, a, w, t = (np.asarray(value, float) for value in (speed, acceleration, end_speed, duration))
    gain = w - v
    third = gain / t**2 - 2 * a / (3 * t)
    fourth = a / (4 * t**2) - gain / (2 * t**3)
    return _columns((0.0, v, a / 2, third, fourth, 0.0), fourth)


def change_way(duration: ArrayLike, speed: ArrayLike, acceleration: ArrayLike, end_speed: ArrayLike) -> Floats:
    """Metres that `change_speed` covers."""
    t = np.asarray(duration, float)
    return np.asarray(t * (np.asarray(speed) + np.asarray(end_speed)) / 2 + np.asarray(acceleration) * t * t / 12)


def change_time(way: ArrayLike, speed: ArrayLike, acceleration: ArrayLike, end_speed: ArrayLike) -> Floats:
    """Duration of the `change_speed` that covers exactly a way; NaN where none does (too much braking already, or no way left).

    The rest of such a change is again the change that covers the rest of the way, so planning anew on the way gives the same motion.
    """
    mean = (np.asarray(speed, float) + np.asarray(end_speed, float)) / 2
    d, a = np.asarray(way, float), np.asarray(acceleration, float)
    with np.errstate(invalid="ignore", divide="ignore"):
        found = 2 * d / (mean + np.sqrt(mean * mean + a * d / 3))
    return np.asarray(np.where((d > 0) & (found > 0) & np.isfinite(found), found, np.nan))


def quintic(start: tuple[ArrayLike, ArrayLike, ArrayLike], end: tuple[ArrayLike, ArrayLike, ArrayLike], duration: ArrayLike) -> Floats:
    """Coefficients (n, 6), lowest first, between two values with their first and second derivatives."""
    x0, v0, a0, x1, v1, a1, t = (np.asarray(value, float) for value in (*start, *end, duration))
    way = x1 - x0 - v0 * t - a0 * t * t / 2
    speed = (v1 - v0 - a0 * t) * t
    rate = (a1 - a0) * t * t
    third = (10 * way - 4 * speed + rate / 2) / t**3
    fourth = (-15 * way + 7 * speed - rate) / t**4
    fifth = (6 * way - 3 * speed + rate / 2) / t**5
    return _columns((x0, v0, a0 / 2, third, fourth, fifth), fifth)


def _columns(values: tuple[ArrayLike, ...], like: Floats) -> Floats:
    """Values side by side, (n, 6); each is broadcast to the shape of `like`."""
    found = np.empty((*np.shape(like), len(values)))
    for column, value in enumerate(values):
        found[..., column] = value
    return found


@dataclass(frozen=True, eq=False)
class Chains:
    """Motions of several pieces: `starts` (n, k) seconds, `pieces` (n, k, 6) of the time since their start. The last goes on for ever."""

    starts: Floats
    pieces: Floats

    def at(self, time: Floats) -> tuple[Floats, Floats, Floats]:
        """Value and first and second derivative (n, t) at instants (t,) >= 0; at a seam the later piece counts."""
        n, k = self.starts.shape
        flat = np.broadcast_to(np.arange(n)[:, None] * k, (n, len(time)))
        for later in range(1, k):
            flat = flat + (time >= self.starts[:, later, None] - 1e-9)
        since = time - self.starts.ravel().take(flat)
        pieces = self.pieces.reshape(n * k, 6)
        values, first, second = pieces, pieces[:, 1:] * FIRST, pieces[:, 2:] * SECOND
        return _horner(values, flat, since), _horner(first, flat, since), _horner(second, flat, since)


def _horner(factors: Floats, rows: NDArray[np.intp], at: Floats) -> Floats:
    """Values of polynomials, rows of factors (m, p) with the lowest first, each place with the row it names."""
    columns = np.ascontiguousarray(factors.T)
    value: Floats = columns[-1].take(rows)
    for column in columns[-2::-1]:
        value *= at
        value += column.take(rows)
    return value
