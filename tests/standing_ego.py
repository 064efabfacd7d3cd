"""A plan that keeps the ego where it is, for tests that look at everybody else."""

from __future__ import annotations

import numpy as np
from regdb_runtime.observation import EgoState
from regdb_runtime.trajectory import Trajectory


def standing(ego: EgoState) -> Trajectory:
    """Three seconds at a standstill."""
    times = np.linspace(0.0, 3.0, 31)
    zero = np.zeros_like(times)
    return Trajectory(times, zero + ego.x, zero + ego.y, zero + ego.heading, zero, zero, zero, zero, zero, zero)
