"""The built-in world: streets, the ego on them, and everybody else, moved on step by step from a scene's description."""

from __future__ import annotations

import datetime
import math
import random
from dataclasses import replace

from regdb.vocabulary import Vocabulary
from regdb_runtime.errors import WorldError
from regdb_runtime.maps.road_map import RoadMap
from regdb_runtime.observation import EgoState, Footprint, Observation, Track, TurnSignal
from regdb_runtime.planning.trajectory import Trajectory
from regdb_runtime.worlds.built_in.contacts import Contact, find_contacts
from regdb_runtime.worlds.built_in.ego import EgoSettings, move_ego
from regdb_runtime.worlds.built_in.flows import Flow
from regdb_runtime.worlds.built_in.lane_tables import LaneTables
from regdb_runtime.worlds.built_in.mover import TrafficSettings
from regdb_runtime.worlds.built_in.participants import cyclist, parked_track, vehicle
from regdb_runtime.worlds.built_in.people import Pedestrian
from regdb_runtime.worlds.built_in.signals import Signals
from regdb_runtime.worlds.built_in.traffic import EgoAhead, Traffic, TrafficModel
from regdb_runtime.worlds.eye import Eye, build_eye
from regdb_runtime.worlds.road_builder import build_road_map, follow_turns
from regdb_runtime.worlds.scene_spec import SceneSpec


