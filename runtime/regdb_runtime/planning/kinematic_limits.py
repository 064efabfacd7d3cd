"""Which plans a vehicle can drive and which keep the goal's caps and stop point, with what each of the others fails and by how much."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from regdb_runtime.observation import Footprint
from regdb_runtime.planning.goal import Follow, Goal, SpeedCap, StopPoint
from regdb_runtime.planning.settings import VehicleLimits
from regdb_runtime.trajectory import Candidates, Floats

Flags = NDArray[np.bool_]
REASONS = (
    "speed", "acceleration", "braking", "jerk", "curvature", "curvature_rate", "yaw_rate", "lateral_acceleration",
    "speed_cap", "cap_ahead", "stop", "stop_ahead", "leader", "leader_ahead", "cruise",
)  # fmt: skip
"""In the order in which they are looked at. `cap_ahead`, `stop_ahead`: at the end of the plan it is too late to brake for what comes then.
`leader`: into the rear of who is followed; `cruise`: faster than the goal wants to go."""
_NAMES = np.array(("", *REASONS))
UNITS = {
    "speed": "m/s", "acceleration": "m/s^2", "braking": "m/s^2", "jerk": "m/s^3", "curvature": "1/m", "curvature_rate": "1/(m s)",
    "yaw_rate": "rad/s", "lateral_acceleration": "m/s^2", "speed_cap": "m/s", "cap_ahead": "m/s", "stop": "m", "stop_ahead": "m/s",
    "leader": "m", "leader_ahead": "m/s", "cruise": "m/s",
}  # fmt: skip
ROUNDING = 1e-6
CRUISE_TOLERANCE = 0.05
"""m/s over the cruising speed that pass: it is a wish, no law."""


@dataclass(frozen=True, eq=False)
class Feasibility:
    """For N plans: whether each is `ok`; of the others the first reason (a word of `REASONS`, empty when ok), the value measured and its bound.

    `counts`: plans under each first reason, in the order of `REASONS`. `rules`: of caps and stops, what cites the one that failed (empty else).
    `late`: rules of caps and stops that nothing here could keep, and that were asked only for hard braking or for coming down to them.
    """

    ok: Flags
    counts: dict[str, int]
    first_reason: NDArray[np.str_]
    measured: Floats
    bound: Floats
    rules: tuple[str, ...]
    late: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class _Test:
    """One reason: the value of each plan (n,), and its bound (one, or one for each); `wrong` where it fails."""

    reason: str
    value: Floats
    bound: Floats | float
    wrong: Flags
    rule: str = ""


class Motion:
    """What limits ask of plans, worked out once however many sets of limits they are held against.

    `values`: by reason, what is measured at each instant; `spans`: its greatest and least value among all plans (NaN where one is NaN).
    """

    def __init__(self, plans: Candidates) -> None:
        speed, curvature = plans.speed, plans.curvature
        with np.errstate(invalid="ignore"):  # a plan through the centre of curvature has no finite curvature, and fails by that already
            rate, yaw = np.subtract(curvature[:, 1:], curvature[:, :-1]), np.multiply(speed, curvature)
            aside = np.multiply(yaw, speed)
            self.values = {
                "speed": speed, "acceleration": plans.acceleration, "jerk": plans.jerk, "curvature": curvature, "curvature_rate": rate,
                "yaw_rate": yaw, "lateral_acceleration": aside,
            }  # fmt: skip
            self.spans = {name: (float(item.max()), float(item.min())) for name, item in self.values.items()} if len(plans) else {}

    @cached_property
    def fastest(self) -> Floats:
        """The greatest speed of each plan, (n,)."""
        return np.asarray(self.values["speed"].max(axis=1))


def check(
    candidates: Candidates, limits: VehicleLimits, goal: Goal | None = None, footprint: Footprint | None = None, motion: Motion | None = None
) -> Feasibility:
    """Holds plans against limits, and against the caps and the stop point of a goal at the front bumper.

    All plans start alike. A start beyond a limit is no plan's fault: it may come back within `settle`. No plan that is ok is faster than a
    cap anywhere in its stretch, between instants too, unless the vehicle is so already or the cap is `late`. `motion`: that of the candidates,
    where the caller has it.
    """
    late: list[str] = []
    tests = _tests(candidates, limits, goal, footprint, motion or Motion(candidates), late)
    return _gathered(len(candidates), tests, late)


def keeps(candidates: Candidates, limits: VehicleLimits, goal: Goal | None, footprint: Footprint | None, motion: Motion) -> Flags:
    """Which plans `check` finds ok, without what the others fail."""
    fails = np.zeros(len(candidates), dtype=np.bool_)
    for test in _tests(candidates, limits, goal, footprint, motion, []):
        fails |= test.wrong
    return ~fails


def _tests(
    candidates: Candidates, limits: VehicleLimits, goal: Goal | None, footprint: Footprint | None, motion: Motion, late: list[str]
) -> list[_Test]:
    """Every test that some plan may fail; `late` gets the rules of caps and stops that nothing could keep."""
    tests = [*_motion(candidates, limits, motion)]
    if goal is not None and len(candidates):
        front = (footprint or Footprint()).front
        for cap in goal.caps:
            tests += _cap(candidates, limits, cap, front, late, motion)
        if goal.stop is not None:
            tests += _stop(candidates, limits, goal.stop, front, late)
        if goal.follow is not None:
            tests += _leader(candidates, limits, goal.follow, front)
        tests += _cruise(candidates, limits, goal.cruise_speed, motion)
    return tests


def _gathered(count: int, tests: list[_Test], late: list[str]) -> Feasibility:
    first = np.full(count, -1)
    measured, bound = np.full(count, np.nan), np.full(count, np.nan)
    rules = [""] * count
    for test in sorted(tests, key=lambda item: REASONS.index(item.reason)):
        new = test.wrong & (first < 0)
        if new.any():
            first[new] = REASONS.index(test.reason)
            measured[new], bound[new] = test.value[new], np.broadcast_to(test.bound, (count,))[new]
            for index in np.flatnonzero(new).tolist() if test.rule else ():
                rules[index] = test.rule
    found = np.bincount(first + 1, minlength=len(REASONS) + 1).tolist()
    counts = {reason: number for reason, number in zip(REASONS, found[1:], strict=True) if number}
    return Feasibility(first < 0, counts, _NAMES[first + 1], measured, bound, tuple(rules), tuple(late))


def _motion(plans: Candidates, limits: VehicleLimits, motion: Motion) -> Iterator[_Test]:
    """The vehicle's own limits. Only what some plan breaks is looked at plan by plan."""
    step = float(plans.time[1] - plans.time[0])
    settled = int(np.searchsorted(plans.time, limits.settle - 1e-9))
    rate = limits.curvature_rate * step
    yield from _beyond("speed", motion, "speed", 0.0, limits.speed, settled)
    yield from _beyond("acceleration", motion, "acceleration", -np.inf, limits.acceleration, settled)
    yield from _beyond("braking", motion, "acceleration", -limits.braking, np.inf, settled)
    yield from _beyond("jerk", motion, "jerk", -limits.jerk, limits.jerk, 0)
    yield from _beyond("curvature", motion, "curvature", -limits.curvature, limits.curvature, settled)
    with np.errstate(invalid="ignore"):
        yield from _beyond("curvature_rate", motion, "curvature_rate", -rate, rate, 0, 1 / step)
        yield from _beyond("yaw_rate", motion, "yaw_rate", -limits.yaw_rate, limits.yaw_rate, settled)
        aside = limits.lateral_acceleration
        yield from _beyond("lateral_acceleration", motion, "lateral_acceleration", -aside, aside, settled)


