"""The intelligent driver model: how a driver speeds up and keeps behind another (Treiber, Hennecke, Helbing 2000, arXiv:cond-mat/0002177)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import overload

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class IdmParameters:
    """SI. Acceleration, comfortable braking, exponent and jam distance as in the article's table I; desired speed of a city street (35 mph)
    and headway 1.5 s (the article: 120 km/h and 1.6 s). `hardest_braking` bounds the answer, which the model itself leaves open."""

    desired_speed: float = 15.65
    headway: float = 1.5
    jam_distance: float = 2.0
    acceleration: float = 0.73
    braking: float = 1.67
    exponent: float = 4.0
    hardest_braking: float = 8.0


@overload
def idm_acceleration(speed: float, gap: float, closing_speed: float, parameters: IdmParameters, desired_speed: float | None = None) -> float: ...
@overload
def idm_acceleration(
    speed: Floats, gap: Floats, closing_speed: Floats, parameters: IdmParameters, desired_speed: Floats | None = None
) -> Floats: ...
def idm_acceleration(
    speed: float | Floats, gap: float | Floats, closing_speed: float | Floats, parameters: IdmParameters,
    desired_speed: float | Floats | None = None,
) -> float | Floats:  # fmt: skip
    """Equations 3 and 4: dv/dt = a [1 - (v/v0)^delta - (s*/s)^2], s* = s0 + max(0, v T + v dv / (2 sqrt(a b))).

    `gap` bumper to bumper (inf with nobody ahead), `closing_speed` own less the leader's. Never below `-hardest_braking`; that is also the
    answer when the gap is used up. Numbers in, number out; arrays broadcast. `desired_speed` stands for the parameters' own where given.
    """
    wanted = parameters.desired_speed if desired_speed is None else desired_speed
    if isinstance(speed, np.ndarray) or isinstance(gap, np.ndarray) or isinstance(closing_speed, np.ndarray):
        return _many(np.asarray(speed), np.asarray(gap), np.asarray(closing_speed), parameters, np.asarray(wanted))
    free = (speed / float(wanted)) ** parameters.exponent if wanted > 0.0 else math.inf
    if gap <= 0.0:
        return -parameters.hardest_braking
    near = desired_gap(speed, closing_speed, parameters) / gap
    return max(parameters.acceleration * (1.0 - free - near * near), -parameters.hardest_braking)


def desired_gap(speed: float, closing_speed: float, parameters: IdmParameters) -> float:
    """Equation 4: s*, the gap the driver wants now."""
    dynamic = speed * parameters.headway + speed * closing_speed / (2 * math.sqrt(parameters.acceleration * parameters.braking))
    return parameters.jam_distance + max(0.0, dynamic)


def _many(speed: Floats, gap: Floats, closing_speed: Floats, parameters: IdmParameters, wanted: Floats) -> Floats:
    dynamic = speed * parameters.headway + speed * closing_speed / (2 * math.sqrt(parameters.acceleration * parameters.braking))
    near = (parameters.jam_distance + np.maximum(dynamic, 0.0)) / np.maximum(gap, 1e-9)
    with np.errstate(divide="ignore", invalid="ignore"):
        free = np.where(wanted > 0.0, (speed / wanted) ** parameters.exponent, np.inf)
    found = parameters.acceleration * (1.0 - free - near * near)
    return np.asarray(np.where(gap <= 0.0, -parameters.hardest_braking, np.maximum(found, -parameters.hardest_braking)))
