"""From a manoeuvre and an observation to the stretches of its path: who governs, what the law knows there, and the roles of everybody around."""

from __future__ import annotations

import datetime
from collections.abc import Mapping
from dataclasses import dataclass

from regdb.interpretation import Interpretation
from regdb.situation import Scene
from regdb.vocabulary import Value
from regdb_runtime.database import RegulationDatabase
from regdb_runtime.errors import RequestError
from regdb_runtime.index.slots import PreparedScene
from regdb_runtime.legality import View
from regdb_runtime.maneuver import Maneuver
from regdb_runtime.maps.lane_path import Junction, LanePath
from regdb_runtime.maps.road_map import Lane, RoadMap
from regdb_runtime.observation import Footprint, Observation
from regdb_runtime.scenes.around import Around
from regdb_runtime.scenes.clock_facts import bright_minutes, clock_facts, offset_hours, seconds_until
from regdb_runtime.scenes.course import Courses, Part, stages_of
from regdb_runtime.scenes.crossing import Crossings
from regdb_runtime.scenes.eye_facts import EyeReport
from regdb_runtime.scenes.history import History, RailAhead, first_rail
from regdb_runtime.scenes.instant import Instant, Viewed
from regdb_runtime.scenes.junction_facts import junction_facts
from regdb_runtime.scenes.pieces import LanePieces, bounds_by_fact, hours_of
from regdb_runtime.scenes.roles import OnPart, Viewpoint, measures_on
from regdb_runtime.scenes.settings import EgoFacts, SceneSettings, SensorRanges, passenger_car
from regdb_runtime.scenes.sign_facts import sign_codes
from regdb_runtime.scenes.stretch import Stage, Stretch
from regdb_runtime.scenes.tellers import tellers

REMEMBERED = 4096
"""Scenes kept; a drive meets a few hundred different ones."""


@dataclass(frozen=True, eq=False, slots=True)
class Encoded:
    """A scene and its encoding."""

    scene: Scene
    prepared: PreparedScene


