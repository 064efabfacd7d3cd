"""Recorded road users at any instant: places interpolated between recorded states, speeds measured from the places."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from regdb_runtime.maps.recorded_traffic import RecordedObstacle, RecordedTraffic
from regdb_runtime.maps.road_map import Floats
from regdb_runtime.observation import Track

MOVING = 0.2
"""Metres a second below which a course cannot be told from the noise of the places, and the yaw rate is taken as none."""


@dataclass(frozen=True, slots=True)
class ReplaySettings:
    """How motion is measured. `window`: seconds on either side of an instant over which a speed is measured.

    Recorded speeds are not used where places allow better: camera recordings (NGSIM) carry spikes of several m/s over a few tenths of a second
    in their speeds that their places do not share. Half a second on either side leaves braking as it was and takes the jitter out.
    """

    window: float = 0.5


@dataclass(frozen=True, eq=False)
class Motion:
    """One road user over its recording, all (n,): `time` in seconds of the recording, at every step of it (`step` seconds), middle of the
    rectangle, heading (unwrapped), speed along the heading (not negative), acceleration, yaw rate; SI."""

    obstacle: RecordedObstacle
    time: Floats
    x: Floats
    y: Floats
    heading: Floats
    speed: Floats
    acceleration: Floats
    yaw_rate: Floats
    step: float

    @property
    def begins(self) -> float:
        """First instant."""
        return float(self.time[0])

    @property
    def ends(self) -> float:
        """Last instant."""
        return float(self.time[-1])

    def is_there(self, time: float) -> bool:
        """Whether it is in the recording at an instant."""
        return self.obstacle.static or self.begins - 1e-6 <= time <= self.ends + 1e-6

    def at(self, time: float) -> Track:
        """Its state at an instant of its recording."""
        item = self.obstacle
        x, y, heading, speed, acceleration, yaw = (
            float(np.interp(time, self.time, row)) for row in (self.x, self.y, self.heading, self.speed, self.acceleration, self.yaw_rate)
        )
        row = int(np.clip(np.searchsorted(item.steps, round((time - self.begins) / self.step, 6) + item.steps[0], side="right") - 1, 0, None))
        return Track(
            item.id, item.kind, x, y, math.remainder(heading, math.tau), speed, item.length, item.width, acceleration, yaw,
            item.turn_signals[row] if item.turn_signals else None, item.warning_lights[row] if item.warning_lights else "none",
        )  # fmt: skip


class Replay:
    """A recording played back; the same instant gives the same bytes."""

    def __init__(self, traffic: RecordedTraffic, settings: ReplaySettings | None = None) -> None:
        self.traffic = traffic
        self.settings = settings or ReplaySettings()
        self.motions = {item.id: motion_of(item, traffic.time_step, self.settings) for item in traffic.obstacles}

    @property
    def ends(self) -> float:
        """The last instant at which a moving one is there, seconds."""
        return self.traffic.last_step * self.traffic.time_step

    def tracks(self, time: float, leave_out: str = "") -> tuple[Track, ...]:
        """Everybody who is there at an instant, in the file's order."""
        return tuple(motion.at(time) for name, motion in self.motions.items() if name != leave_out and motion.is_there(time))


def motion_of(item: RecordedObstacle, step: float, settings: ReplaySettings) -> Motion:
    """The motion of one road user, measured from its places."""
    time = item.steps.astype(np.float64) * step
    heading = np.unwrap(item.heading)
    if item.static or len(time) < 2:
        given = np.nan_to_num(item.speed)
        nothing = np.zeros_like(time)
        return Motion(item, time, item.x, item.y, heading, nothing if item.static else given, nothing, nothing, step)
    every = np.arange(item.steps[0], item.steps[-1] + 1).astype(np.float64) * step
    x, y, heading = (np.interp(every, time, row) for row in (item.x, item.y, heading))
    time = every
    dx, dy, middle = np.diff(x), np.diff(y), (heading[1:] + heading[:-1]) / 2
    progress = np.concatenate(([0.0], np.cumsum(dx * np.cos(middle) + dy * np.sin(middle))))
    speed = np.maximum(_slopes(time, progress, settings.window), 0.0)
    turning = np.where(speed > MOVING, _slopes(time, heading, settings.window), 0.0)
    return Motion(item, time, x, y, heading, speed, _slopes(time, speed, settings.window), turning, step)


def _slopes(time: Floats, values: Floats, window: float) -> Floats:
    """The slope at each instant: of the straight line fitted to all values within `window` seconds of it.

    Near the ends of the recording it is that of the first, or last, whole window: half of one would be twice as noisy.
    """
    middle = np.clip(time, min(time[0] + window, time.mean()), max(time[-1] - window, time.mean()))
    near = np.abs(middle[:, None] - time[None, :]) <= window + 1e-9
    count = near.sum(axis=1)
    mean_time, mean_value = near @ time / count, near @ values / count
    away = np.where(near, time[None, :] - mean_time[:, None], 0.0)
    spread = (away**2).sum(axis=1)
    found: Floats = (away * (values[None, :] - mean_value[:, None])).sum(axis=1) / np.where(spread > 0.0, spread, 1.0)
    return found
