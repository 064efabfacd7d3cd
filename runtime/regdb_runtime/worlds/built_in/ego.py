"""The ego's motion: a kinematic bicycle at the rear axle that follows its plan by feed-forward and small feedback, within its actuators."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from regdb_runtime.observation import EgoState, Footprint, TurnSignal
from regdb_runtime.planning.trajectory import Floats, Trajectory


@dataclass(frozen=True, slots=True)
class EgoSettings:
    """Actuators and feedback. Accelerations m/s^2, `steering` rad at the front wheels, `steering_rate` rad/s, `step` s.

    A mid-size car on dry asphalt: 8 m/s^2 braking, 35 degrees of lock. Gains: per metre along and across, per radian, per m/s.
    """

    brake: float = 8.0
    accelerate: float = 4.0
    steering: float = 0.61
    steering_rate: float = 0.9
    along_gain: float = 0.8
    speed_gain: float = 1.6
    across_gain: float = 0.10
    heading_gain: float = 0.55
    standing_below: float = 0.01
    step: float = 0.02


def move_ego(state: EgoState, plan: Trajectory, signal: TurnSignal, duration: float, footprint: Footprint, settings: EgoSettings) -> EgoState:
    """Where the ego is after `duration` seconds of a plan that begins now; it stands at the plan's end when the plan is shorter."""
    count = max(1, round(duration / settings.step))
    step = duration / count
    times = np.arange(1, count + 1, dtype=np.float64) * step
    wanted = _wanted(plan, times)
    most_bend = math.tan(settings.steering) / footprint.wheelbase
    x, y, heading, speed, acceleration, curvature = state.x, state.y, state.heading, state.speed, state.acceleration, state.curvature
    for target_x, target_y, target_heading, target_speed, target_acceleration, target_curvature in wanted:
        # Feedback compares the state predicted for the end of this step under the plan's own inputs with the plan's state there.
        ahead_x = x + speed * step * math.cos(heading) - target_x
        ahead_y = y + speed * step * math.sin(heading) - target_y
        cos, sin = math.cos(target_heading), math.sin(target_heading)
        along, across = cos * ahead_x + sin * ahead_y, cos * ahead_y - sin * ahead_x
        turned = math.remainder(heading + speed * curvature * step - target_heading, 2 * math.pi)
        slower = target_speed - speed - acceleration * step
        pull = target_acceleration + settings.speed_gain * slower - settings.along_gain * along
        pull = min(max(pull, -settings.brake), settings.accelerate)
        bend = target_curvature - settings.across_gain * across - settings.heading_gain * turned
        bend = _steer(curvature, min(max(bend, -most_bend), most_bend), footprint.wheelbase, settings.steering_rate * step)
        x, y, heading, speed, acceleration, curvature = _advance(x, y, heading, speed, acceleration, curvature, pull, bend, step)
        if target_speed < settings.standing_below and speed < 2 * settings.standing_below:
            speed, acceleration = 0.0, 0.0
    return EgoState(x, y, math.remainder(heading, 2 * math.pi), speed, acceleration, curvature, signal)


def _wanted(plan: Trajectory, times: Floats) -> list[tuple[float, ...]]:
    """The plan at these times: x, y, heading, speed, acceleration, curvature; standing beyond its end."""
    ended = times > plan.time[-1] + 1e-9
    rows = [np.interp(times, plan.time, row) for row in (plan.x, plan.y, np.unwrap(plan.heading), plan.speed, plan.acceleration, plan.curvature)]
    rows[3] = np.where(ended, 0.0, rows[3])
    rows[4] = np.where(ended, 0.0, rows[4])
    return list(zip(*(row.tolist() for row in rows), strict=True))


def _steer(curvature: float, wanted: float, wheelbase: float, most: float) -> float:
    """The curvature the front wheels can turn to in one step."""
    angle, target = math.atan(curvature * wheelbase), math.atan(wanted * wheelbase)
    return math.tan(angle + min(max(target - angle, -most), most)) / wheelbase


def _advance(
    x: float, y: float, heading: float, speed: float, acceleration: float, curvature: float, pull: float, bend: float, step: float
) -> tuple[float, float, float, float, float, float]:
    """One step under linearly changing acceleration and curvature; the vehicle stops rather than roll back."""
    mean_pull, mean_bend = (acceleration + pull) / 2, (curvature + bend) / 2
    after = speed + mean_pull * step
    if after <= 0.0:
        after, pull = 0.0, 0.0
        travelled = min(speed * step, speed * speed / (-2 * mean_pull)) if mean_pull < 0.0 else 0.0
    else:
        travelled = (speed + after) / 2 * step
    turn = travelled * mean_bend
    middle = heading + turn / 2
    return x + travelled * math.cos(middle), y + travelled * math.sin(middle), heading + turn, after, pull, bend