class Scenes:
    """Built once for a map, a database and a vehicle. Raises RequestError when nobody is known to govern or an interpretation is not there."""

    def __init__(
        self, road_map: RoadMap, database: RegulationDatabase, footprint: Footprint, settings: SceneSettings | None = None,
        interpretation: Interpretation | str = "rss", ego: EgoFacts | None = None, ranges: SensorRanges | None = None,
    ) -> None:  # fmt: skip
        self.road_map, self.database, self.footprint = road_map, database, footprint
        self.settings, self.ranges = settings or SceneSettings(), ranges or SensorRanges()
        self.profile = _profile(database, interpretation)
        self.ego = ego or passenger_car(database.vocabulary, footprint)
        place = road_map.jurisdiction or self.settings.place
        if place is None:
            raise RequestError("neither the map nor the settings say which jurisdiction governs; set SceneSettings.place")
        self._place = place
        pieces = LanePieces(road_map, bounds_by_fact(database.regulations), sign_codes(database.vocabulary), self.settings.border_step)
        self.courses = Courses(pieces, self.settings)
        self._asked = tellers(database.vocabulary)
        self._times = tuple(sorted(hours_of(database.regulations)))
        self._sun = road_map.origin or self.settings.sun_at
        self._crossings: dict[tuple[str, ...], Crossings] = {}
        self._views: dict[tuple[str, int], View] = {}
        self._encoded: dict[tuple[object, ...], Encoded] = {}
        self._eye: EyeReport | None = None
        self._instant: Instant | None = None

    def history(self) -> History:
        """A new, empty history of a vehicle on this map."""
        return History(self.road_map, self.settings, self.crossings, self.rail, self.around)

    def around(self, observation: Observation, lane_path: LanePath) -> Around:
        """The vehicle and everybody else on a path."""
        return self._at(observation).around(lane_path.path)

    def crossings(self, lane_path: LanePath, junction: Junction) -> Crossings | None:
        """The ways that meet the path's way through a junction, None where the path has no lane within it."""
        inner = tuple(span.lane for span in lane_path.spans if self.road_map.lanes[span.lane].junction == junction.id)
        if not inner:
            return None
        if inner not in self._crossings:
            self._crossings[inner] = Crossings(self.road_map, inner)
        return self._crossings[inner]

    def rail(self, lane_path: LanePath, rear: float) -> RailAhead | None:
        """The rail crossing on a path that the rear bumper has not left behind."""
        return first_rail(self.courses.rails(lane_path), rear)

    def stretches(self, observation: Observation, maneuver: Maneuver, history: History) -> tuple[Stretch, ...]:
        """The stretches of the manoeuvre's path from the front bumper on, in order, without gaps; at least one."""
        instant = self._at(observation)
        key = _way(maneuver, history)
        if key not in instant.views:
            instant.views[key] = self._viewed(instant, maneuver, history)
        view, parts, line = instant.views[key]
        signalled = view.signalled(maneuver.turn_signal)
        fastest = max(observation.ego.speed, maneuver.goal.cruise_speed)
        return tuple(self._stretch(part, encoded, on, line, signalled, fastest, view) for part, encoded, on in parts)

    def _viewed(self, instant: Instant, maneuver: Maneuver, history: History) -> Viewed:
        """The parts of one way to go, each with its scene and roles."""
        observation, junction = instant.observation, maneuver.junction
        around = instant.around(maneuver.lane_path.path)
        crossed = junction is not None and history.past.line == junction.id and history.past.crossed
        stages, line = stages_of(junction, around.front, crossed, self.footprint.length, self.settings)
        speed = observation.ego.speed
        change = None if speed < 1.0 else self._next_change(observation.clock, self.settings.reach / speed)
        parts = self.courses.parts(maneuver.lane_path, around.front, self.settings.reach, stages, observation.clock, speed, change)
        view = Viewpoint(self, instant, maneuver, around, history)
        found = []
        for part in parts:
            encoded = self._encode(part, junction if part.stage != "road" else None, view)
            found.append((part, encoded, view.on(part, encoded.scene.facts)))
        return view, found, line

    def _at(self, observation: Observation) -> Instant:
        """What candidates of one observation share."""
        if self._instant is None or self._instant.observation is not observation:
            if self._eye is None or not self._eye.is_of(observation):
                self._eye = EyeReport(observation, self._asked)
                self._encoded.clear()
            clock = clock_facts(observation.clock, self._sun, self.settings.summer_time)
            self._instant = Instant(observation, self.road_map, self.footprint, self.settings, self.ranges, self._eye, clock)
        return self._instant

    def _next_change(self, clock: datetime.datetime, within: float) -> float | None:
        """Seconds until the hour changes the law's facts for the first time (a rule's hours, a zone's, dawn, dusk, midnight), if within so many."""
        bright = bright_minutes(clock.date(), self._sun, offset_hours(clock, self._sun[0], self.settings.summer_time))
        waits = (seconds_until(at, clock) for at in (*self._times, 0.0, 60.0 * bright[0], 60.0 * bright[1] + 1.0))
        zones = self.courses.pieces.next_change(clock, within)
        return min((wait for wait in (*waits, *([] if zones is None else [zones])) if 0.0 < wait <= within), default=None)

    def _clock(self, part: Part, instant: Instant) -> Mapping[str, Value]:
        """What the clock says on arrival at a part."""
        now = instant.observation.clock
        return {} if part.clock == now else clock_facts(part.clock, self._sun, self.settings.summer_time)

    def _stretch(
        self, part: Part, encoded: Encoded, on: OnPart, line: float | None, signalled: Mapping[str, Value], fastest: float, view: Viewpoint
    ) -> Stretch:
        roles = {**on.facts, **self._clock(part, view.instant), **signalled}
        measures = measures_on(encoded.scene.facts, on.clear)
        sight = measures.get("speed.unsafe_for_conditions")
        if sight is not None and view.look.judged("speed.unsafe_for_conditions", {"speed": fastest, **sight}) is False:
            roles["speed.unsafe_for_conditions"] = False  # safe at the highest speed any plan may reach; else each plan's own speed decides
        bus = self._bus(view) if encoded.scene.facts.get("school_bus.ahead") is True else None
        place = part.piece.jurisdiction or self._place
        return Stretch(
            part.start, part.end, place, part.clock, self.view(place, part.clock), encoded.scene, encoded.prepared, roles, part.lane, part.stage,
            line if part.stage == "approach" else None, on.crosswalk, None if part.rail is None else part.rail_station, bus, measures,
        )  # fmt: skip

    def _bus(self, view: Viewpoint) -> float:
        """The station past which a plan passes the school bus: its near end, met or overtaken; at once beside it or where it is not tracked."""
        around = view.around
        found = [item.rear for item in around.others if item.track.kind == "bus" and item.track.speed < self.settings.bus_stands]
        return min((station for station in found if station > around.front), default=around.front + self.settings.before_bus)

    def view(self, place: str, clock: datetime.datetime) -> View:
        """The law of a place on the day of a clock. Raises RequestError for a place that is not in the database."""
        key = place, clock.toordinal()
        found = self._views.get(key)
        if found is None:
            found = self._views[key] = self.database.at(place, key[1])
        return found

    def _encode(self, part: Part, junction: Junction | None, view: Viewpoint) -> Encoded:
        """The facts that hold for every plan on a part, encoded; they change with the place and with what the eye reports."""
        inner = None if junction is None else view.inner
        key = id(part.piece), part.stage, None if junction is None else (junction.id, junction.turn, junction.control, inner), id(part.rail)
        found = self._encoded.get(key)
        if found is None:
            if len(self._encoded) >= REMEMBERED:
                self._encoded.clear()
            facts = self._standing(part, junction, view)
            assert self._eye is not None
            scene = Scene(self._eye.added_to(facts, self._has_lights(junction, part.stage)), self._eye.silent)
            found = self._encoded[key] = Encoded(scene, self.database.prepare(scene))
        return found

    def _standing(self, part: Part, junction: Junction | None, view: Viewpoint) -> dict[str, Value]:
        """What stands still: the vehicle's own make, the lane's piece, the junction's stage, the rails."""
        facts = {**self.ego.facts, **part.piece.facts}
        inner = view.inner
        if junction is not None:
            ways = () if view.crossings is None else tuple(view.crossings.ways)
            lane = self._lane(part) if inner is None else self.road_map.lanes[inner]
            facts |= junction_facts(self.road_map, junction, lane, view.approach, ways, part.stage)
        else:
            facts |= junction_facts(self.road_map, _NOWHERE, self._lane(part), None, (), "road")
        if part.rail is not None and part.rail.facts is not None:
            facts |= {**part.rail.facts, "rail.crossing_ahead": True, "rail.distance": 0.0}
        return facts

    def _lane(self, part: Part) -> Lane:
        return self.road_map.lanes[part.lane]

    @staticmethod
    def _has_lights(junction: Junction | None, stage: Stage) -> bool:
        """Whether the map's lights decide what the signal shows, so that the eye's own word is only asked for where none of them is seen."""
        return stage != "approach" or (junction is not None and bool(junction.lights))


def _way(maneuver: Maneuver, history: History) -> tuple[object, ...]:
    """What tells one way to go from another; manoeuvres that differ in states, signals and goals alone share it."""
    side = maneuver.next.endswith("left") if maneuver.target_lane is not None else None
    cruise = maneuver.goal.cruise_speed if maneuver.passes is not None else 0.0
    return (
        maneuver.lane_path, maneuver.junction, maneuver.lane, maneuver.target_lane, side, maneuver.passes, maneuver.passing_side, cruise,
        history.past,
    )  # fmt: skip


_NOWHERE = Junction("", 0.0, 0.0, 0.0, "straight", "none")


def _profile(database: RegulationDatabase, interpretation: Interpretation | str) -> Interpretation:
    if isinstance(interpretation, Interpretation):
        return interpretation
    found: Mapping[str, Interpretation] = database.interpretations
    if interpretation not in found:
        raise RequestError(f"the database has no interpretation {interpretation!r}; it has: {', '.join(sorted(found)) or 'none'}")
    return found[interpretation]
