"""SUMO's terms and ours: angles, places, turn signals, kinds; a vehicle's position is the middle of its front bumper there."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from regdb_runtime.observation import Track, TrackKind, TurnSignal

ANYWHERE = 2
"""`keepRoute` of moveToXY: put the vehicle exactly there, on the road or off it."""
ALONG_ROUTE = 1
"""The same: put the vehicle on the nearest lane of its route, as far across as it is."""
RIGHT_BLINKER, LEFT_BLINKER, HAZARD = 1, 2, 4
"""Bits of a vehicle's signals."""
KINDS: Mapping[str, TrackKind] = {
    "bicycle": "bicycle", "moped": "motorcycle", "motorcycle": "motorcycle", "bus": "bus", "coach": "bus", "truck": "truck", "trailer": "truck",
    "delivery": "truck", "pedestrian": "pedestrian",
}  # fmt: skip
"""Vehicle classes; the rest are cars."""


def heading_of(angle: float) -> float:
    """Degrees clockwise from north as radians anticlockwise from east."""
    return math.remainder(math.radians(90.0 - angle), math.tau)


def angle_of(heading: float) -> float:
    """Radians anticlockwise from east as degrees clockwise from north."""
    return 90.0 - math.degrees(heading)


def signal_of(bits: int) -> TurnSignal:
    """What the blinkers show."""
    if bits & HAZARD:
        return "hazard"
    return "right" if bits & RIGHT_BLINKER else "left" if bits & LEFT_BLINKER else "off"


def bits_of(signal: TurnSignal) -> int:
    """The blinkers for a turn signal."""
    return {"off": 0, "right": RIGHT_BLINKER, "left": LEFT_BLINKER, "hazard": HAZARD}[signal]


def track_of(
    vehicles: Any, name: str, kind: TrackKind, size: tuple[float, float], yaw_rate: float = 0.0, lights: tuple[str, str] = ("none", "none")
) -> Track:
    """A vehicle as the ego's sensors see it. `vehicles`: libsumo's or TraCI's vehicle domain; `size`: length and width, metres."""
    (x, y), heading = vehicles.getPosition(name), heading_of(vehicles.getAngle(name))
    length, width = size
    return Track(
        name, kind, x - length / 2 * math.cos(heading), y - length / 2 * math.sin(heading), heading, vehicles.getSpeed(name), length, width,
        vehicles.getAcceleration(name), yaw_rate, "off" if kind == "bicycle" else signal_of(vehicles.getSignals(name)), *lights,
    )  # fmt: skip


def move(vehicles: Any, name: str, front: tuple[float, float], heading: float, speed: float) -> None:
    """Put a vehicle exactly there, at this speed."""
    vehicles.moveToXY(name, "", -1, front[0], front[1], angle_of(heading), ANYWHERE)
    vehicles.setSpeed(name, speed)
