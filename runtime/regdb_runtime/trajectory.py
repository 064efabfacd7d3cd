"""Trajectories, one and many: motion of the middle of the rear axle over time, in the plane and along the path."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
STANDING = 1e-3
"""Below this speed, m/s, derivatives by station cannot be had from those by time."""


@dataclass(frozen=True)
class FrenetState:
    """Start of a plan along a path: station and offset (positive to the left) with their time derivatives, SI.

    `d_prime` and `d_double_prime` are the offset's derivatives by station; they say how a standing vehicle is turned and steered, which the
    time derivatives cannot. None: those of the time derivatives (0 when standing).
    """

    s: float
    s_dot: float = 0.0
    s_ddot: float = 0.0
    d: float = 0.0
    d_dot: float = 0.0
    d_ddot: float = 0.0
    d_prime: float | None = None
    d_double_prime: float | None = None

    @property
    def slope(self) -> float:
        """Derivative of the offset by station."""
        if self.d_prime is not None:
            return self.d_prime
        return self.d_dot / self.s_dot if abs(self.s_dot) > STANDING else 0.0

    @property
    def bend(self) -> float:
        """Second derivative of the offset by station, 1/m."""
        if self.d_double_prime is not None:
            return self.d_double_prime
        return (self.d_ddot - self.slope * self.s_ddot) / self.s_dot**2 if abs(self.s_dot) > STANDING else 0.0


@dataclass(frozen=True, eq=False)
class Trajectory:
    """One plan. All arrays have shape (T,): `time` seconds from now (0 first), `x`, `y`, `heading`, `speed`, `acceleration` (along the path
    of the vehicle), `jerk`, `curvature`, `station`, `offset`; SI, radians."""

    time: Floats
    x: Floats
    y: Floats
    heading: Floats
    speed: Floats
    acceleration: Floats
    jerk: Floats
    curvature: Floats
    station: Floats
    offset: Floats


@dataclass(frozen=True, eq=False)
class Candidates:
    """Many plans over the same instants: `time` (T,), all else (N, T), as in `Trajectory`."""

    time: Floats
    x: Floats
    y: Floats
    heading: Floats
    speed: Floats
    acceleration: Floats
    jerk: Floats
    curvature: Floats
    station: Floats
    offset: Floats

    def __len__(self) -> int:
        return int(self.x.shape[0])

    def one(self, index: int) -> Trajectory:
        """A copy of one plan."""
        rows = (self.x, self.y, self.heading, self.speed, self.acceleration, self.jerk, self.curvature, self.station, self.offset)
        return Trajectory(self.time.copy(), *(row[index].copy() for row in rows))
