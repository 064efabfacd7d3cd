"""What plans are weighed by: the four weights of the paper, the terms of safety and comfort, their scales, and two profiles of them."""

from __future__ import annotations

from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Final, Literal

from regdb_runtime.planning.safe_distance import SafeDistances

Profile = Literal["paper", "default"]

UNITS: Final = MappingProxyType({
    "mean_acceleration": "m/s^2", "speed_variance": "m^2/s^2", "max_curvature": "1/m", "jerk": "m^2/s^6", "offset": "m^2", "clearance": "1",
    "rss_longitudinal": "1", "rss_lateral": "1", "advance": "m",
})  # fmt: skip
"""Unit of each part of the cost, before its scale."""


@dataclass(frozen=True, slots=True)
class Weights:
    """W of the paper's equation 1. None of them changes what is lawful: legality is compared before the weighted sum (see `choice`)."""

    legal: float = 1.0
    safety: float = 1.0
    comfort: float = 1.0
    distance: float = 0.2

    def __post_init__(self) -> None:
        if min(self.legal, self.safety, self.comfort, self.distance) < 0:
            raise ValueError("weights are not negative")


@dataclass(frozen=True, slots=True)
class CostSettings:
    """Weights, penalties and scales of one profile. A part counts `value * scale`; a part that is not named is not computed.

    `safety` and `comfort`: part -> scale (inverse units of `UNITS`). `penalty` is C_legal of an unlawful plan, `unknown_penalty` of one whose
    verdict is unknown. `wanted_clearance`: below this distance to a predicted body (metres) clearance costs, from 0 to 1. `instants`: at how
    many instants of the horizon distances to others are looked at; `nearby`: how near somebody must come to be looked at (metres).
    """

    profile: Profile = "default"
    weights: Weights = field(default_factory=Weights)
    penalty: float = 1000.0
    unknown_penalty: float = 100.0
    safety: tuple[tuple[str, float], ...] = ()
    comfort: tuple[tuple[str, float], ...] = ()
    wanted_clearance: float = 1.5
    instants: int = 6
    nearby: float = 80.0
    nearby_most: int = 6
    safe: SafeDistances = field(default_factory=SafeDistances)

    @property
    def asks_for_others(self) -> bool:
        """Whether some part needs to know where others will be."""
        return any(name in OF_OTHERS for name, _ in self.safety + self.comfort)


OF_OTHERS: Final = frozenset(("clearance", "rss_longitudinal", "rss_lateral"))

PAPERS_TERMS: Final = (("mean_acceleration", 0.5), ("speed_variance", 0.5), ("max_curvature", 0.5))
"""The paper names three motion terms for safety and comfort together and says that their sum is the cost, without saying which belongs to
which. So each counts for half in both: with equal weights safety and comfort add up to exactly their sum, in SI."""

PAPER: Final = CostSettings(profile="paper", safety=PAPERS_TERMS, comfort=PAPERS_TERMS)
"""The paper's three motion terms exactly (P29), advance along the reference path (P30), nothing else."""

DEFAULT: Final = CostSettings(
    profile="default",
    safety=(
        ("speed_variance", 0.02), ("max_curvature", 2.0), ("rss_longitudinal", 3.0), ("rss_lateral", 3.0), ("clearance", 4.0),
    ),
    comfort=(("mean_acceleration", 0.5), ("max_curvature", 2.0), ("jerk", 0.05), ("offset", 0.3)),
)  # fmt: skip
"""The paper's terms, and what it leaves out: safe distances (RSS), clearance, jerk, and keeping to the lane's centre. The scales bring a
part to about 1 where one would call it bad: 2 m/s^2 mean acceleration, 4.5 m/s rms jerk, 1.8 m off the centre, a 12 m radius being 0.17."""


def settings(profile: Profile) -> CostSettings:
    """The settings of a profile by name."""
    return PAPER if profile == "paper" else DEFAULT
