"""The closed set of facts about the last seconds and metres, from observations and map alone: the same in a planner and in an audit."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

from regdb.vocabulary import Value
from regdb_runtime.maps.lane_path import Junction, LanePath
from regdb_runtime.maps.road_map import RoadMap
from regdb_runtime.observation import Observation, TurnSignal
from regdb_runtime.scenes.around import Around
from regdb_runtime.scenes.crossing import Arriving, Crossings
from regdb_runtime.scenes.lane_facts import lane_kind
from regdb_runtime.scenes.pieces import Band
from regdb_runtime.scenes.settings import SceneSettings


@dataclass(frozen=True, slots=True)
class Arrivals:
    """When the vehicle reached the junction (None: not yet), and those on other highways who are still there; seconds since the run began."""

    own: float | None = None
    others: tuple[tuple[str, float], ...] = ()
    now: float = 0.0


@dataclass(frozen=True, slots=True)
class Past:
    """All that is remembered. Distances in metres, times in seconds.

    `place`: of the rear axle at the last update. `signal`: given without a break over `signalled_distance` and `signalled_time`.
    `line`: id of the junction whose line is ahead or was crossed; `stopped` before it, `crossed` it, or
    `overran` it and came to a stand before the junction. `rails`: id of the rail crossing,
    likewise, `rail_gap` where the vehicle stopped. `bus`: stopped for the school bus. `turn_lane`: the two-way left-turn lane driven in.
    """

    time: float = 0.0
    place: tuple[float, float] | None = None
    signal: TurnSignal = "off"
    signalled_distance: float = 0.0
    signalled_time: float = 0.0
    line: str | None = None
    stopped: bool = False
    crossed: bool = False
    overran: bool = False
    rails: str | None = None
    stopped_at_rails: bool = False
    rail_gap: float | None = None
    bus: bool = False
    turn_lane: bool = False
    turn_lane_distance: float = 0.0
    turn_lane_time: float = 0.0
    arrivals: Arrivals = Arrivals()


@dataclass(frozen=True, slots=True)
class RailAhead:
    """The next rail crossing on the path: its id and the station of its nearest rail."""

    id: str
    station: float


CrossingsOfMap = Callable[[LanePath, Junction], Crossings | None]
RailsOfMap = Callable[[LanePath, float], RailAhead | None]
OnPath = Callable[[Observation, LanePath], Around]
"""Where a map's ways through the junction ahead, its rails, and the vehicle's own place on a path are looked up."""


class History:
    """Remembers what facts of history need. `update` once per observation, in order; `facts` answers for the last one."""

    def __init__(self, road_map: RoadMap, settings: SceneSettings, crossings: CrossingsOfMap, rails: RailsOfMap, on_path: OnPath) -> None:
        self._road_map, self._settings = road_map, settings
        self._crossings, self._rails, self._on_path = crossings, rails, on_path
        self.past = Past()

    def update(self, observation: Observation, lane_path: LanePath, junction: Junction | None = None) -> None:
        """Take in one observation. `lane_path`: where the vehicle drives now; `junction`: the one it is in, else the next one on that path."""
        ego, past = observation.ego, self.past
        here = self._on_path(observation, lane_path)
        front = here.front
        moved = 0.0 if past.place is None else math.hypot(ego.x - past.place[0], ego.y - past.place[1])
        passed = 0.0 if past.place is None else observation.time - past.time
        past = replace(past, time=observation.time, place=(ego.x, ego.y))
        past = _signalled(past, ego.turn_signal, moved, passed)
        past = self._at_line(past, observation, junction, front)
        past = self._at_rails(past, observation, self._rails(lane_path, here.rear), front)
        past = _for_bus(past, observation, self._settings.standstill)
        past = self._in_turn_lane(past, lane_path.lane_at((here.front + here.rear) / 2).lane, moved, passed)
        self.past = self._arrived(past, observation, lane_path, junction, front)

    def facts(self) -> dict[str, Value]:
        """The facts of history after the last update. Where the vehicle never stopped there is no distance of its stop."""
        past = self.past
        own, others = past.arrivals.own, past.arrivals.others
        facts: dict[str, Value] = {
            "ego.stopped_at_line": past.stopped and not past.crossed,
            "ego.stopped_at_rails": past.stopped_at_rails,
            "ego.stopped_for_bus": past.bus,
            "ego.signalled_distance": past.signalled_distance,
            "ego.signalled_time": past.signalled_time,
            "ego.distance_in_turn_lane": past.turn_lane_distance,
            "ego.time_in_turn_lane": past.turn_lane_time,
            "ego.arrived_first": own is not None and all(time > own for _, time in others),
        }
        if past.rail_gap is not None:
            facts["ego.rail_stop_distance"] = past.rail_gap
        return facts

    def _at_line(self, past: Past, observation: Observation, junction: Junction | None, front: float) -> Past:
        if junction is None:
            return replace(past, line=None, stopped=False, crossed=False, overran=False)
        if junction.id != past.line:
            past = replace(past, line=junction.id, stopped=False, crossed=False, overran=False)
        stands = observation.ego.speed < self._settings.standstill
        before = junction.stop_station - front
        if before < -self._settings.overshoot:
            # Who first comes to a stand past the line but short of the junction still faces what controls it, and has not stopped at the line.
            overran = past.overran or (stands and front < junction.entrance and not past.stopped)
            return replace(past, overran=overran, crossed=front >= junction.entrance or not overran)
        stopped = past.stopped or (stands and before <= self._settings.at_line)
        return replace(past, stopped=stopped, crossed=False, overran=False)

    def _at_rails(self, past: Past, observation: Observation, rail: RailAhead | None, front: float) -> Past:
        if rail is None or rail.id != past.rails:
            past = replace(past, rails=None if rail is None else rail.id, stopped_at_rails=False, rail_gap=None)
        if rail is None:
            return past
        gap = rail.station - front
        if gap < 0.0:
            return replace(past, stopped_at_rails=False, rail_gap=None)
        if observation.ego.speed < self._settings.standstill and gap <= self._settings.at_rails:
            return replace(past, stopped_at_rails=True, rail_gap=gap)
        return past

    def _in_turn_lane(self, past: Past, lane: str, moved: float, passed: float) -> Past:
        if lane_kind(self._road_map.lanes[lane]) != "two_way_left_turn":
            return replace(past, turn_lane=False, turn_lane_distance=0.0, turn_lane_time=0.0)
        if not past.turn_lane:
            return replace(past, turn_lane=True, turn_lane_distance=0.0, turn_lane_time=0.0)
        return replace(past, turn_lane_distance=past.turn_lane_distance + moved, turn_lane_time=past.turn_lane_time + passed)

    def _arrived(self, past: Past, observation: Observation, lane_path: LanePath, junction: Junction | None, front: float) -> Past:
        """Arrival times of the vehicle and of those on other highways; who has left the meeting place behind is forgotten."""
        if junction is None:
            return replace(past, arrivals=Arrivals(now=observation.time))
        before = past.arrivals if junction.id == self.past.line else Arrivals()
        own = before.own
        if own is None and junction.stop_station - front <= self._settings.at_line:
            own = observation.time
        known = dict(before.others)
        if junction.stop_station - front > self._settings.watched:
            return replace(past, arrivals=Arrivals(own, (), observation.time))
        crossings = self._crossings(lane_path, junction)
        there = () if crossings is None else crossings.arriving(observation.tracks)
        others = {item.track.id: known.get(item.track.id, observation.time) for item in there if _has_arrived(item, self._settings.at_line)}
        return replace(past, arrivals=Arrivals(own, tuple(sorted(others.items())), observation.time))


def _has_arrived(item: Arriving, at_line: float) -> bool:
    return item.way.comes_from != "oncoming" and item.to_entrance - item.way.line <= at_line


def _signalled(past: Past, signal: TurnSignal, moved: float, passed: float) -> Past:
    """A signal to one side counts from when it is given; what was driven before the first observation of it does not."""
    if signal not in ("left", "right"):
        return replace(past, signal=signal, signalled_distance=0.0, signalled_time=0.0)
    if signal != past.signal:
        return replace(past, signal=signal, signalled_distance=0.0, signalled_time=0.0)
    return replace(past, signalled_distance=past.signalled_distance + moved, signalled_time=past.signalled_time + passed)


def _for_bus(past: Past, observation: Observation, standstill: float) -> Past:
    """Stopped before the bus, and its red signal still flashes."""
    facts: Mapping[str, Value] = observation.facts
    flashes = facts.get("school_bus.ahead") is True and facts.get("school_bus.red_flashing") is True
    return replace(past, bus=flashes and (past.bus or observation.ego.speed < standstill))


def first_rail(bands: Sequence[tuple[float, float, Band]], rear: float) -> RailAhead | None:
    """The first rail crossing on a path that the rear bumper has not left behind; `bands`: stations on the path, in order."""
    return next((RailAhead(band.id, start) for start, end, band in bands if end > rear), None)
