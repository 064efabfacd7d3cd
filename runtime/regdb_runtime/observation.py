"""What the vehicle knows at one instant: itself, the road users around it, the lights, and what perception reports; no map, no law."""

from __future__ import annotations

import datetime
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from regdb.vocabulary import Value

TurnSignal = Literal["off", "left", "right", "hazard"]
TrackKind = Literal["car", "truck", "bus", "motorcycle", "bicycle", "pedestrian", "animal", "obstacle"]
Provenance = Literal["live", "recorded", "scripted", "none"]
"""Where the facts of perception came from; a run carries it everywhere it is shown."""
Color = Literal["red", "yellow", "green", "dark", "unknown"]
Shape = Literal["circular", "left_arrow", "right_arrow", "straight_arrow", "u_arrow"]


@dataclass(frozen=True, slots=True)
class Footprint:
    """The vehicle's rectangle and its rear axle, in metres. Defaults: a mid-size car."""

    length: float = 4.8
    width: float = 1.8
    wheelbase: float = 2.8
    rear_overhang: float = 0.95

    @property
    def front(self) -> float:
        """From the rear axle to the front bumper."""
        return self.length - self.rear_overhang

    @property
    def center(self) -> float:
        """From the rear axle to the middle of the rectangle."""
        return self.length / 2 - self.rear_overhang


@dataclass(frozen=True, slots=True)
class EgoState:
    """The vehicle: (x, y) is the middle of its rear axle; metres, radians anticlockwise from +x, SI. Speed is not negative."""

    x: float
    y: float
    heading: float
    speed: float
    acceleration: float = 0.0
    curvature: float = 0.0
    turn_signal: TurnSignal = "off"

    def box_center(self, footprint: Footprint) -> tuple[float, float]:
        """The middle of the rectangle."""
        return self.x + footprint.center * math.cos(self.heading), self.y + footprint.center * math.sin(self.heading)

    def front_bumper(self, footprint: Footprint) -> tuple[float, float]:
        """The middle of the front bumper."""
        return self.x + footprint.front * math.cos(self.heading), self.y + footprint.front * math.sin(self.heading)


@dataclass(frozen=True, slots=True)
class Track:
    """One road user: (x, y) is the middle of its rectangle; rider and handlebars of a bicycle lie within it.

    `turn_signal` None: not seen. `warning_lights` in the words of the fact stationary_hazard_vehicle.lights.
    """

    id: str
    kind: TrackKind
    x: float
    y: float
    heading: float
    speed: float
    length: float
    width: float
    acceleration: float = 0.0
    yaw_rate: float = 0.0
    turn_signal: TurnSignal | None = None
    warning_lights: str = "none"
    hazard_kind: str = "none"


@dataclass(frozen=True, slots=True)
class Indication:
    """What one lens of a light shows."""

    color: Color
    shape: Shape = "circular"
    flashing: bool = False


@dataclass(frozen=True)
class Observation:
    """All that enters the planner at one instant.

    `time`: seconds since the run began (injected; nothing here reads a clock). `clock`: local date and time of day. `signals`: id of a
    light on the map -> what it shows; a light left out is not seen, its colour unknown. `facts`: what perception (the eye) reports now,
    in the vocabulary's words and SI; a fact left out is unknown. `silent`: facts and sources that report nothing (see `regdb.situation`).
    """

    time: float
    clock: datetime.datetime
    ego: EgoState
    tracks: tuple[Track, ...] = ()
    signals: Mapping[str, tuple[Indication, ...]] = field(default_factory=dict)
    facts: Mapping[str, Value] = field(default_factory=dict)
    silent: frozenset[str] = frozenset()
    provenance: Provenance = "none"
