"""Safe distances over many plans at once: the article's longitudinal and lateral ones (RSS), on arrays; arithmetic as in `formulas`."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from regdb_runtime.formulas import braking_distance, responding_stop

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class SafeDistances:
    """Parameters of arXiv:1708.06374, SI, with the numbers of the interpretation profile `rss` (recalled from Intel's ad-rss-lib)."""

    response_time: float = 1.0
    max_acceleration: float = 3.5
    min_braking: float = 4.0
    max_braking: float = 8.0
    max_lateral_acceleration: float = 0.2
    min_lateral_braking: float = 0.8
    fluctuation_margin: float = 0.1

    def longitudinal(self, rear_speed: Floats, front_speed: Floats) -> Floats:
        """Definition 1: gap that the rear one needs, broadcast over both; not negative."""
        return np.asarray(np.maximum(self.rear(rear_speed) - self.front(front_speed), 0.0))

    def rear(self, speed: Floats) -> Floats:
        """The rear one's half of definition 1: what it covers until it stands."""
        return responding_stop(speed, self.response_time, self.max_acceleration, self.min_braking)

    def front(self, speed: Floats) -> Floats:
        """The front one's half of definition 1: what it covers at its hardest braking."""
        return braking_distance(speed, self.max_braking)

    def lateral(self, towards_right: Floats, towards_left: Floats) -> Floats:
        """Definition 6: gap between the left one, which moves to the right at the first speed, and the right one, which moves to the left at
        the second; either may be negative."""
        return np.asarray(self.fluctuation_margin + np.maximum(self.side(towards_right) + self.side(towards_left), 0.0))

    def side(self, closing_speed: Floats) -> Floats:
        """One side's half of definition 6: what it covers towards the other until it stands laterally."""
        return responding_stop(closing_speed, self.response_time, self.max_lateral_acceleration, self.min_lateral_braking)


def shortfall(gap: Floats, safe: Floats) -> Floats:
    """How much of the safe distance is missing, from 0 (kept) to 1 (touching or past)."""
    return np.asarray(np.minimum(np.maximum(1.0 - gap / np.maximum(safe, 1e-9), 0.0), 1.0))
