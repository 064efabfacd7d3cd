"""What a manoeuvre asks of the sampler, and what binds the motion by station: both are data, made by the strategist, read by the lattice."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class SpeedCap:
    """Not faster than `speed` (m/s) from station `start` to `end` (metres along the path, of the front bumper); `rule` cites why."""

    start: float
    end: float
    speed: float
    rule: str


@dataclass(frozen=True, slots=True)
class StopPoint:
    """Stand with the front bumper at `station` at the latest (metres along the path); at most `slack` before it; `rule` cites why."""

    station: float
    rule: str
    slack: float = 2.0
    margin: float = 0.5


@dataclass(frozen=True, slots=True)
class Follow:
    """Keep behind something on the path: its rear end's station now, its speed, and what it is (a track's id)."""

    track: str
    rear_station: float
    speed: float
    acceleration: float = 0.0


@dataclass(frozen=True, slots=True)
class Goal:
    """What to sample: where across the path to end (offsets, metres, left positive), how fast at most, where to stop, whom to follow."""

    offsets: tuple[float, ...] = (0.0,)
    cruise_speed: float = 15.0
    caps: tuple[SpeedCap, ...] = ()
    stop: StopPoint | None = None
    follow: Follow | None = None