def _beyond(
    reason: str, motion: Motion, name: str, least: float, greatest: float, settled: int, unit: float = 1.0
) -> Iterator[_Test]:
    """Tests of rows against either bound, none where all keep it; NaN keeps none."""
    if not motion.spans:
        return
    highest, lowest = motion.spans[name]
    if not highest <= greatest + ROUNDING:
        yield _tested(reason, motion.values[name], greatest, settled, unit, 1)
    if not lowest >= least - ROUNDING:
        yield _tested(reason, motion.values[name], -least, settled, unit, -1)


def _tested(reason: str, values: Floats, limit: float, settled: int, unit: float, sign: int) -> _Test:
    """Worst of each row against a limit. Where the common start is beyond, rows may stay so, not worse, until they have settled."""
    start = sign * float(values[0, 0]) if settled else 0.0
    if start <= limit:
        worst = _worst(values, sign)
        return _Test(reason, worst * unit, limit * unit, ~(worst <= limit + ROUNDING))
    early, later = _worst(values[:, :settled], sign), _worst(values[:, settled:], sign)
    grew = early > start + ROUNDING
    return _Test(reason, np.where(grew, early, later) * unit, np.where(grew, start, limit) * unit, grew | ~(later <= limit + ROUNDING))


def _worst(values: Floats, sign: int) -> Floats:
    return np.asarray(values.max(axis=1) if sign > 0 else -values.min(axis=1))


