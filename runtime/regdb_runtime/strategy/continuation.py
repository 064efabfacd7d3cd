"""From one plan to the next: where the last one has brought the vehicle, and how to come to a stand along it when nothing else is left."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from regdb_runtime.observation import EgoState
from regdb_runtime.trajectory import Floats, Trajectory


@dataclass(frozen=True, slots=True)
class TrackingSettings:
    """How far the vehicle may be from its plan for the next one to begin in the plan rather than where it was measured; and how it falls back.

    `position` metres, `speed` m/s, `heading` radians: a multiple of what a tracking controller leaves, so that its ripple does not enter the plans.
    `braking` m/s2 of the fallback (firm, still comfortable to people who sit) and `jerk` m/s3 with which it builds up. `step`, `hold`: seconds.
    """

    position: float = 0.3
    speed: float = 0.5
    heading: float = 0.05
    braking: float = 3.0
    jerk: float = 6.0
    step: float = 0.1
    hold: float = 2.0


def expected(plan: Trajectory, elapsed: float) -> EgoState | None:
    """The vehicle after some seconds of a plan; None beyond its end."""
    if not 0.0 <= elapsed <= float(plan.time[-1]) + 1e-9:
        return None
    at = {name: float(np.interp(elapsed, plan.time, getattr(plan, name))) for name in ("x", "y", "heading", "speed", "acceleration", "curvature")}
    return EgoState(at["x"], at["y"], at["heading"], max(at["speed"], 0.0), at["acceleration"], at["curvature"])


def starting_state(ego: EgoState, plan: Trajectory | None, elapsed: float, settings: TrackingSettings) -> EgoState:
    """Where the next plan begins: in the last plan while the vehicle keeps to it, else where it was measured."""
    there = None if plan is None else expected(plan, elapsed)
    if there is None:
        return ego
    near = math.hypot(there.x - ego.x, there.y - ego.y) <= settings.position and abs(there.speed - ego.speed) <= settings.speed
    turned = abs(math.remainder(there.heading - ego.heading, math.tau)) <= settings.heading
    return replace(there, turn_signal=ego.turn_signal) if near and turned else ego


def braking_along(ego: EgoState, plan: Trajectory | None, elapsed: float, settings: TrackingSettings) -> Trajectory:
    """Comfortable braking to a stand along what is left of the last plan's way; without one, along the present curvature.

    The plan's way was free of contacts when it was made, and whoever stops along it uses less of it.
    """
    time, way, speed, acceleration, jerk = _braked(ego.speed, ego.acceleration, settings)
    left = None if plan is None else _rest(plan, elapsed)
    if left is None or starting_state(ego, plan, elapsed, settings) is ego:
        turn = ego.curvature * way
        chord, middle = way * np.sinc(turn / math.tau), ego.heading + turn / 2
        x, y, heading = ego.x + chord * np.cos(middle), ego.y + chord * np.sin(middle), ego.heading + turn
        curvature = np.full_like(way, ego.curvature)
        station, offset = way, np.zeros_like(way)
    else:
        x, y, heading, curvature, station, offset = _along(left, way)
    return Trajectory(time, x, y, heading, speed, acceleration, jerk, curvature, station, offset)


def _braked(speed: float, acceleration: float, settings: TrackingSettings) -> tuple[Floats, Floats, Floats, Floats, Floats]:
    """Time, way, speed, acceleration and jerk of braking that builds up evenly and holds at the end."""
    step = settings.step
    rows: list[tuple[float, float, float, float]] = []
    way, rate, now = 0.0, min(max(acceleration, -settings.braking), 0.0), speed
    while now > 0.0 and len(rows) < 2000:
        rows.append((way, now, rate, 0.0))
        wanted = max(rate - settings.jerk * step, -settings.braking)
        after = max(now + (rate + wanted) / 2 * step, 0.0)
        way, now, rate = way + (now + after) / 2 * step, after, wanted
    rows += [(way, 0.0, 0.0, 0.0)] * (round(settings.hold / step) + 1)
    table = np.array(rows, dtype=np.float64)
    time = np.arange(len(rows), dtype=np.float64) * step
    jerk = np.asarray(np.gradient(table[:, 2], step), dtype=np.float64)
    return time, table[:, 0], table[:, 1], table[:, 2], jerk


def _rest(plan: Trajectory, elapsed: float) -> tuple[Floats, ...] | None:
    """What is left of a plan: way from here, then x, y, heading, curvature, station, offset; None when it stands."""
    last = float(plan.time[-1])
    if elapsed > last:
        return None
    time = np.concatenate(([elapsed], plan.time[plan.time > elapsed + 1e-9]))
    named = [np.interp(time, plan.time, getattr(plan, name)) for name in ("x", "y", "heading", "curvature", "station", "offset")]
    way = np.concatenate(([0.0], np.cumsum(np.hypot(np.diff(named[0]), np.diff(named[1])))))
    moves = np.concatenate(([True], np.diff(way) > 1e-9))
    if moves.sum() < 2:
        return None
    return (way[moves], *(column[moves] for column in named))


def _along(left: tuple[Floats, ...], way: Floats) -> tuple[Floats, Floats, Floats, Floats, Floats, Floats]:
    """Poses after some way along what is left of a plan; beyond its end straight on."""
    known, x, y, heading, curvature, station, offset = left
    beyond = np.maximum(way - known[-1], 0.0)
    found = [np.interp(way, known, column) for column in (x, y, heading, curvature, station, offset)]
    found[0] = found[0] + beyond * math.cos(heading[-1])
    found[1] = found[1] + beyond * math.sin(heading[-1])
    found[3] = np.where(beyond > 0.0, 0.0, found[3])
    found[4] = found[4] + beyond
    return found[0], found[1], found[2], found[3], found[4], found[5]
