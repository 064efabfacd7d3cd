"""The cost of plans, C = W . [legal, safety, comfort, distance] (paper, equations 1 and 2), over all plans of a manoeuvre at once."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Final

import numpy as np
from numpy.typing import NDArray

from regdb_runtime.planning.cost_settings import OF_OTHERS, CostSettings
from regdb_runtime.planning.users_along_path import UsersAlongPath, nearness
from regdb_runtime.trajectory import Candidates

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class CostTerms:
    """C = [legal, safety, comfort, distance] before weighting, and the weighted total (paper, equation 1). `parts`: what safety and comfort
    consist of, and `advance`; each in the unit that `cost_settings.UNITS` gives it, before its scale."""

    legal: float
    safety: float
    comfort: float
    distance: float
    total: float
    parts: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class MotionCosts:
    """The three terms that need no law, (N,) each, with their parts; legality is added when a plan has been judged."""

    safety: Floats
    comfort: Floats
    distance: Floats
    parts: Mapping[str, Floats]
    settings: CostSettings

    @cached_property
    def weighted(self) -> Floats:
        """w_safety C_safety + w_comfort C_comfort + w_distance C_distance, (N,)."""
        weights = self.settings.weights
        return weights.safety * self.safety + weights.comfort * self.comfort + weights.distance * self.distance

    def order(self, among: Integers | None = None) -> Integers:
        """Indices of plans, cheapest first, of equal ones the lower index; only those `among`, if given."""
        chosen = np.arange(len(self.safety)) if among is None else np.sort(among)
        return chosen[np.argsort(self.weighted[chosen], kind="stable")]


def motion_cost(
    candidates: Candidates, settings: CostSettings, wanted_speed: float = 0.0, users: UsersAlongPath | None = None
) -> MotionCosts:
    """Safety, comfort and distance of every plan. Without `users` the parts that need others are left out.

    C_distance is what the plan falls short of the advance that `wanted_speed` (m/s, the same for all manoeuvres of a tick, so that they can
    be compared) would make along the reference path, metres by station. Raises ValueError for a part the settings name and nobody knows.
    """
    names = dict.fromkeys(name for name, _ in settings.safety + settings.comfort)
    if unknown := [name for name in names if name not in PARTS and name not in OF_OTHERS]:
        raise ValueError(f"no such part of a cost: {', '.join(unknown)}")
    parts = {name: PARTS[name](candidates) for name in names if name in PARTS}
    if users is not None and settings.asks_for_others:
        found = nearness(candidates, settings, users)
        parts.update((name, found[name]) for name in names if name in found)
    parts["advance"] = candidates.station[:, -1] - candidates.station[:, 0]
    wanted = wanted_speed * float(candidates.time[-1])
    return MotionCosts(_scaled(parts, settings.safety), _scaled(parts, settings.comfort), wanted - parts["advance"], parts, settings)


def weigh(costs: MotionCosts, index: int, rank: int, added: float = 0.0) -> CostTerms:
    """The cost of one plan once it has been judged; `rank` 0 lawful, 1 unknown, 2 or more unlawful; `added` goes to distance (a strategist's
    own cost of a manoeuvre in metres, such as a lane change)."""
    settings, weights = costs.settings, costs.settings.weights
    legal = (0.0, settings.unknown_penalty)[rank] if rank < 2 else settings.penalty
    distance = float(costs.distance[index]) + added
    safety, comfort = float(costs.safety[index]), float(costs.comfort[index])
    total = weights.legal * legal + weights.safety * safety + weights.comfort * comfort + weights.distance * distance
    return CostTerms(legal, safety, comfort, distance, total, {name: float(values[index]) for name, values in costs.parts.items()})


def _scaled(parts: Mapping[str, Floats], scales: Sequence[tuple[str, float]]) -> Floats:
    total = np.zeros_like(parts["advance"])
    for name, scale in scales:
        if name in parts:
            total += scale * parts[name]
    return total


def mean_acceleration(candidates: Candidates) -> Floats:
    """Mean of |acceleration| over the plan, so that braking counts, m/s^2."""
    rows = candidates.acceleration.shape[1]
    return np.asarray(np.abs(candidates.acceleration) @ np.full(rows, 1.0 / rows))


def speed_variance(candidates: Candidates) -> Floats:
    """Variance of the speed over the plan, m^2/s^2."""
    rows = candidates.speed.shape[1]
    apart = candidates.speed - (candidates.speed @ np.full(rows, 1.0 / rows))[:, None]
    return np.asarray(np.einsum("ij,ij->i", apart, apart) / rows)


def max_curvature(candidates: Candidates) -> Floats:
    """Greatest |curvature| over the plan, 1/m."""
    return np.asarray(np.abs(candidates.curvature).max(axis=1))


def jerk(candidates: Candidates) -> Floats:
    """Mean square of the jerk, m^2/s^6."""
    return np.asarray(np.einsum("ij,ij->i", candidates.jerk, candidates.jerk) / candidates.jerk.shape[1])


def offset(candidates: Candidates) -> Floats:
    """Mean square of the offset from the path, m^2."""
    return np.asarray(np.einsum("ij,ij->i", candidates.offset, candidates.offset) / candidates.offset.shape[1])


PARTS: Final[Mapping[str, Callable[[Candidates], Floats]]] = {
    "mean_acceleration": mean_acceleration,
    "speed_variance": speed_variance,
    "max_curvature": max_curvature,
    "jerk": jerk,
    "offset": offset,
}
