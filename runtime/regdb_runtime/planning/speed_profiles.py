"""Motions along the path: every way of changing speed that is worth trying, each laid on so that it slows in time for what lies ahead."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from regdb_runtime.planning.gates import Ahead, Gate, ahead
from regdb_runtime.planning.goal import Goal
from regdb_runtime.planning.polynomials import Chains, Floats, change_speed, change_time, change_way, quintic
from regdb_runtime.planning.settings import LatticeSettings
from regdb_runtime.trajectory import STANDING, FrenetState

SAME_SPEED = 1e-6
REVERSE = -1e-4
"""m/s under which a motion goes backwards; above, it is rounding."""
QUINTIC_PEAKS = (5.7736, 60.0)
"""Greatest acceleration and jerk of the quintic from rest to rest over 1 m in 1 s."""
AT_STOP = 0.02
"""Metres beyond where it should stand at which a motion is left out, while others keep it."""
SQUEEZE = 1.02
"""By how much a later braking may surpass the nominal one before its profile is left out: the way straight to the gate is among them."""


@dataclass(frozen=True, eq=False)
class _Firsts:
    """First pieces: coefficients (n, 6), durations and end speeds (n,), and which may be left out for braking too late (n,)."""

    pieces: Floats
    durations: Floats
    end_speeds: Floats
    free: NDArray[np.bool_]

    @classmethod
    def to_keep(cls, pieces: Floats, durations: Floats, end_speeds: Floats) -> _Firsts:
        """Such as are needed however late they brake afterwards."""
        return cls(pieces, durations, end_speeds, np.zeros(len(durations), dtype=bool))


def speed_profiles(
    start: FrenetState, goal: Goal, front: float, settings: LatticeSettings, time: Floats
) -> tuple[Floats, Floats, Floats]:
    """Station, speed and acceleration along the path (p, t) of every motion; none goes backwards.

    All start in the start state; those that pass where they should stand are left out unless all do. `front`: from the rear axle to the
    front bumper, metres.
    """
    if start.s_dot <= STANDING and start.s_ddot < 0.0:
        start = replace(start, s_ddot=0.0)  # brakes that hold a standing vehicle accelerate nothing
    view = ahead(start, goal, front, settings)
    firsts = [_changes(start, goal, view, settings), *_as_braking(start)]
    if not view.hold:
        firsts += [*_to_gates(start, view), *_to_stop(start, view, settings), *_behind(start, goal, view, front, settings)]
    each = ([getattr(first, name) for first in firsts] for name in ("pieces", "durations", "end_speeds", "free"))
    chains = _laid_on(_Firsts(*(np.concatenate(values) for values in each)), start.s, view.gates, settings)
    station, speed, acceleration = chains.at(time)
    kept = speed.min(axis=1) >= REVERSE
    short = kept & (station[:, -1] <= min((gate.station for gate in view.gates if gate.speed <= 0.0), default=np.inf) + AT_STOP)
    kept = short if short.any() else kept
    return station[kept], np.maximum(speed[kept], 0.0), acceleration[kept]


def _changes(start: FrenetState, goal: Goal, view: Ahead, settings: LatticeSettings) -> _Firsts:
    """Changes to each end speed with each intensity; braking ones also hard."""
    speed, acceleration = start.s_dot, start.s_ddot
    targets = np.array(_targets(start, goal, view, settings))[:, None]
    gain = targets - speed
    gentle = _durations(gain, acceleration, np.array(settings.intensities), settings.gentle_jerk, settings.shortest)
    hard = _durations(gain, acceleration, np.array(settings.hard), settings.hard_jerk, settings.shortest)
    hard[gain[:, 0] >= 0.0] = np.nan
    durations = np.sort(np.concatenate((gentle, hard), axis=1), axis=1)  # NaN last
    new = np.isfinite(durations)
    new[:, 1:] &= np.diff(durations, axis=1) != 0.0
    if abs(acceleration) < SAME_SPEED:
        durations[np.abs(gain[:, 0]) < SAME_SPEED, 0] = settings.horizon
        new[np.abs(gain[:, 0]) < SAME_SPEED, 1:] = False
    ends, durations = np.broadcast_to(targets, new.shape)[new], durations[new]
    return _Firsts(change_speed(speed, acceleration, ends, durations), durations, ends, np.ones(len(ends), dtype=bool))


def _as_braking(start: FrenetState) -> list[_Firsts]:
    """To a stand with the present braking, where that is so near that nothing smoother comes to a stand without going backwards."""
    if start.s_ddot >= -SAME_SPEED or start.s_dot > -start.s_ddot:
        return []
    durations = np.array([start.s_dot / -start.s_ddot])
    return [_Firsts.to_keep(np.array([[0.0, start.s_dot, start.s_ddot / 2, 0.0, 0.0, 0.0]]), durations, np.zeros(1))]


def _targets(start: FrenetState, goal: Goal, view: Ahead, settings: LatticeSettings) -> list[float]:
    """End speeds, lowest first: even ones to the highest, those of the gates, the present one, the leader's."""
    if view.hold:
        return [0.0]
    found = [*np.linspace(0.0, view.top, settings.speeds).tolist(), *(gate.speed for gate in view.gates)]
    found += [start.s_dot] if start.s_dot <= view.top else []
    found += [goal.follow.speed] if goal.follow is not None and goal.follow.speed <= view.top else []
    kept: list[float] = []
    for speed in sorted(found):
        if not kept or speed > kept[-1] + SAME_SPEED:
            kept.append(speed)
    return kept


