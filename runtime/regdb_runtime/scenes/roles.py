"""The roles of everybody around on each part of a path: facts for `Plan.facts`, and where plans are measured."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from regdb.vocabulary import Value
from regdb_runtime.maneuver import Maneuver
from regdb_runtime.maps.road_map import Lane
from regdb_runtime.observation import TurnSignal
from regdb_runtime.scenes.around import Around
from regdb_runtime.scenes.course import Part
from regdb_runtime.scenes.crossing import Crossings
from regdb_runtime.scenes.history import History
from regdb_runtime.scenes.instant import Instant
from regdb_runtime.scenes.junction_facts import destination_facts
from regdb_runtime.scenes.junction_roles import NOBODY_CROSSING, TURNS, Entering, exit_blocked, junction_roles
from regdb_runtime.scenes.lane_facts import target_facts, turn_facts
from regdb_runtime.scenes.light_facts import light_facts
from regdb_runtime.scenes.look import Look, lanes_of, strips
from regdb_runtime.scenes.merging import merge
from regdb_runtime.scenes.pieces import Band
from regdb_runtime.scenes.traffic_roles import traffic_roles
from regdb_runtime.scenes.walkers import walker_roles

if TYPE_CHECKING:
    from regdb_runtime.scenes.stretches import Scenes

Measures = Mapping[str, Mapping[str, float]]
NOBODY_AT_JUNCTION = tuple(name for name in NOBODY_CROSSING if not name.startswith("rail."))
BEYOND_EXIT = 15.0
"""Metres beyond a junction within which a crosswalk belongs to it."""


@dataclass(frozen=True, eq=False, slots=True)
class OnPart:
    """What roles come to on one part: facts, the station from which a plan is in a crosswalk, the clear way ahead (metres; None: not known)."""

    facts: Mapping[str, Value]
    crosswalk: float | None
    clear: float | None


class Viewpoint:
    """One way to go at one instant, for all manoeuvres along it: its lanes, its junction, everybody around; worked out when asked for."""

    def __init__(self, scenes: Scenes, instant: Instant, maneuver: Maneuver, around: Around, history: History) -> None:
        self.scenes, self.instant, self.maneuver, self.around, self.history = scenes, instant, maneuver, around, history
        here = maneuver.lane_path.lane_at(around.front).lane
        self._here = scenes.road_map.lanes[here]
        self.own, self.target, self.side = lanes_of(scenes.road_map, maneuver, here)
        self._turned: tuple[str, Mapping[str, Value]] | None = None

    @cached_property
    def _within(self) -> tuple[int, int] | None:
        """First and last index of the path's spans within the junction."""
        lanes, junction = self.scenes.road_map.lanes, self.maneuver.junction
        if junction is None:
            return None
        found = [index for index, span in enumerate(self.maneuver.lane_path.spans) if lanes[span.lane].junction == junction.id]
        return (found[0], found[-1]) if found else None

    @cached_property
    def inner(self) -> str | None:
        """The planned lane within the junction."""
        return None if self._within is None else self.maneuver.lane_path.spans[self._within[0]].lane

    @cached_property
    def approach(self) -> Lane | None:
        """The lane from which the junction is entered."""
        if self._within is None or self.inner is None:
            return None
        if self._within[0] > 0:
            return self.scenes.road_map.lanes[self.maneuver.lane_path.spans[self._within[0] - 1].lane]
        before = self.scenes.road_map.lanes[self.inner].predecessors
        return self.scenes.road_map.lanes[before[0]] if before else None

    @cached_property
    def leaving(self) -> Lane | None:
        """The lane into which the junction is left."""
        if self._within is None:
            return None
        spans, lanes = self.maneuver.lane_path.spans, self.scenes.road_map.lanes
        if self._within[1] + 1 < len(spans):
            return lanes[spans[self._within[1] + 1].lane]
        after = lanes[spans[self._within[1]].lane].successors
        return lanes[after[0]] if after else None

    @cached_property
    def crossings(self) -> Crossings | None:
        """The ways that meet the planned one."""
        return None if self.maneuver.junction is None else self.scenes.crossings(self.maneuver.lane_path, self.maneuver.junction)

    @cached_property
    def turns(self) -> bool:
        """Whether the manoeuvre goes through the junction by a turn."""
        return self.maneuver.junction is not None and self.maneuver.junction.turn in TURNS

    @cached_property
    def look(self) -> Look:
        """Everybody around, from the candidate's lanes."""
        scenes, (own, target, path) = self.scenes, strips(self.own, self.target, self.side, self._here)
        return Look(
            scenes.road_map, self.instant.observation, self.maneuver, self.around, scenes.footprint, scenes.settings, scenes.ranges, scenes.profile,
            self.own, self.target, self.side, own, target, path,
        )  # fmt: skip

    @cached_property
    def everywhere(self) -> Mapping[str, Value]:
        """Roles that are the same on every part of the path."""
        facts = {"ego.speed": self.instant.observation.ego.speed, **self.history.facts(), **self._along_the_road()}
        return facts | target_facts(self.scenes.road_map, self.own, self.target, self.side)

    def _along_the_road(self) -> dict[str, Value]:
        facts: dict[str, Value] = {**self.instant.clock}
        if self.instant.eye.has_tracks:
            for _, _, band in self._crosswalks(self.around.rear, float("inf")):
                self.instant.walkers.in_crosswalk(band)
            facts |= {**NOBODY_CROSSING, **traffic_roles(self.look), **walker_roles(self.look, self.instant.walkers)}
            facts["movement.hazard"] = facts.get("target_lane.hazard", False) if self.target is not None else False
            if self.target is not None and "target_lane.hazard" not in facts:
                del facts["movement.hazard"]
        merge(facts, self.instant.eye.roles)
        return facts

    def _crosswalks(self, start: float, end: float) -> list[tuple[float, float, str]]:
        found = self.scenes.courses.crosswalks(self.maneuver.lane_path)
        return [(low, high, band.id) for low, high, band in found if high > start and low < end]

    def crosswalk_roles(self, part: Part) -> tuple[dict[str, Value], float | None, bool | None]:
        """Facts of the crosswalks still to be crossed from a part on, the station from which plans enter one, and whether somebody is in one."""
        junction = self.maneuver.junction
        end = part.end if part.stage == "road" or junction is None else max(part.end, junction.exit + BEYOND_EXIT)
        bands = self._crosswalks(max(part.start, self.around.front), end)
        if not bands:
            return ({"pedestrian.in_crosswalk": False} if self.instant.eye.has_tracks else {}), None, False
        marked = any(walk.marked for walk in self.scenes.road_map.crosswalks if walk.id in {name for _, _, name in bands})
        facts: dict[str, Value] = {"crosswalk.present": True, "crosswalk.marked": marked}
        edge = self.around.front + 0.1  # who is in it already is held not to go on
        taken = [(max(low, edge), self._somebody_in(name, low, high)) for low, high, name in bands]
        first = next((low for low, here in taken if here is True), next((low for low, here in taken if here is None), taken[0][0]))
        if not self.instant.eye.has_tracks:
            return facts, first, None
        occupied = True if any(here is True for _, here in taken) else None if any(here is None for _, here in taken) else False
        if occupied is not None:
            facts["pedestrian.in_crosswalk"] = occupied
        return facts | self._stopped_at_crosswalk(bands, occupied), first, occupied

    def _somebody_in(self, crosswalk: str, start: float, end: float) -> bool | None:
        """Whether somebody crosses there; a crosswalk too far to be seen is empty while it will be seen in time to stop."""
        found = self.instant.walkers.in_crosswalk(crosswalk)
        if found is not None:
            return found
        line = start if self.maneuver.junction is None else min(start, self.maneuver.junction.stop_station)
        return False if self.look.in_time(line, end, self.scenes.ranges.pedestrians) else None

    def _stopped_at_crosswalk(self, bands: list[tuple[float, float, str]], occupied: bool | None) -> dict[str, Value]:
        """Another vehicle stands before a crosswalk in which somebody crosses."""
        if occupied is not True:
            return {"vehicle_stopped_at_crosswalk": False}
        look = self.look
        stopped = any(
            item.is_motor and look.stands(item.track.speed) and 0.0 <= low - item.front <= 5.0 and not item.overlaps(*look.path_strip)
            for low, _, _ in bands for item in self.around.others
        )  # fmt: skip
        return {"vehicle_stopped_at_crosswalk": stopped}

    @cached_property
    def signal(self) -> Mapping[str, Value]:
        """What the lights of the junction say to the planned movement."""
        junction, road_map = self.maneuver.junction, self.scenes.road_map
        if junction is None or not junction.lights:
            return {}
        lights = [road_map.lights[name] for name in junction.lights if name in road_map.lights]
        return light_facts(lights, self.instant.observation.signals, junction.turn) or self.instant.eye.signal()

    @cached_property
    def at_junction(self) -> Mapping[str, Value]:
        """Roles of the junction's traffic, and what the turn means for the lane."""
        junction = self.maneuver.junction
        if junction is None:
            return {}
        facts: dict[str, Value] = {}
        if self.instant.eye.has_tracks and self.crossings is not None:
            facts |= junction_roles(self.look, self._entering(), self.turns)
            merge(facts, self.instant.eye.roles)
        return facts

    def _entering(self) -> Entering:
        junction, crossings = self.maneuver.junction, self.crossings
        assert junction is not None
        assert crossings is not None
        limits = {way.lane: limit for way in crossings.ways if (limit := self.scenes.road_map.lanes[way.lane].speed_limit) is not None}
        green = self.signal.get("signal.color") == "green" and self.signal.get("signal.flashing") is False
        stopped = frozenset(way.lane for way in crossings.ways if self.scenes.road_map.lanes[way.lane].control in ("stop", "all_way_stop"))
        return Entering(
            junction, crossings.ways, limits, self.instant.arriving(crossings), self.history.past.arrivals, stopped, green,
            green and self.signal.get("signal.shape") == "arrow", self.history.past.line == junction.id and self.history.past.crossed,
            junction.entrance - self.around.front,
        )  # fmt: skip

    def turn(self, standing: Mapping[str, Value]) -> dict[str, Value]:
        """What the lane's markings mean for the movement, and the road it leads into."""
        if self.maneuver.junction is None or self.approach is None or self.inner is None:
            return {}
        facts = turn_facts(self.scenes.road_map, self.approach, self.maneuver.junction.turn, standing)
        if self.leaving is not None:
            pieces = self.scenes.courses.pieces
            facts |= destination_facts(pieces.facts_of(self.leaving), self.maneuver.junction.turn)
        return facts

    @cached_property
    def _clear(self) -> float:
        """The way ahead without anybody on foot, animal or thing in it, metres from the front bumper: as far as sensors reach at most."""
        clear = min(self.scenes.ranges.vehicles, self.scenes.ranges.pedestrians)
        for item in self.around.among(*self.look.path_strip):
            if item.track.kind in ("pedestrian", "animal", "obstacle") and item.rear > self.around.front - 1.0:
                clear = min(clear, max(0.0, item.rear - self.around.front))
        return clear

    def on(self, part: Part, standing: Mapping[str, Value]) -> OnPart:
        """The roles of one part. `standing`: what holds there for every plan."""
        walks, crosswalk, occupied = self.crosswalk_roles(part)
        facts = {**self.everywhere, **walks}
        if part.stage != "road":
            if self.at_junction:
                for name in (*NOBODY_AT_JUNCTION, "movement.hazard"):  # what the junction leaves open is open
                    facts.pop(name, None)
            facts |= self.at_junction
            if self.target is not None and facts.get("target_lane.hazard") is True:
                facts["movement.hazard"] = True
            facts |= self._turn_on(part, standing)
        if part.rail is not None and part.rail_station is not None and self.instant.eye.has_tracks:
            facts |= self._rail_exit(part.rail, part.rail_station)
        if part.stage == "approach":
            facts |= self.signal
            facts["intersection.distance"] = 0.0
        elif part.stage == "inside":
            facts["plan.enters_intersection"] = False  # it is entered already; what lies ahead of the line is judged before it
        elif self.maneuver.junction is not None and part.end <= self.maneuver.junction.entrance:
            facts["intersection.distance"] = self.maneuver.junction.entrance - part.end
        if not self.instant.eye.has_tracks:
            return OnPart(facts, crosswalk, None)
        clear = self._clear if crosswalk is None or occupied is False else min(self._clear, max(0.0, crosswalk - self.around.front))
        lacking = self.look.judged("plan.lacks_due_care", {"speed": self.look.speed, "sight_distance": clear})
        if lacking is not None:
            facts["plan.lacks_due_care"] = lacking
        return OnPart(facts, crosswalk, clear)

    def _rail_exit(self, rail: Band, station: float) -> dict[str, Value]:
        """Whether room is left beyond the rails."""
        beyond = next((end for start, end, band in self.scenes.courses.rails(self.maneuver.lane_path) if band is rail and start == station), station)
        blocked = exit_blocked(self.look, beyond, station)
        return {} if blocked is None else {"rail.exit_blocked": blocked}

    def _turn_on(self, part: Part, standing: Mapping[str, Value]) -> Mapping[str, Value]:
        if self._turned is None or self._turned[0] is not part.lane:
            self._turned = part.lane, self.turn(standing)
        return self._turned[1]

    def signalled(self, signal: TurnSignal) -> dict[str, Value]:
        """How far the turn will have been signalled when it begins: so far, and on the way there while the signal stays on."""
        past, junction = self.history.past, self.maneuver.junction
        facts: dict[str, Value] = {"ego.turn_signal": signal}
        if signal not in ("left", "right"):
            return facts | {"ego.signalled_distance": 0.0, "ego.signalled_time": 0.0}
        ahead = 0.0 if junction is None or not self.turns else max(0.0, junction.entrance - self.around.front)
        before = past.signalled_distance if past.signal == signal else 0.0
        return facts | {"ego.signalled_distance": before + ahead}


def measures_on(standing: Mapping[str, Value], clear: float | None) -> Measures:
    """Fact -> the quantities that do not depend on plans, for facts that are judged by the plan's own too."""
    sight = [value for name in ("visibility.distance", "road.sight_distance") if isinstance(value := standing.get(name), float)]
    measures: dict[str, Mapping[str, float]] = {}
    if sight:
        measures["speed.unsafe_for_conditions"] = {"sight_distance": min(sight)}
    if clear is not None:
        measures["plan.lacks_due_care"] = {"sight_distance": clear}
    return measures
