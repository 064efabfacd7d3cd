"""What a recorded vehicle does at an instant, in the state machine's words: read off its course, its speed and who is ahead of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from regdb_runtime.drive.observed.course import Place
from regdb_runtime.maneuver import Junction, Maneuver
from regdb_runtime.maps.lane_path import LanePath, next_junction
from regdb_runtime.maps.road_map import Floats, RoadMap
from regdb_runtime.observation import Footprint, Track
from regdb_runtime.planning.goal import Follow, Goal, StopPoint
from regdb_runtime.strategy.machine import Machine
from regdb_runtime.strategy.settings import StrategySettings
from regdb_runtime.strategy.surroundings import Placed, lead, place
from regdb_runtime.worlds.replay import Motion

TURNS = {"left": "turn_left", "right": "turn_right", "u_turn": "u_turn"}


@dataclass(frozen=True, slots=True)
class ReadingSettings:
    """When a recorded vehicle stands: slower than this (m/s), what the places of a standing one jitter by within a second. `overrun`: metres past
    the line at which one that stands still stands at it."""

    standstill: float = 0.3
    overrun: float = 0.3


class Reader:
    """Reads manoeuvres; what never changes goes in here."""

    def __init__(
        self, road_map: RoadMap, machine: Machine, strategy: StrategySettings | None = None, settings: ReadingSettings | None = None
    ) -> None:
        self.road_map, self.machine = road_map, machine
        self.strategy, self.settings = strategy or StrategySettings(), settings or ReadingSettings()

    def read(self, motion: Motion, there: Place, path: LanePath, tracks: Sequence[Track], footprint: Footprint, before: str) -> Maneuver:
        """The manoeuvre at one row along one path. `before`: the state at the row before, empty at the first."""
        row = there.row
        fronts = self.fronts(motion, path, footprint, row)
        front, rear = float(fronts[0]), float(fronts[0]) - footprint.length
        junction = next_junction(self.road_map, path, rear)
        handling = junction is not None and junction.stop_station - front <= self._reach(float(motion.speed[row]))
        placed = place(path.path, tracks)
        margins = self.strategy.corridor_margin, self.strategy.rider_margin
        ahead = lead(placed, front, footprint, 0.0, margins)
        ahead = ahead if ahead is not None and self._is_near(ahead, front, float(motion.speed[row])) else None
        passed = self._passed(placed, motion, row, front, rear)
        state = self._state(motion, there, junction if handling else None, fronts, ahead, passed)
        current = self._entered_from(before, state)
        stop = StopPoint(junction.stop_station, "stop") if junction is not None and state.endswith(".stop") else None
        goal = Goal((0.0,), max(float(motion.speed[row]), 0.1), (), stop, _follow(ahead))
        changes = there.change
        signal = motion.at(float(motion.time[row])).turn_signal or "off"
        return Maneuver(
            current, state, there.lane, path, goal, signal, None if changes is None else changes.after, passed,
            "left" if passed is not None else "none", None if ahead is None else ahead.track.id, junction,
        )  # fmt: skip

    def fronts(self, motion: Motion, path: LanePath, footprint: Footprint, row: int) -> Floats:
        """Stations of the front bumper from a row on."""
        cos, sin = np.cos(motion.heading[row:]), np.sin(motion.heading[row:])
        half = footprint.length / 2
        points = np.column_stack([motion.x[row:] + half * cos, motion.y[row:] + half * sin])
        return path.path.project(points, extend=True)[0]

    def _state(
        self, motion: Motion, there: Place, junction: Junction | None, fronts: Floats, ahead: Placed | None, passed: str | None
    ) -> str:
        if there.change is not None:
            return f"lane_following.lane_change_{there.change.side}"
        if passed is not None:
            return "overtaking.go_straight"
        following = "car_following" if ahead is not None else "go_straight"
        if junction is None:
            return f"lane_following.{following}"
        before = fronts[0] <= junction.stop_station + self.settings.overrun
        waits = ahead is not None and ahead.front <= junction.stop_station + 1.0
        if before and not waits and self._stops(motion, there.row, fronts, junction):
            return "intersection_handling.stop"
        if float(motion.speed[there.row : there.row + 2].max()) < self.settings.standstill:
            return "intersection_handling.car_following" if ahead is not None else "intersection_handling.stop"
        enters = not before or (len(fronts) > 1 and fronts[1] > junction.stop_station)
        if enters and junction.turn in TURNS:
            return f"intersection_handling.{TURNS[junction.turn]}"
        return f"intersection_handling.{following}"

    def _stops(self, motion: Motion, row: int, fronts: Floats, junction: Junction) -> bool:
        """Whether it stands before the line, or goes on to a stand there without speeding up."""
        speed = motion.speed[row:]
        stands = np.flatnonzero((speed < self.settings.standstill) & (fronts <= junction.stop_station + self.settings.overrun))
        return bool(len(stands)) and bool((np.diff(speed[: stands[0] + 1]) < self.settings.standstill).all())

    def _passed(self, placed: Sequence[Placed], motion: Motion, row: int, front: float, rear: float) -> str | None:
        """A rider that goes the same way and is beside the vehicle now, slower than it: who is being overtaken within the lane."""
        for item in placed:
            if item.track.kind == "bicycle" and 0.5 < item.along < motion.speed[row] and item.front > rear and item.rear < front:
                return item.track.id if abs(item.offset) < self.strategy.rider_margin + motion.obstacle.width + item.track.width else None
        return None

    def _reach(self, speed: float) -> float:
        return max(self.strategy.handling_distance, self.strategy.handling_time * speed)

    def _is_near(self, item: Placed, front: float, speed: float) -> bool:
        gap, closing = item.rear - front, speed - item.along
        near = gap <= self.strategy.follow_distance + self.strategy.follow_time * speed
        return near or (closing > 0.0 and gap <= closing * self.strategy.closing_time)

    def _entered_from(self, before: str, state: str) -> str:
        """The state from which this one is entered, by the machine's own micro-steps; itself where it stays or the machine has no such way."""
        if not before or before == state:
            return state
        step = self.machine.step_to(before, state)
        return state if step is None else step.current


def _follow(item: Placed | None) -> Follow | None:
    return None if item is None else Follow(item.track.id, item.rear, max(item.along, 0.0), item.track.acceleration)
