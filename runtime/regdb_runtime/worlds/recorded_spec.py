"""A drive on a recorded street as one frozen value that can be written to JSON and driven again: file, route, ego, lights, what the eye sees."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from typing import Literal

from regdb_runtime.observation import Footprint
from regdb_runtime.worlds.plain_form import from_plain, to_plain
from regdb_runtime.worlds.scene_spec import EyeSpec

LightPlan = Literal["none", "red", "green", "nominal"]
"""What the lights show: nothing that is seen; a cycle of ours that is red, or green, for the route's approach first; the file's own plan, of which
nobody says that it was what the recorded drivers saw."""


@dataclass(frozen=True)
class LightsSpec:
    """The scripted cycle: seconds of each colour for the route's axis. Traffic of the crossing axis has the rest of the cycle.

    Durations of ours: long enough to stop, look and turn on red, and to be asked what green says.
    """

    plan: LightPlan = "red"
    red: float = 40.0
    green: float = 25.0
    yellow: float = 4.0


@dataclass(frozen=True)
class RecordedSpec:
    """A drive among recorded traffic.

    `file`: a CommonRoad file. `route`: lanes, one for each segment. `station`: of the rear axle on the route's centre line (metres); `speed` m/s.
    `begins`: the instant of the recording at which the run begins. `vehicle`: the recorded vehicle that the ego takes the place of: it drives as
    recorded and `route` may be empty; without one the planner's ego is added to the traffic. `place`: who governs, where the map does not say.
    """

    name: str
    file: str
    route: tuple[str, ...] = ()
    station: float = 5.0
    speed: float = 10.0
    begins: float = 0.0
    vehicle: str = ""
    place: str = "model"
    start: str = "2026-03-04T12:00:00"
    lights: LightsSpec = field(default_factory=LightsSpec)
    eye: EyeSpec = field(default_factory=EyeSpec)
    footprint: Footprint = field(default_factory=Footprint)
    sensor_range: float = 200.0
    lights_range: float = 120.0

    def to_json(self) -> str:
        """As indented JSON; `from_json` gives an equal value."""
        return json.dumps(to_plain(self), indent=1) + "\n"

    @staticmethod
    def from_json(text: str) -> RecordedSpec:
        """From `to_json`'s text. Raises WorldError for a field that is not there or of the wrong form."""
        return from_plain(RecordedSpec, json.loads(text), "recorded scene")
