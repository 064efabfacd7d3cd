"""Trajectories, one and many: motion of the middle of the rear axle over time, in the plane and along the path."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class FrenetState:
    """Start of a plan along a path: station and offset (positive to the left) with their time derivatives, SI."""

    s: float
    s_dot: float = 0.0
    s_ddot: float = 0.0
    d: float = 0.0
    d_dot: float = 0.0
    d_ddot: float = 0.0


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
