"""The protocol every world keeps: it says what is seen, and moves on by a step under the ego's plan."""

from __future__ import annotations

from typing import Protocol

from regdb_runtime.maps.road_map import RoadMap
from regdb_runtime.observation import Footprint, Observation, TurnSignal
from regdb_runtime.trajectory import Trajectory


class World(Protocol):
    """Deterministic for a seed: the same calls give the same bytes."""

    @property
    def road_map(self) -> RoadMap: ...

    @property
    def footprint(self) -> Footprint: ...

    @property
    def route(self) -> tuple[str, ...]:
        """Ids of the lanes to the destination, in order: one lane for each segment of the road (a neighbour of it serves as well)."""
        ...

    def observe(self) -> Observation:
        """What is seen now."""
        ...

    def step(self, plan: Trajectory, turn_signal: TurnSignal, duration: float) -> None:
        """Move on by `duration` seconds; the ego follows the plan as its kinematics and limits let it."""
        ...

    def close(self) -> None:
        """Free what the world holds."""
        ...