def _durations(gain: Floats, acceleration: float, peaks: Floats, jerk: float, shortest: float) -> Floats:
    """Of changes of speed by `gain` (n, 1) that keep about within peaks of acceleration (k,) and of jerk, without overshooting: (n, k).

    Already accelerating towards the end speed, the longest that does not overshoot with even jerk is 2 gain / acceleration.
    """
    size = np.abs(gain)
    plain = np.maximum(1.5 * size / peaks, np.maximum(np.sqrt(6 * size / jerk), shortest))
    if abs(acceleration) < SAME_SPEED:
        return plain
    towards = np.maximum(np.minimum(plain, 2 * gain / acceleration), 0.1)
    return np.asarray(np.where(acceleration * gain > 0, towards, np.maximum(plain, 4 * abs(acceleration) / jerk)))


def _to_gates(start: FrenetState, view: Ahead) -> list[_Firsts]:
    """Straight to each gate: its speed is reached there and nowhere before."""
    gates = [gate for gate in view.gates if gate.speed < start.s_dot - SAME_SPEED]
    if not gates:
        return []
    speeds, ways = np.array([gate.speed for gate in gates]), np.array([gate.station - start.s for gate in gates])
    times = change_time(ways, start.s_dot, start.s_ddot, speeds)
    found = np.isfinite(times)
    pieces = change_speed(start.s_dot, start.s_ddot, speeds[found], times[found])
    return [_Firsts.to_keep(pieces, times[found], speeds[found])]


def _to_stop(start: FrenetState, view: Ahead, settings: LatticeSettings) -> list[_Firsts]:
    """Quintics to the stop point, shorter and longer than the plainest way; from a stand, as gently as intensities say."""
    if view.stop is None or view.stop - start.s < 2 * SAME_SPEED:
        return []
    way = view.stop - start.s
    plain = float(change_time(way, start.s_dot, start.s_ddot, 0.0))
    if start.s_dot > 1.0 and np.isfinite(plain):
        times = plain * np.array(settings.stop_stretches)
    else:
        peaks = np.array(settings.intensities)
        times = np.maximum(np.sqrt(QUINTIC_PEAKS[0] * way / peaks), np.cbrt(QUINTIC_PEAKS[1] * way / settings.gentle_jerk))
    pieces = quintic((0.0, start.s_dot, start.s_ddot), (way, 0.0, 0.0), times)
    return [_Firsts.to_keep(pieces, times, np.zeros_like(times))]


def _behind(start: FrenetState, goal: Goal, view: Ahead, front: float, settings: LatticeSettings) -> list[_Firsts]:
    """To the time gap behind a leader who goes on: the change of speed that closes up exactly, and quintics in fixed times."""
    leader = goal.follow
    if leader is None or leader.speed <= settings.standing:
        return []
    speed = min(leader.speed, view.top)
    way = leader.rear_station - front - settings.standstill_gap - settings.headway * leader.speed - start.s
    times = np.array(settings.follow_times)
    moved = way + leader.speed * times
    found = [_Firsts.to_keep(quintic((0.0, start.s_dot, start.s_ddot), (moved, speed, 0.0), times), times, np.full_like(times, speed))]
    closing = float(change_time(way, start.s_dot - leader.speed, start.s_ddot, 0.0)) if start.s_dot > leader.speed else np.nan
    if np.isfinite(closing):
        pieces = change_speed(start.s_dot, start.s_ddot, [leader.speed], [closing])
        found.append(_Firsts.to_keep(pieces, np.array([closing]), np.array([leader.speed])))
    return found


def _laid_on(first: _Firsts, station: float, gates: tuple[Gate, ...], settings: LatticeSettings) -> Chains:
    """First pieces, then for each gate: hold the speed, brake as nominal to reach the gate's speed at the gate; at last hold."""
    pieces = first.pieces.copy()
    pieces[:, 0] += station
    time, speed = first.durations.copy(), first.end_speeds.copy()
    way = station + _value(first.pieces, first.durations)
    keep = np.ones(len(time), dtype=bool)
    starts, chain = [np.zeros_like(time), time.copy()], [pieces, _held(way, speed)]
    for gate in gates:
        slows = speed > gate.speed + SAME_SPEED
        left = gate.station - way
        gain = np.where(slows, speed - gate.speed, 0.0)
        nominal = np.maximum(1.5 * gain / settings.nominal, np.sqrt(6 * gain / settings.gentle_jerk))
        mean = np.maximum((speed + gate.speed) / 2, SAME_SPEED)
        held = np.where(slows, left - nominal * mean, 0.0)
        squeezed = slows & (left < nominal * mean / SQUEEZE)
        keep &= ~(squeezed & first.free)
        duration = np.maximum(np.where(held < 0, np.maximum(left, 0.1) / mean, nominal), 0.1)
        begin = time + np.where(slows, np.maximum(held, 0.0) / np.maximum(speed, SAME_SPEED), 0.0)
        braking = change_speed(speed, 0.0, np.where(slows, gate.speed, speed), duration)
        braking[:, 0] += np.where(slows, np.maximum(way, gate.station - duration * mean), way)
        end = begin + np.where(slows, duration, 0.0)
        way = np.where(slows, braking[:, 0] + change_way(duration, speed, 0.0, gate.speed), way)
        speed, time = np.where(slows, gate.speed, speed), end
        starts += [begin, end]
        chain += [braking, _held(way, speed)]
    return Chains(np.stack(starts, axis=1)[keep], np.stack(chain, axis=1)[keep])


def _held(station: Floats, speed: Floats) -> Floats:
    pieces = np.zeros((len(station), 6))
    pieces[:, 0], pieces[:, 1] = station, speed
    return pieces


def _value(pieces: Floats, time: Floats) -> Floats:
    c = pieces.T
    return np.asarray(c[0] + time * (c[1] + time * (c[2] + time * (c[3] + time * (c[4] + time * c[5])))))
