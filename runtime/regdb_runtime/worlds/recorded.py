"""The recorded world: traffic replayed from a CommonRoad file, and an ego in it, driven by a planner or itself one of those recorded.

Nobody in a recording reacts to the ego, and whoever leaves the recording leaves the scene. The lights' phases are not in such files (their cycles
are nominal plans), so what a light shows here is scripted, or not seen at all; a log says which.
"""

from __future__ import annotations

import datetime
import math
from dataclasses import replace

import numpy as np

from regdb.situation import quiet_facts
from regdb.vocabulary import Value, Vocabulary
from regdb_runtime.errors import WorldError
from regdb_runtime.maps.commonroad import open_scenario, road_map_of
from regdb_runtime.maps.commonroad_traffic import traffic_of
from regdb_runtime.maps.lane_path import path_along
from regdb_runtime.maps.reference_path import ReferencePath
from regdb_runtime.maps.road_map import RoadMap
from regdb_runtime.observation import EgoState, Footprint, Observation, Track, TurnSignal
from regdb_runtime.scenes.tellers import surveyed_facts
from regdb_runtime.trajectory import Trajectory
from regdb_runtime.worlds.built_in.contacts import find_contacts
from regdb_runtime.worlds.built_in.ego import EgoSettings, move_ego
from regdb_runtime.worlds.built_in.signals import Signals
from regdb_runtime.worlds.eye import build_eye
from regdb_runtime.worlds.light_script import scripted_lights
from regdb_runtime.worlds.recorded_spec import RecordedSpec
from regdb_runtime.worlds.replay import Motion, Replay

REAR_OVERHANG, WHEELBASE = 0.198, 0.583
"""Shares of a vehicle's length: those of `Footprint`'s mid-size car, for vehicles of which only the rectangle was recorded."""

NEVER_SCRIPTED = frozenset((
    "intersection.control", "signal.present", "signal.place", "sign.stop", "sign.yield", "sign.all_way", "stop_line.present",
))  # fmt: skip
"""What controls a junction: where the map leaves it out it is not absent."""


class RecordedWorld:
    """A recording with an ego in it. The same spec and plans give the same bytes. Raises MapError, NoRoute and WorldError."""

    def __init__(self, spec: RecordedSpec, vocabulary: Vocabulary, ego_settings: EgoSettings | None = None) -> None:
        root = open_scenario(spec.file)
        self.spec, self.replay = spec, Replay(traffic_of(root))
        self._driven = self._recorded_ego(spec)
        self._route = spec.route
        told = completed(road_map_of(root), spec.place, vocabulary, scripted=spec.eye.kind == "scripted")
        self._map = scripted_lights(told, spec.lights, self._route)
        self._footprint = spec.footprint if self._driven is None else footprint_of(self._driven)
        self._signals = Signals(self._map) if spec.lights.plan != "none" else None
        self._ego_settings = ego_settings or EgoSettings()
        self._start = _read_start(spec.start)
        self.eye = build_eye(spec.eye, vocabulary)
        self.time = 0.0
        self.ego = self._first_ego() if self._driven is None else ego_of(self._driven.at(spec.begins), self._footprint)

    @property
    def road_map(self) -> RoadMap:
        return self._map

    @property
    def footprint(self) -> Footprint:
        return self._footprint

    @property
    def route(self) -> tuple[str, ...]:
        return self._route

    @property
    def ended(self) -> bool:
        """Whether the recording is over for whom the ego is: the recorded vehicle it is, else for everybody."""
        now = self.spec.begins + self.time
        return now > (self.replay.ends if self._driven is None else self._driven.ends) + 1e-6

    def observe(self) -> Observation:
        """What is seen now: recorded road users within the sensors' range, scripted lights that face the ego, and what the eye reports."""
        ego, reach = self.ego, self.spec.sensor_range
        x, y = ego.box_center(self._footprint)
        tracks = self.replay.tracks(self.spec.begins + self.time, self.spec.vehicle)
        near = tuple(track for track in tracks if math.hypot(track.x - x, track.y - y) <= reach)
        facts, silent = self.eye.look(self.time, ego)
        clock = self._start + datetime.timedelta(microseconds=round(self.time * 1e6))
        lights = self._signals.seen(self.time, ego, self.spec.lights_range) if self._signals is not None else {}
        return Observation(self.time, clock, ego, near, lights, facts, silent, self.eye.provenance)

    def step(self, plan: Trajectory, turn_signal: TurnSignal, duration: float) -> None:
        """Move on by `duration` seconds. A recorded ego goes where it went, whatever the plan says."""
        self.time = round(self.time + duration, 9)
        if self._driven is None:
            self.ego = move_ego(self.ego, plan, turn_signal, duration, self._footprint, self._ego_settings)
        else:
            self.ego = ego_of(self._driven.at(self.spec.begins + self.time), self._footprint)

    def close(self) -> None:
        """Nothing to free."""

    def _recorded_ego(self, spec: RecordedSpec) -> Motion | None:
        if not spec.vehicle:
            if not spec.route:
                raise WorldError("a drive among recorded traffic needs a route, or the recorded vehicle whose place the ego takes")
            return None
        found = self.replay.motions.get(spec.vehicle)
        if found is None:
            raise WorldError(f"{spec.file} records no vehicle {spec.vehicle!r}; there are: {', '.join(self.replay.motions)}")
        if not found.is_there(spec.begins):
            raise WorldError(f"vehicle {spec.vehicle} is recorded from {found.begins:g} to {found.ends:g} s, not at {spec.begins:g} s")
        return found

    def _first_ego(self) -> EgoState:
        path = path_along(self._map, self._route).path
        if not path.start <= self.spec.station <= path.end:
            raise WorldError(f"the route is {path.length:.1f} m long; {self.spec.station:g} m is not on it")
        ego = ego_at(path, self.spec.station, self.spec.speed)
        touched = find_contacts(0.0, ego, self._footprint, self.replay.tracks(self.spec.begins))
        if touched:
            raise WorldError(f"at {self.spec.station:g} m of the route stands vehicle {touched[0].other}; begin elsewhere, or at another time")
        return ego


