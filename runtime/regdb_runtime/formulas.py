"""The arithmetic behind interpretations: distances that published models require, in SI; speeds are not negative unless said."""

from __future__ import annotations

from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

Speed = TypeVar("Speed", float, NDArray[np.float64])
"""One speed, or an array of them: the answer has the same shape."""


def after_response(speed: Speed, response_time: float, acceleration: float) -> tuple[Speed, Speed]:
    """Distance covered while responding at constant acceleration, and the speed then reached."""
    return speed * response_time + acceleration * response_time**2 / 2, speed + acceleration * response_time


def braking_distance(speed: Speed, braking: float) -> Speed:
    """Distance to a stop at constant braking."""
    return speed**2 / (2 * braking)


def responding_stop(speed: Speed, response_time: float, acceleration: float, braking: float) -> Speed:
    """Distance to a stop: accelerating while responding, then constant braking (one side of the article's definitions).

    Where the speed may be negative (lateral, away from the other) and still is after responding, nothing is left to brake.
    """
    covered, reached = after_response(speed, response_time, acceleration)
    return covered + braking_distance((reached + abs(reached)) / 2, braking)


def rss_longitudinal(
    rear_speed: float, front_speed: float, *, response_time: float, max_acceleration: float, min_braking: float, max_braking: float
) -> float:
    """Safe gap behind a vehicle that goes the same way: arXiv:1708.06374, definition 1.

    The rear one accelerates at most during its response time, then brakes at least `min_braking`; the front one brakes at most
    `max_braking`.
    """
    rear = responding_stop(rear_speed, response_time, max_acceleration, min_braking)
    return max(0.0, rear - braking_distance(front_speed, max_braking))


def rss_opposite(
    own_speed: float, other_speed: float, *, response_time: float, max_acceleration: float, min_braking: float, min_braking_correct: float
) -> float:
    """Safe gap between vehicles that come towards each other: arXiv:1708.06374, definition 2.

    The one in its correct lane (here the vehicle itself) need only brake by `min_braking_correct`.
    """
    own = responding_stop(own_speed, response_time, max_acceleration, min_braking_correct)
    return own + responding_stop(other_speed, response_time, max_acceleration, min_braking)


def rss_yield(other_speed: float, *, response_time: float, max_acceleration: float, min_braking: float) -> float:
    """What the other needs to stop after responding: definition 1 of arXiv:1708.06374 with a standing object in front."""
    return rss_longitudinal(
        other_speed, 0.0, response_time=response_time, max_acceleration=max_acceleration, min_braking=min_braking, max_braking=min_braking
    )


def rss_lateral(
    left_speed: float, right_speed: float, *, response_time: float, max_lateral_acceleration: float, min_lateral_braking: float,
    fluctuation_margin: float,
) -> float:  # fmt: skip
    """Safe lateral gap between a vehicle on the left and one on its right: arXiv:1708.06374, definition 6.

    Lateral speeds are positive to the right and may be negative.
    """
    left = responding_stop(left_speed, response_time, max_lateral_acceleration, min_lateral_braking)
    right = responding_stop(-right_speed, response_time, max_lateral_acceleration, min_lateral_braking)
    return fluctuation_margin + max(0.0, left + right)


def stopping_distance(speed: Speed, *, response_time: float, min_braking: float) -> Speed:
    """Distance to a stop: speed held while responding, then constant braking (AASHTO's stopping sight distance on the level)."""
    return speed * response_time + braking_distance(speed, min_braking)