def _cap(plans: Candidates, limits: VehicleLimits, cap: SpeedCap, front: float, late: list[str], motion: Motion) -> Iterator[_Test]:
    """No faster than the cap from the instant before the front bumper enters to the instant after it leaves; and in time for it at the end."""
    enter, leave = cap.start - front, cap.end - front
    begin, speed = float(plans.station[0, 0]), float(plans.speed[0, 0])
    if begin >= leave:
        return
    if motion.spans["speed"][0] <= cap.speed + ROUNDING:
        return
    rows = np.flatnonzero(motion.fastest > cap.speed + ROUNDING)
    surplus, left = speed * speed - cap.speed * cap.speed, enter - begin
    braking, excused = limits.recovery, surplus > 0 and left <= 0
    if surplus > 0 and left > 0 and surplus > 2 * limits.late * left:
        braking, excused = limits.late, True
    bound = np.full(len(plans.time), cap.speed)
    if excused:
        late.append(cap.rule)
        bound = np.maximum(bound, _coming_down(plans, limits, braking))
    station, fast = plans.station[rows], plans.speed[rows]
    within = station < leave
    within[:, :-1] &= station[:, 1:] > enter
    within[:, -1] &= station[:, -1] > enter
    excess = np.where(within, fast - bound, -np.inf)
    at = excess.argmax(axis=1)
    each = np.arange(len(rows))
    yield _spread("speed_cap", len(plans), rows, fast[each, at], bound[at], excess[each, at] > ROUNDING, cap.rule)
    if not excused:
        reach = np.sqrt(cap.speed**2 + 2 * limits.braking * np.maximum(enter - station[:, -1], 0.0))
        yield _spread("cap_ahead", len(plans), rows, fast[:, -1], reach, (station[:, -1] < enter) & (fast[:, -1] > reach + ROUNDING), cap.rule)


def _coming_down(plans: Candidates, limits: VehicleLimits, braking: float) -> Floats:
    """Speed (t,) of who brakes from the start on after `settle`, having first taken back what acceleration it had."""
    speed, acceleration = float(plans.speed[0, 0]), max(float(plans.acceleration[0, 0]), 0.0)
    rise = acceleration * limits.settle / 2 + acceleration * acceleration / (2 * limits.jerk)
    return np.asarray(speed + rise - braking * np.maximum(plans.time - limits.settle, 0.0))


def _cruise(plans: Candidates, limits: VehicleLimits, wanted: float, motion: Motion) -> Iterator[_Test]:
    """No faster than the goal wants, or coming down to it."""
    most = wanted + CRUISE_TOLERANCE
    if motion.spans["speed"][0] <= most:
        return
    bound = np.full(len(plans.time), most)
    if float(plans.speed[0, 0]) > most:
        bound = np.maximum(bound, _coming_down(plans, limits, limits.recovery))
    at = (plans.speed - bound).argmax(axis=1)
    value = plans.speed[np.arange(len(plans)), at]
    yield _Test("cruise", value, bound[at], value > bound[at] + ROUNDING)


def _leader(plans: Candidates, limits: VehicleLimits, leader: Follow, front: float) -> Iterator[_Test]:
    """The front bumper behind the leader's rear, who goes on as now or brakes to a stand; and able to stay so at the end.

    Nothing is asked where they already stand side by side.
    """
    if leader.rear_station <= float(plans.station[0, 0]) + front:
        return
    slowing = min(leader.acceleration, 0.0)
    braked = np.minimum(plans.time, leader.speed / -slowing) if slowing < 0 else plans.time
    rear = leader.rear_station + leader.speed * braked + slowing * braked * braked / 2 - front
    gap = rear - plans.station
    least = gap.min(axis=1)
    yield _Test("leader", least, 0.0, least < -ROUNDING)
    speed = leader.speed + slowing * float(braked[-1])
    reach = speed + np.sqrt(2 * limits.braking * np.maximum(gap[:, -1], 0.0))
    yield _Test("leader_ahead", plans.speed[:, -1], reach, plans.speed[:, -1] > reach + ROUNDING)


def _spread(reason: str, count: int, rows: NDArray[np.intp], value: Floats, bound: Floats, wrong: Flags, rule: str) -> _Test:
    """A test of some rows as one of all."""
    values, bounds, flags = np.zeros(count), np.zeros(count), np.zeros(count, dtype=bool)
    values[rows], bounds[rows], flags[rows] = value, bound, wrong
    return _Test(reason, values, bounds, flags, rule)


def _stop(plans: Candidates, limits: VehicleLimits, stop: StopPoint, front: float, late: list[str]) -> Iterator[_Test]:
    """The front bumper never beyond the stop point, and able to stop before it at the end; past it or too late, all that can be done."""
    line = stop.station - front
    begin, speed = float(plans.station[0, 0]), float(plans.speed[0, 0])
    end, last = plans.station[:, -1], plans.speed[:, -1]
    left = line - begin
    if left < -ROUNDING or speed * speed > 2 * limits.late * max(left, 0.0) + ROUNDING:
        late.append(stop.rule)
        way = speed * limits.settle + speed * speed / (2 * min(limits.late, limits.braking / 2))
        yield _Test("stop", end + front, begin + front + way, (end > begin + way + ROUNDING) | (last > ROUNDING), stop.rule)
        return
    yield _Test("stop", end + front, stop.station, end > line + ROUNDING, stop.rule)
    reach = np.sqrt(2 * limits.braking * np.maximum(line - end, 0.0))
    yield _Test("stop_ahead", last, reach, (end <= line + ROUNDING) & (last > reach + ROUNDING), stop.rule)