def ego_at(path: ReferencePath, station: float, speed: float) -> EgoState:
    """A vehicle in the middle of a path."""
    at = np.array([station])
    x, y = path.to_plane(at, 0.0)[0].tolist()
    return EgoState(x, y, math.remainder(float(path.heading(at)[0]), math.tau), speed, 0.0, float(path.curvature(at)[0]))


def footprint_of(motion: Motion) -> Footprint:
    """The rectangle of a recorded vehicle, its axles where those of a car of that length are."""
    length = motion.obstacle.length
    return Footprint(length, motion.obstacle.width, WHEELBASE * length, REAR_OVERHANG * length)


def ego_of(track: Track, footprint: Footprint) -> EgoState:
    """A recorded vehicle as an ego: the middle of its rear axle."""
    cos, sin = math.cos(track.heading), math.sin(track.heading)
    bend = track.yaw_rate / track.speed if track.speed > 0.5 else 0.0
    return EgoState(
        track.x - footprint.center * cos, track.y - footprint.center * sin, track.heading, track.speed, track.acceleration, bend,
        track.turn_signal or "off",
    )  # fmt: skip


def completed(road_map: RoadMap, place: str, vocabulary: Vocabulary, *, scripted: bool) -> RoadMap:
    """The map with who governs. A script also says what such files never say (districts, rails, school zones): nothing unusual."""
    facts = uneventful(vocabulary) if scripted else {}
    return replace(road_map, jurisdiction=road_map.jurisdiction or place, facts={**facts, **road_map.facts})


def uneventful(vocabulary: Vocabulary) -> dict[str, Value]:
    """What a surveyed map says where there is nothing unusual, in the vocabulary's quiet values, less what is never taken for granted."""
    quiet = {name: value for name, value in quiet_facts(vocabulary).items() if vocabulary.facts[name].source == "map"}
    return {name: value for name, value in {**quiet, **surveyed_facts(vocabulary)}.items() if name not in NEVER_SCRIPTED}


def _read_start(text: str) -> datetime.datetime:
    try:
        return datetime.datetime.fromisoformat(text)
    except ValueError:
        raise WorldError(f"start: {text!r} is no date and time; write it as 2026-03-04T12:00:00") from None
