"""Recorded road users and planning problems: who was where at each time step; nothing here knows a file format."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from regdb_runtime.maps.road_map import Floats
from regdb_runtime.observation import Track, TrackKind, TurnSignal


@dataclass(frozen=True, eq=False)
class RecordedObstacle:
    """One road user: length and width in metres, and its states, all (n,): time `steps` in order, the middle of its rectangle, heading
    anticlockwise from +x, speed and acceleration in SI, NaN where the file gives none.

    `source_kind`: the file's own word. `static`: stands at its one state all the time. `turn_signals` and `warning_lights` per state, None
    and `none` where the file says nothing.
    """

    id: str
    kind: TrackKind
    source_kind: str
    length: float
    width: float
    static: bool
    steps: NDArray[np.int64]
    x: Floats
    y: Floats
    heading: Floats
    speed: Floats
    acceleration: Floats
    turn_signals: tuple[TurnSignal | None, ...] = ()
    warning_lights: tuple[str, ...] = ()

    def row(self, step: int) -> int | None:
        """The row of its state at a time step, None where it is not there."""
        if self.static:
            return 0
        place = int(np.searchsorted(self.steps, step))
        return place if place < len(self.steps) and self.steps[place] == step else None


@dataclass(frozen=True)
class RecordedGoal:
    """One way to reach a planning problem's goal: bounds of time step, speed (m/s) and heading (rad), None where free; lanes, or areas (n, 2)."""

    steps: tuple[int, int] | None = None
    speed: tuple[float, float] | None = None
    heading: tuple[float, float] | None = None
    lanes: tuple[str, ...] = ()
    areas: tuple[Floats, ...] = ()


@dataclass(frozen=True)
class PlanningProblem:
    """Where a vehicle begins (middle of its rectangle, SI) and what it should reach."""

    id: str
    step: int
    x: float
    y: float
    heading: float
    speed: float
    goals: tuple[RecordedGoal, ...] = ()


@dataclass(frozen=True, eq=False)
class RecordedTraffic:
    """All recorded road users, by the file's order. `time_step`: seconds from one step to the next. `notes`: what was not taken over."""

    id: str
    time_step: float
    obstacles: tuple[RecordedObstacle, ...]
    problems: tuple[PlanningProblem, ...] = ()
    source: str = ""
    notes: tuple[str, ...] = ()

    @cached_property
    def last_step(self) -> int:
        """The last time step at which a moving one is there; 0 without any."""
        return max((int(item.steps[-1]) for item in self.obstacles if not item.static), default=0)

    def tracks_at(self, step: int, leave_out: frozenset[str] = frozenset()) -> tuple[Track, ...]:
        """Everyone who is there at a time step. Acceleration and yaw rate that the file does not give are differences of its states."""
        rows = ((item, item.row(step)) for item in self.obstacles if item.id not in leave_out)
        return tuple(self._track(item, row) for item, row in rows if row is not None)

    def _track(self, item: RecordedObstacle, row: int) -> Track:
        before, after = max(row - 1, 0), min(row + 1, len(item.steps) - 1)
        seconds = float(item.steps[after] - item.steps[before]) * self.time_step
        speed, acceleration = float(item.speed[row]), float(item.acceleration[row])
        if math.isnan(acceleration):
            acceleration = float(item.speed[after] - item.speed[before]) / seconds if seconds else 0.0
        yaw = math.remainder(float(item.heading[after] - item.heading[before]), math.tau) / seconds if seconds else 0.0
        return Track(
            item.id, item.kind, float(item.x[row]), float(item.y[row]), float(item.heading[row]),
            0.0 if math.isnan(speed) else speed, item.length, item.width, 0.0 if math.isnan(acceleration) else acceleration,
            0.0 if math.isnan(yaw) else yaw, item.turn_signals[row] if item.turn_signals else None,
            item.warning_lights[row] if item.warning_lights else "none",
        )  # fmt: skip
