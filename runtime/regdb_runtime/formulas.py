"""The arithmetic behind interpretations: distances that published models require, in SI; speeds are not negative unless said."""

from __future__ import annotations


def after_response(speed: float, response_time: float, acceleration: float) -> tuple[float, float]:
    """Distance covered while responding at constant acceleration, and the speed then reached."""
    return speed * response_time + acceleration * response_time**2 / 2, speed + acceleration * response_time


def rss_longitudinal(
    rear_speed: float, front_speed: float, *, response_time: float, max_acceleration: float, min_braking: float, max_braking: float
) -> float:
    """Safe gap behind a vehicle that goes the same way: arXiv:1708.06374, definition 1.

    The rear one accelerates at most during its response time, then brakes at least `min_braking`; the front one brakes at most
    `max_braking`.
    """
    covered, reached = after_response(rear_speed, response_time, max_acceleration)
    return max(0.0, covered + reached**2 / (2 * min_braking) - front_speed**2 / (2 * max_braking))


def rss_opposite(
    own_speed: float, other_speed: float, *, response_time: float, max_acceleration: float, min_braking: float, min_braking_correct: float
) -> float:
    """Safe gap between vehicles that come towards each other: arXiv:1708.06374, definition 2.

    The one in its correct lane (here the vehicle itself) need only brake by `min_braking_correct`.
    """
    own_covered, own_reached = after_response(own_speed, response_time, max_acceleration)
    other_covered, other_reached = after_response(other_speed, response_time, max_acceleration)
    return own_covered + own_reached**2 / (2 * min_braking_correct) + other_covered + other_reached**2 / (2 * min_braking)


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
    left_covered, left_reached = after_response(left_speed, response_time, max_lateral_acceleration)
    right_covered, right_reached = after_response(right_speed, response_time, -max_lateral_acceleration)
    left = left_covered + left_reached**2 / (2 * min_lateral_braking)
    right = right_covered - right_reached**2 / (2 * min_lateral_braking)
    return fluctuation_margin + max(0.0, left - right)


def stopping_distance(speed: float, *, response_time: float, min_braking: float) -> float:
    """Distance to a stop: speed held while responding, then constant braking (AASHTO's stopping sight distance on the level)."""
    return speed * response_time + speed**2 / (2 * min_braking)
