"""Numbers of the sampler and of what a vehicle can do and its passengers like, with units and why."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class LatticeSettings:
    """What is sampled. SI.

    `horizon`, `step`: seconds looked ahead and between points; 5 s holds a comfortable change of 10 mph, and what lies farther (a stop from
    35 mph takes 13 s) binds through profiles that are laid to it and seen for their first 5 s.
    `speeds`: number of end speeds from 0 to the highest, besides the caps, the present speed and the leader's.
    `intensities`: greatest acceleration of the gentle changes of speed, m/s^2; `nominal` is that of braking to a cap or stop ahead, a tenth
    under the comfortable 2 m/s^2, so that the next plan has room. `hard`: of the braking kept ready for what comes late.
    `gentle_jerk`, `hard_jerk`: of the gentle changes, m/s^3, a tenth under the comfortable 4.13, and of the hard.
    `shortest`: least duration of a change, s.
    `stop_stretches`: durations of further ways to a stop point, by that of the plainest one; shorter ones would put the braking off.
    `margin_braking`: m/s^2 over which a stop gives up its margin before the line rather than brake harder.
    `lateral_times`: shortest and longest time of a change of offset, s; `slowest`: speed (m/s) under which its length no longer shrinks.
    `lateral_grid`: metres; changes of offset end at multiples of a whole number of these, so that the next plan finds the same end again.
    `cap_distance`, `cap_speed`: metres before a boundary, and m/s under a cap, that are aimed at.
    `headway`, `standstill_gap`: seconds and metres behind a leader; the latter
    more than the 3 m of the emergency check, which drawing up to a queue must not rouse.
    `standing`: m/s under which, within the slack of a stop point, the vehicle stays where it is.
    """

    horizon: float = 5.0
    step: float = 0.1
    speeds: int = 6
    intensities: tuple[float, ...] = (0.6, 1.0, 1.4, 1.8)
    nominal: float = 1.8
    hard: tuple[float, ...] = (3.0, 5.0, 7.5)
    gentle_jerk: float = 3.7
    hard_jerk: float = 20.0
    shortest: float = 0.5
    stop_stretches: tuple[float, ...] = (1.06, 1.15)
    margin_braking: float = 2.5
    follow_times: tuple[float, ...] = (2.0, 3.0, 4.0, 5.0, 7.0)
    lateral_times: tuple[float, float] = (1.0, 6.5)
    slowest: float = 4.0
    lateral_grid: float = 5.0
    cap_distance: float = 2.0
    cap_speed: float = 0.1
    headway: float = 1.5
    standstill_gap: float = 4.0
    standing: float = 0.1

    @property
    def points(self) -> int:
        """Instants of a plan, the first now."""
        return round(self.horizon / self.step) + 1


@dataclass(frozen=True, slots=True)
class VehicleLimits:
    """What a plan may ask. SI. The defaults are what a mid-size car on a dry road can do and its steering can follow.

    `speed` 50 m/s; `acceleration` 4 (engine) and `braking` 8 m/s^2 (tyres); `jerk` 25 m/s^3: full brake pressure builds up in 0.3 s;
    `curvature` 0.2 1/m: 5 m at the rear axle, the turning circle; `curvature_rate` 0.4 1/m per second: 0.65 rad/s of steering at 2.8 m of
    wheelbase, as CommonRoad's vehicle 2 (BMW 320i) at 0.4 rad/s doubled for standing changes; `yaw_rate` 1.0 rad/s;
    `lateral_acceleration` 6 m/s^2: tyres with reserve for braking.
    `settle`: seconds in which a start beyond a limit may come back within it; `recovery`: braking, m/s^2, with which a speed already over a
    cap must come down. `late`: braking, m/s^2, that counts as all that can be done for a cap or a stop seen too late; infinite: there is no
    such excuse under these limits.
    """

    speed: float = 50.0
    acceleration: float = 4.0
    braking: float = 8.0
    jerk: float = 25.0
    curvature: float = 0.2
    curvature_rate: float = 0.4
    yaw_rate: float = 1.0
    lateral_acceleration: float = 6.0
    settle: float = 0.5
    recovery: float = 1.0
    late: float = 5.0

    @classmethod
    def comfortable(cls) -> VehicleLimits:
        """Normal driving: 2 m/s^2 and 4.13 m/s^3 along the path (the bounds of the speed figure), 2.5 m/s^2 aside."""
        return cls(acceleration=2.0, braking=2.0, jerk=4.13, lateral_acceleration=2.5, yaw_rate=0.7, late=math.inf)
