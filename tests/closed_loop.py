"""Planning anew every tenth of a second with ideal tracking, by a plain cost of one's own: how the sampler's plans follow each other."""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from regdb_runtime.maps.reference_path import ReferencePath
from regdb_runtime.observation import EgoState, Footprint
from regdb_runtime.planning.goal import Goal
from regdb_runtime.planning.kinematic_limits import check
from regdb_runtime.planning.lattice import Workspace, sample
from regdb_runtime.planning.settings import VehicleLimits
from regdb_runtime.trajectory import Candidates

FOOTPRINT = Footprint()


@dataclass
class Drive:
    """What was driven: states every 0.1 s, and how often the comfortable limits left nothing."""

    states: list[EgoState]
    stations: list[float]
    offsets: list[float]
    hard: int = 0
    reasons: list[dict[str, int]] = field(default_factory=list)

    @property
    def speed(self) -> np.ndarray:
        return np.array([state.speed for state in self.states])

    @property
    def acceleration(self) -> np.ndarray:
        return np.array([state.acceleration for state in self.states])

    @property
    def jerk(self) -> np.ndarray:
        return np.diff(self.acceleration) / 0.1

    @property
    def bumper(self) -> np.ndarray:
        return np.array(self.stations) + FOOTPRINT.front


def plain_cost(plans: Candidates, progress: float = 1.0) -> np.ndarray:
    """Way not made, harshness, and distance from the path."""
    way = plans.station[:, -1] - plans.station[:, 0]
    harsh = (plans.acceleration**2).mean(axis=1) + 0.1 * (plans.jerk**2).mean(axis=1) + 200 * (plans.curvature**2).mean(axis=1)
    return -progress * way / 5 + 0.2 * harsh + 0.3 * np.abs(plans.offset).mean(axis=1)


def drive(path: ReferencePath, ego: EgoState, goal: Callable[[float, float], Goal], seconds: float, progress: float = 1.0) -> Drive:
    """Drives by `goal(time, front bumper's station)`."""
    workspace, state = Workspace(), path.frenet_state(ego)
    found = Drive([ego], [state.s], [state.d])
    for tick in range(round(seconds / 0.1)):
        state = path.frenet_state(found.states[-1])
        wanted = goal(tick * 0.1, state.s + FOOTPRINT.front)
        plans = sample(path, state, wanted, FOOTPRINT, None, workspace)
        verdict = check(plans, VehicleLimits.comfortable(), wanted, FOOTPRINT)
        if not verdict.ok.any():
            found.hard += 1
            found.reasons.append(verdict.counts)
            verdict = check(plans, VehicleLimits(), wanted, FOOTPRINT)
        assert verdict.ok.any(), (tick, state, verdict.counts)
        best = plans.one(int(np.argmin(np.where(verdict.ok, plain_cost(plans, progress), np.inf))))
        found.states.append(EgoState(*(float(row[1]) for row in (best.x, best.y, best.heading, best.speed, best.acceleration, best.curvature))))
        found.stations.append(float(best.station[1]))
        found.offsets.append(float(best.offset[1]))
    return found
