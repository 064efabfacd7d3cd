"""What lies ahead of a plan: stations to be reached no faster than a speed, made of the goal's caps, its stop point and who is followed."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from regdb_runtime.planning.goal import Goal
from regdb_runtime.planning.polynomials import change_time
from regdb_runtime.planning.settings import LatticeSettings
from regdb_runtime.trajectory import STANDING, FrenetState

SHAPE = 0.75
"""Way of a change of speed without acceleration at its ends, by its greatest acceleration: `SHAPE * (v^2 - w^2) / a`."""
PAST_LINE = 0.05
"""Metres before a stop point that are kept even when the margin cannot be."""
BRAKING_LEADER = -0.3
"""m/s^2: whoever brakes harder than this is taken to brake to a stand."""


@dataclass(frozen=True, slots=True)
class Gate:
    """Not faster than `speed` at `station` (of the rear axle) and beyond; 0 stands there."""

    station: float
    speed: float


@dataclass(frozen=True, slots=True)
class Ahead:
    """The highest speed now, the gates ahead (each slower than the one before), and whether only stopping is left.

    `stop`: station (of the rear axle) aimed at by the goal's stop point, None without or when it is passed.
    """

    top: float
    gates: tuple[Gate, ...]
    stop: float | None
    hold: bool


def ahead(start: FrenetState, goal: Goal, front: float, settings: LatticeSettings) -> Ahead:
    """What the goal asks, for a vehicle whose front bumper is `front` metres before its rear axle."""
    bumper = start.s + front
    top, found = goal.cruise_speed, []
    for cap in goal.caps:
        aim = max(cap.speed - settings.cap_speed, 0.0)
        if cap.start - settings.cap_distance <= bumper < cap.end:
            top = min(top, aim)
        elif cap.start > bumper and cap.end > cap.start:
            found.append(Gate(cap.start - settings.cap_distance - front, aim))
    stop, hold = _stop(start, goal, front, settings)
    if stop is not None:
        found.append(Gate(stop, 0.0))
    leader = _leaders_stop(goal, front, settings)
    if leader is not None:
        found.append(Gate(leader, 0.0))
        hold = hold or (leader <= start.s and start.s_dot <= settings.standing)
    return Ahead(max(top, 0.0), _binding(found, top, settings), stop, hold)


def _stop(start: FrenetState, goal: Goal, front: float, settings: LatticeSettings) -> tuple[float | None, bool]:
    """Where to stand, and whether nothing but standing is left: past the line, or standing well enough before it."""
    if goal.stop is None:
        return None, False
    left = goal.stop.station - start.s - front
    if left < 0.0 or (left <= goal.stop.slack and start.s_dot <= settings.standing):
        return None, True
    way = left - goal.stop.margin
    if way <= 0.0 or _braking(start, way) > settings.margin_braking:
        way = left - PAST_LINE
    return start.s + max(way, 0.0), False


def _braking(start: FrenetState, way: float) -> float:
    """Greatest braking of the change of speed that comes to a stand after a way; infinite where there is none."""
    if start.s_dot <= STANDING:
        return 0.0
    duration = float(change_time(way, start.s_dot, start.s_ddot, 0.0))
    if not math.isfinite(duration):
        return -start.s_ddot if start.s_ddot < 0.0 else math.inf
    mean = start.s_dot / duration
    part = np.linspace(0.0, 1.0, 11)
    return float(np.max(6 * (mean + start.s_ddot / 2) * part * (1 - part) - start.s_ddot * (1 - part)))


def _leaders_stop(goal: Goal, front: float, settings: LatticeSettings) -> float | None:
    """Where to stand behind a leader who stands or brakes to a stand; None behind one who goes on."""
    leader = goal.follow
    if leader is None or (leader.speed > settings.standing and leader.acceleration > BRAKING_LEADER):
        return None
    braking = leader.speed**2 / (2 * max(-leader.acceleration, -BRAKING_LEADER))
    return leader.rear_station + braking - settings.standstill_gap - front


def _binding(found: list[Gate], top: float, settings: LatticeSettings) -> tuple[Gate, ...]:
    """Those slower than all before them, each no faster than the next can be reached from with nominal braking."""
    kept: list[Gate] = []
    for gate in sorted(found, key=lambda item: (item.station, item.speed)):
        if gate.speed < (kept[-1].speed if kept else top) - 1e-9:
            kept.append(gate)
    for index in range(len(kept) - 2, -1, -1):
        following = kept[index + 1]
        reach = math.sqrt(following.speed**2 + (following.station - kept[index].station) * settings.nominal / SHAPE)
        kept[index] = Gate(kept[index].station, min(kept[index].speed, reach))
    return tuple(kept)
