"""From a scene's description of a road user to the one that moves, or stands, in the world."""

from __future__ import annotations

import math
import random

from regdb_runtime.errors import WorldError
from regdb_runtime.maps.road_map import RoadMap
from regdb_runtime.observation import Track, TrackKind
from regdb_runtime.planning.idm import IdmParameters
from regdb_runtime.worlds.built_in.lane_tables import LaneTables
from regdb_runtime.worlds.built_in.mover import Mover, TrafficSettings, scattered
from regdb_runtime.worlds.road_builder import follow_turns
from regdb_runtime.worlds.scene_spec import CyclistSpec, ParkedSpec, VehicleSpec

CYCLIST = IdmParameters(desired_speed=4.5, headway=1.0, jam_distance=1.0, acceleration=0.8, braking=1.5)
"""A cyclist pulls away more gently than a car and keeps closer."""


def driver(kind: TrackKind, chance: random.Random) -> IdmParameters:
    """A driver of ordinary temper: headways of 1.2-1.7 s; cars gain 1.6 m/s^2 as in city driving, lorries 0.9."""
    return IdmParameters(headway=chance.uniform(1.2, 1.7), acceleration=0.9 if kind in ("truck", "bus") else 1.6, braking=1.8)


def vehicle(spec: VehicleSpec, road_map: RoadMap, tables: LaneTables, settings: TrafficSettings, chance: random.Random) -> Mover:
    """A driven vehicle. Raises WorldError for a lane or turn that is not there."""
    route = follow_turns(road_map, spec.lane, spec.turns)
    _check_station(spec.id, spec.lane, spec.station, tables)
    found = Mover(spec.id, spec.kind, spec.length, spec.width, route, tables, spec.station, spec.speed, driver(spec.kind, chance))
    found.scattered = scattered(chance, settings)
    found.wish, found.speeds, found.enters = spec.wish, spec.speeds, spec.enters
    found.warning_lights, found.hazard_kind = spec.warning_lights, spec.hazard_kind
    return found


def cyclist(spec: CyclistSpec, road_map: RoadMap, tables: LaneTables) -> Mover:
    """A cyclist near the right-hand edge of a lane. Raises WorldError for a lane or turn that is not there."""
    route = follow_turns(road_map, spec.lane, spec.turns)
    _check_station(spec.id, spec.lane, spec.station, tables)
    found = Mover(spec.id, "bicycle", spec.length, spec.width, route, tables, spec.station, spec.speed, CYCLIST)
    found.wish, found.enters, found.leaves_at, found.weave = spec.speed, spec.enters, spec.leaves_at, spec.weave
    found.offset = found.resting_offset = -tables[spec.lane].half_width + spec.from_edge + spec.width / 2
    return found


def parked_track(spec: ParkedSpec, tables: LaneTables) -> Track:
    """Something that stands. Raises WorldError for a lane that is not there."""
    _check_station(spec.id, spec.lane, spec.station, tables)
    x, y, heading = tables[spec.lane].pose(spec.station, spec.offset)
    return Track(
        spec.id, spec.kind, x, y, math.remainder(heading, 2 * math.pi), 0.0, spec.length, spec.width,
        turn_signal="hazard" if spec.warning_lights == "hazard_lights" else None, warning_lights=spec.warning_lights, hazard_kind=spec.hazard_kind,
    )  # fmt: skip


def _check_station(name: str, lane: str, station: float, tables: LaneTables) -> None:
    if lane not in tables:
        raise WorldError(f"{name}: there is no lane {lane!r}")
    if not 0.0 <= station <= tables[lane].length:
        raise WorldError(f"{name}: lane {lane!r} is {tables[lane].length:.1f} m long; {station:g} m is not on it")
