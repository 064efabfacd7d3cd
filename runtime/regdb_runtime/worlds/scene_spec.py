"""A whole scene as one frozen value that can be written to JSON, shrunk and replayed: streets, ego, road users, what the eye would see."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from regdb_runtime.maps.road_map import Turn
from regdb_runtime.observation import Footprint, TrackKind
from regdb_runtime.worlds.plain_form import from_plain, to_plain
from regdb_runtime.worlds.road_spec import StreetsSpec


@dataclass(frozen=True)
class EgoSpec:
    """The ego: its lane, the station of its rear axle on it (metres), speed (m/s), and how its route turns at each junction in order.

    After the last of `turns` the route goes straight on (else the first way that offers itself) to the end of the map. `offset` metres left
    of the lane's middle.
    """

    lane: str
    station: float = 10.0
    speed: float = 0.0
    turns: tuple[Turn, ...] = ()
    offset: float = 0.0
    footprint: Footprint = field(default_factory=Footprint)


@dataclass(frozen=True)
class VehicleSpec:
    """A driven vehicle: where its middle begins, how fast, what speed it would like (None: scattered around the limit as people's are).

    `speeds`: (time, wish) pairs from which on the wish changes, for leads that brake or stop. `enters`: seconds after the start at which it
    appears. `warning_lights`, `hazard_kind` as in `Track`.
    """

    id: str
    lane: str
    station: float
    speed: float = 0.0
    wish: float | None = None
    speeds: tuple[tuple[float, float], ...] = ()
    turns: tuple[Turn, ...] = ()
    kind: TrackKind = "car"
    length: float = 4.6
    width: float = 1.8
    enters: float = 0.0
    warning_lights: str = "none"
    hazard_kind: str = "none"


@dataclass(frozen=True)
class FlowSpec:
    """Vehicles that keep coming at the beginning of a lane, `per_hour` of them at random times; `turns_weights`: right, straight, left."""

    id: str
    lane: str
    per_hour: float = 300.0
    start: float = 0.0
    until: float = 1e9
    trucks: float = 0.05
    turn_weights: tuple[float, float, float] = (0.2, 0.65, 0.15)


@dataclass(frozen=True)
class CyclistSpec:
    """A cyclist along the right-hand edge of a lane, at constant speed unless something is in the way.

    `from_edge`: from the lane's right-hand edge to the near side of the box; `weave`: amplitude (m) of a slow sway; `leaves_at`: station of
    its first lane at which it turns off the road, None to ride on.
    """

    id: str
    lane: str
    station: float
    speed: float = 4.5
    from_edge: float = 0.1
    weave: float = 0.0
    width: float = 0.6
    length: float = 1.8
    turns: tuple[Turn, ...] = ()
    enters: float = 0.0
    leaves_at: float | None = None


@dataclass(frozen=True)
class PedestrianSpec:
    """A pedestrian who stands at the path's first point, walks it from a time on or once the ego is near, and stands at its end.

    `when_near`: metres between ego's front and the path's first point, None: the time alone counts. `back_and_forth`: walks it for ever.
    """

    id: str
    path: tuple[tuple[float, float], ...]
    speed: float = 1.3
    starts: float = 0.0
    when_near: float | None = None
    back_and_forth: bool = False
    size: float = 0.5


@dataclass(frozen=True)
class ParkedSpec:
    """A vehicle or thing that stands: `offset` metres left of the lane's middle (negative: to the right)."""

    id: str
    lane: str
    station: float
    offset: float
    kind: TrackKind = "car"
    length: float = 4.6
    width: float = 1.8
    warning_lights: str = "none"
    hazard_kind: str = "none"


@dataclass(frozen=True)
class SightingSpec:
    """What is there to be seen: facts as people write them, true while the ego is within `range` metres of `position` or inside `area`
    (everywhere without both), from a time to another."""

    facts: Mapping[str, object]
    position: tuple[float, float] | None = None
    range: float = 100.0
    area: tuple[tuple[float, float], ...] = ()
    start: float = 0.0
    until: float = 1e9


@dataclass(frozen=True)
class EyeSpec:
    """What stands in for the vision-language model: `scripted` tells what is there, `none` nothing; `recorded` replays a JSONL file.

    `attends`: facts a scripted eye reports on; empty: all that are the eye's to tell. `misses`: those it never reports.
    """

    kind: Literal["scripted", "recorded", "none"] = "scripted"
    sightings: tuple[SightingSpec, ...] = ()
    attends: tuple[str, ...] = ()
    misses: tuple[str, ...] = ()
    record: str = ""


@dataclass(frozen=True)
class SceneSpec:
    """A scene: everything a built-in world is made of. `start`: local date and time, ISO. `seed` rules flows and people's scatter."""

    name: str
    streets: StreetsSpec
    ego: EgoSpec
    start: str = "2026-03-04T12:00:00"
    seed: int = 0
    vehicles: tuple[VehicleSpec, ...] = ()
    flows: tuple[FlowSpec, ...] = ()
    cyclists: tuple[CyclistSpec, ...] = ()
    pedestrians: tuple[PedestrianSpec, ...] = ()
    parked: tuple[ParkedSpec, ...] = ()
    eye: EyeSpec = field(default_factory=EyeSpec)
    sensor_range: float = 200.0
    lights_range: float = 120.0

    def to_json(self) -> str:
        """As indented JSON; `from_json` gives an equal scene."""
        return json.dumps(to_plain(self), indent=1) + "\n"

    @staticmethod
    def from_json(text: str) -> SceneSpec:
        """A scene from `to_json`'s text. Raises WorldError for a field that is not there or of the wrong form."""
        return from_plain(SceneSpec, json.loads(text), "scene")
