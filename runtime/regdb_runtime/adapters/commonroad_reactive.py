"""The law in CommonRoad's reactive planner: a cost function for `ReactivePlanner.set_cost_function`, nothing of CommonRoad imported.

The reactive planner samples its own trajectories and calls `cost_function.evaluate(trajectory)` on each; the cheapest that keeps its
kinematic limits and touches nothing is driven. Here that cost is the rank of the trajectory under the law (lawful 0, unknown 1, unlawful 2)
and, within a rank, whatever cost was used before. So the planner takes no unlawful trajectory while it has sampled a lawful one, whatever its
weights.

    cost = RegulationCostFunction(planner, DefaultCostFunction(desired_speed))
    reactive.set_cost_function(cost)
    ...
    cost.observe(observation)          # once a cycle, before reactive.plan()
    reactive.plan()
"""

from __future__ import annotations

import math
from typing import Any, Protocol

import numpy as np

from regdb_runtime.assessment.assessed import Assessed
from regdb_runtime.decision import Decision
from regdb_runtime.observation import Observation
from regdb_runtime.trajectory import Floats, Trajectory


class JudgingPlanner(Protocol):
    """What the hook needs of our planner: its strategy, and its judgement of others' plans."""

    def step(self, observation: Observation) -> Decision: ...

    def judge(self, observation: Observation, plan: Trajectory) -> Assessed: ...


class CostFunction(Protocol):
    """`commonroad_rp.cost_function.CostFunction`."""

    def evaluate(self, trajectory: Any) -> float: ...


class RegulationCostFunction:
    """Keeps the interface of `commonroad_rp.cost_function.CostFunction`; other attributes are those of the cost function within.

    The reactive planner sets `desired_speed`, `desired_s` and `w_a` on its cost function where it has them: they go to the one within.
    """

    def __init__(self, planner: JudgingPlanner, within: CostFunction) -> None:
        self.__dict__.update(planner=planner, within=within, decision=None, _observation=None)

    def __getattr__(self, name: str) -> Any:
        return getattr(self.__dict__["within"], name)

    def __setattr__(self, name: str, value: Any) -> None:
        setattr(self.within, name, value)

    def observe(self, observation: Observation) -> Decision:
        """What is seen now; our planner chooses the state under which the samples are judged. Once a cycle, before `ReactivePlanner.plan`."""
        decision: Decision = self.planner.step(observation)
        self.__dict__.update(decision=decision, _observation=observation)
        return decision

    def evaluate(self, trajectory: Any) -> float:
        """Rank, and within it the other cost laid between 0 and 1 without changing its order. Raises RuntimeError before `observe`.

        `trajectory`: a `commonroad_rp.trajectories.TrajectorySample` with `cartesian` (x, y, theta, v, a, kappa of the rear axle) and `dt`.
        """
        if self._observation is None:
            raise RuntimeError("evaluate before observe: there is nothing to judge by")
        cost = float(self.within.evaluate(trajectory))
        rank = self.planner.judge(self._observation, plan_of(trajectory)).rank
        return float(rank) + (1.0 if math.isinf(cost) else max(cost, 0.0) / (1.0 + max(cost, 0.0))) * (1 - 2**-30)


def plan_of(sample: Any) -> Trajectory:
    """A `TrajectorySample` as a plan; its jerk by differences, its stations and offsets those of CommonRoad's own path."""
    cartesian, dt = sample.cartesian, float(sample.dt)
    rows: list[Floats] = [np.asarray(getattr(cartesian, name), dtype=np.float64) for name in ("x", "y", "theta", "v", "a", "kappa")]
    x, y, heading, speed, acceleration, curvature = rows
    time = np.arange(len(x), dtype=np.float64) * dt
    jerk = np.asarray(np.gradient(acceleration, dt), dtype=np.float64) if len(x) > 1 else np.zeros_like(x)
    curvilinear = getattr(sample, "curvilinear", None)
    station = np.zeros_like(x) if curvilinear is None else np.asarray(curvilinear.s, dtype=np.float64)
    offset = np.zeros_like(x) if curvilinear is None else np.asarray(curvilinear.d, dtype=np.float64)
    return Trajectory(time, x, y, heading, speed, acceleration, jerk, curvature, station, offset)