class BuiltInWorld:
    """A running scene. The same spec and the same plans give the same bytes; nothing reads a clock or an unseeded number.

    `contacts`: first touches of the ego with others, in order. Raises WorldError for a spec that does not fit together.
    """

    def __init__(
        self, spec: SceneSpec, vocabulary: Vocabulary, eye: Eye | None = None,
        ego_settings: EgoSettings | None = None, traffic_settings: TrafficSettings | None = None,
    ) -> None:  # fmt: skip
        self.spec = spec
        self._map = build_road_map(spec.streets, vocabulary)
        self._tables = LaneTables(self._map)
        self._ego_settings = ego_settings or EgoSettings()
        self._settings = traffic_settings or TrafficSettings()
        self._route = follow_turns(self._map, spec.ego.lane, spec.ego.turns)
        self._start = _read_start(spec.start)
        self._signals = Signals(self._map)
        self.eye = eye or build_eye(spec.eye, vocabulary)
        self.time = 0.0
        self._now: tuple[Track, ...] | None = None
        self.ego = self._first_ego()
        self.contacts: list[Contact] = []
        self._touched: set[str] = set()
        self._ego_since: float | None = None
        self._people = [Pedestrian(item) for item in spec.pedestrians]
        self._parked = [parked_track(item, self._tables) for item in spec.parked]
        self._traffic: TrafficModel = Traffic(self._tables, self._signals, self._settings)
        for track in self._parked:
            self._traffic.add_standing(track)
        self._add_movers()
        self._flows = [Flow(item, spec.seed, self._map, self._tables, self._settings) for item in spec.flows]
        _check_names(spec)

    @property
    def road_map(self) -> RoadMap:
        return self._map

    @property
    def footprint(self) -> Footprint:
        return self.spec.ego.footprint

    @property
    def route(self) -> tuple[str, ...]:
        return self._route

    @property
    def signals(self) -> Signals:
        """The lights' truth, whether seen or not."""
        return self._signals

    def tracks(self) -> tuple[Track, ...]:
        """Everybody but the ego, near and far."""
        if self._now is None:
            self._now = (*self._traffic.tracks(self.time), *(person.track() for person in self._people), *self._parked)
        return self._now

    def observe(self) -> Observation:
        """What is seen now: road users within the sensors' range, lights that face the ego, and what the eye reports."""
        ego, reach = self.ego, self.spec.sensor_range
        x, y = ego.box_center(self.footprint)
        near = tuple(track for track in self.tracks() if math.hypot(track.x - x, track.y - y) <= reach)
        facts, silent = self.eye.look(self.time, ego)
        clock = self._start + datetime.timedelta(microseconds=round(self.time * 1e6))
        lights = self._signals.seen(self.time, ego, self.spec.lights_range)
        return Observation(self.time, clock, ego, near, lights, facts, silent, self.eye.provenance)

    def step(self, plan: Trajectory, turn_signal: TurnSignal, duration: float) -> None:
        """Move on by `duration` seconds: everybody decides on what is now, the ego follows the plan."""
        begin, count = self.time, max(1, round(duration / self._settings.step))
        part = duration / count
        for index in range(count):
            self._step(_later(plan, index * part), turn_signal, part, round(begin + (index + 1) * part, 9))

    def close(self) -> None:
        """Nothing to free."""

    def _step(self, plan: Trajectory, turn_signal: TurnSignal, duration: float, after: float) -> None:
        for flow in self._flows:
            flow.step(self.time, self._traffic)
        self._traffic.step(self.time, duration, self.ego, self.footprint, self._ego_ahead(), self._people)
        self._walk(duration)
        self.ego = move_ego(self.ego, plan, turn_signal, duration, self.footprint, self._ego_settings)
        self.time, self._now = after, None
        self._note_contacts()

    def _walk(self, duration: float) -> None:
        if not self._people:
            return
        x, y = self.ego.box_center(self.footprint)
        own = Track("", "car", x, y, self.ego.heading, self.ego.speed, self.footprint.length, self.footprint.width)
        others = (*self._traffic.tracks(self.time), *self._parked, own)
        for person in self._people:
            person.step(self.time, duration, self.ego.front_bumper(self.footprint), others)

    def _note_contacts(self) -> None:
        found = find_contacts(self.time, self.ego, self.footprint, self.tracks())
        self.contacts.extend(item for item in found if item.other not in self._touched)
        self._touched.update(item.other for item in found)

    def _first_ego(self) -> EgoState:
        ego = self.spec.ego
        table = self._tables[ego.lane]
        if not 0.0 <= ego.station <= table.length:
            raise WorldError(f"the ego's lane {ego.lane!r} is {table.length:.1f} m long; {ego.station:g} m is not on it")
        x, y, heading = table.pose(ego.station, ego.offset)
        return EgoState(x, y, math.remainder(heading, 2 * math.pi), ego.speed, 0.0, table.bend(ego.station))

    def _add_movers(self) -> None:
        chance = random.Random(f"{self.spec.seed} drivers")
        for item in self.spec.vehicles:
            self._traffic.movers.append(vehicle(item, self._map, self._tables, self._settings, chance))
        for rider in self.spec.cyclists:
            self._traffic.movers.append(cyclist(rider, self._map, self._tables))

    def _ego_ahead(self) -> EgoAhead:
        """The ego's next junction lane, how far its front is from it, and since when it has been waiting there."""
        x, y = self.ego.front_bumper(self.footprint)
        for name in self._route:
            table = self._tables[name]
            if table.inner:
                ahead = (table.x[0] - x) * math.cos(table.heading[0]) + (table.y[0] - y) * math.sin(table.heading[0])
                if 0.0 < ahead < 80.0 and math.hypot(table.x[0] - x, table.y[0] - y) < 80.0:
                    if ahead > 12.0:
                        self._ego_since = None
                    elif self._ego_since is None and self.ego.speed <= 0.3:  # and kept while it moves off: it came when it came
                        self._ego_since = self.time
                    return EgoAhead(name, ahead, self._ego_since)
        self._ego_since = None
        return EgoAhead(None, math.inf, None)


def _later(plan: Trajectory, shift: float) -> Trajectory:
    """The same plan as seen `shift` seconds on."""
    return plan if shift == 0.0 else replace(plan, time=plan.time - shift)


def _read_start(text: str) -> datetime.datetime:
    try:
        return datetime.datetime.fromisoformat(text)
    except ValueError:
        raise WorldError(f"start: {text!r} is no date and time; write it as 2026-03-04T12:00:00") from None


def _check_names(spec: SceneSpec) -> None:
    groups = (spec.vehicles, spec.cyclists, spec.pedestrians, spec.parked)
    names = [item.id for group in groups for item in group]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise WorldError(f"two road users are called {twice[0]!r}")
