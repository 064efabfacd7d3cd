"""What thinks between observation and decision: picture, manoeuvres, evaluation of each, choice, memory, events."""

from __future__ import annotations

import datetime
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from regdb_runtime.assessment.assessed import Assessed
from regdb_runtime.assessment.assessor import Assessor
from regdb_runtime.decision import CandidateReport, Flag
from regdb_runtime.maneuver import Maneuver
from regdb_runtime.observation import EgoState, Footprint, Observation, Track, TurnSignal
from regdb_runtime.planning.choice import choose
from regdb_runtime.planning.contacts import Sweeper
from regdb_runtime.planning.prediction import Predictions, Predictor
from regdb_runtime.scenes.history import History
from regdb_runtime.scenes.stretch import Stretch
from regdb_runtime.scenes.stretches import Scenes
from regdb_runtime.strategy.evaluation import Evaluated, Evaluator, failed
from regdb_runtime.strategy.events import ZoneWatch, state_events, zone_events
from regdb_runtime.strategy.lane_prediction import AlongLanes
from regdb_runtime.strategy.machine import Machine
from regdb_runtime.strategy.maneuvers import BUILDERS, Strategist
from regdb_runtime.strategy.memory import Memory
from regdb_runtime.strategy.paths import paths_of
from regdb_runtime.strategy.picture import Picture
from regdb_runtime.strategy.placing import placed
from regdb_runtime.strategy.planner_settings import PlannerSettings
from regdb_runtime.strategy.reroute import reroute
from regdb_runtime.strategy.sampling import Moment, Sampler
from regdb_runtime.trajectory import Trajectory

if TYPE_CHECKING:
    from regdb_runtime.database import RegulationDatabase
    from regdb_runtime.maps.road_map import RoadMap
    from regdb_runtime.maps.route import Route


@dataclass(frozen=True)
class Thought:
    """What a tick came to; `trajectory` None when no candidate has a plan."""

    memory: Memory
    trajectory: Trajectory | None
    turn_signal: TurnSignal
    steps: tuple[str, ...]
    strategic: bool
    candidates: tuple[CandidateReport, ...]
    chosen: int | None
    margin: float | None
    flag: Flag
    events: tuple[str, ...]
    reason: str = ""


class Mind:
    """Strategist and evaluator with what they remember: history, the speed that was free at last, the zone watched for."""

    def __init__(self, strategist: Strategist, evaluator: Evaluator, history: History, predictor: Predictor, settings: PlannerSettings) -> None:
        self.strategist, self.evaluator, self.history = strategist, evaluator, history
        self.predictor, self.settings = predictor, settings
        self._times = np.arange(settings.lattice.points, dtype=np.float64) * settings.lattice.step
        self._free_speed: float | None = None
        self._watch = ZoneWatch()
        self._rerouted = False
        self._judged: tuple[Observation, Memory, Maneuver, tuple[Stretch, ...], tuple[Track, ...]] | None = None

    @property
    def initial(self) -> str:
        """The state driving starts in."""
        return self.strategist.machine.initial

    def warm(self, clock: datetime.datetime) -> int:
        """Compile the law of every place of the map for every transition there is, so that no tick has to; how many there were.

        Raises RequestError for a place that the database does not know.
        """
        road_map, machine = self.strategist.road_map, self.strategist.machine
        places = sorted({place for place in (road_map.jurisdiction, *(zone.jurisdiction for zone in road_map.zones)) if place is not None})
        steps = sorted({(step.current, step.next) for state in BUILDERS for step in machine.successors(state)})
        for place in places:
            view = self.evaluator.scenes.view(place, clock)
            for current, following in steps:
                view.concerned(current, following)
        return len(places) * len(steps)

    def think(self, observation: Observation, memory: Memory, start: EgoState, strategic: bool) -> Thought:
        """One tick: among all states that may follow, or in the state in force alone; if that has no lawful plan, among all after all."""
        picture = self._picture(observation, memory)
        self.history.update(observation, picture.lane_path, picture.junction)
        predictions = self.predictor.predict(self._mattering(picture), self._times)
        if not strategic:
            own = self._evaluate((self.strategist.own(picture),), picture, start, predictions)
            if own[0].report.rank == 0:
                return self._choice(picture, memory, own, strategic=False)
        found = self._evaluate(self.strategist.maneuvers(picture), picture, start, predictions)
        return self._choice(picture, memory, found, strategic=True)

    def judge(self, observation: Observation, memory: Memory, plan: Trajectory) -> Assessed:
        """The law on a plan made elsewhere, for the state in force; contacts and limits of motion are its maker's matter, the law's facts are not.

        `plan` needs `time`, `x`, `y`, `heading`, `speed`, `acceleration`, `jerk` and `curvature`; it is placed on the manoeuvre's path here.
        """
        if self._judged is None or self._judged[0] is not observation or self._judged[1] is not memory:
            picture = self._picture(observation, memory)
            maneuver = self.strategist.own(picture)
            stretches = self.evaluator.scenes.stretches(observation, maneuver, self.history)
            self._judged = observation, memory, maneuver, stretches, self._mattering(picture)
        _, _, maneuver, stretches, tracks = self._judged
        predictions = self.predictor.predict(tracks, plan.time)
        candidates = placed(plan, maneuver.lane_path.path)
        nobody = Sweeper(self.predictor.predict((), plan.time), self.strategist.footprint)
        return self.evaluator.assessor.best(maneuver, stretches, candidates, [0], [0.0], observation, predictions, [True], nobody)

    def _picture(self, observation: Observation, memory: Memory) -> Picture:
        """Where the vehicle is; on another route from now on, when the change of lane that this one needs is missed."""
        picture = self.strategist.picture(observation, memory, self._free_speed)
        missed = picture.need.changes > 0 and picture.need.room <= self.settings.strategy.reroute_distance
        if not missed or memory.target_lane is not None:
            return picture
        strategist = self.strategist
        route = reroute(strategist.road_map, picture.lane, strategist.route)
        paths = paths_of(strategist.road_map, route, strategist.footprint, strategist.settings)
        self.strategist = replace(strategist, route=route, paths=paths)
        self._rerouted = True
        return self.strategist.picture(observation, memory, self._free_speed)

    def _evaluate(
        self, maneuvers: tuple[Maneuver, ...], picture: Picture, start: EgoState, predictions: Predictions
    ) -> tuple[Evaluated, ...]:
        """Each on its own: one that raises falls out and says so, the others stay."""
        found, sweeper = [], Sweeper(predictions, picture.footprint, self.settings.margin)
        moment = Moment(picture.observation, self.history, start, predictions, sweeper, picture.free_speed)
        for maneuver in maneuvers:
            try:
                found.append(self.evaluator.evaluate(maneuver, moment))
            except Exception as error:  # noqa: BLE001  # fails closed: no plan of this candidate
                found.append(failed(maneuver, error))
        return tuple(found)

    def _choice(self, picture: Picture, before: Memory, found: tuple[Evaluated, ...], strategic: bool) -> Thought:
        reports = tuple(item.report for item in found)
        breaches = {id(item.report): item.breach for item in found}
        choice = choose(reports, breaches=lambda option: breaches[id(option)])
        if choice.index is None:
            return Thought(picture.memory, None, "off", (), strategic, reports, None, None, "no_trajectory", ())
        taken = found[choice.index]
        memory = self.strategist.after(picture, taken.maneuver)
        events = self._events(picture, before, memory, taken)
        steps = (*taken.maneuver.via, taken.maneuver.next) if taken.maneuver.next != before.state else ()
        return Thought(
            memory, taken.report.trajectory, taken.maneuver.turn_signal, steps, strategic, reports, choice.index, choice.margin, choice.flag, events
        )  # fmt: skip

    def _events(self, picture: Picture, before: Memory, after: Memory, taken: Evaluated) -> tuple[str, ...]:
        settled = self.settings.strategy.settled_offset
        front = picture.front
        self._free_speed = min([cap.speed for cap in taken.caps if cap.start <= front < cap.end], default=self.settings.strategy.cruise_speed)
        plan = taken.report.trajectory
        brakes = 0.0 if plan is None else float(plan.acceleration[: 1 + round(0.5 / self.settings.lattice.step)].min())
        self._watch, seen = zone_events(self._watch, taken.caps, front, brakes)
        new_route, self._rerouted = ("rerouted",) if self._rerouted else (), False
        return (*new_route, *state_events(before, after, picture.offset, settled), *seen)

    def _mattering(self, picture: Picture) -> tuple[Track, ...]:
        """All road users but those behind in the own lane: they keep their distance from us, not we from them."""
        half = float(picture.here.widths.min()) / 2
        behind = {
            item.track.id for item in picture.placed
            if item.front <= picture.rear and item.along > 0.0 and -half < item.offset < half
        }  # fmt: skip
        return tuple(track for track in picture.observation.tracks if track.id not in behind)


def make_mind(
    database: RegulationDatabase, road_map: RoadMap, route: Route, footprint: Footprint, settings: PlannerSettings, predictor: Predictor | None
) -> Mind:
    """Everything that thinks, from law, map and route. Raises RegdbRuntimeError for what does not fit together."""
    profile = database.interpretations[settings.interpretation]
    paths = paths_of(road_map, route, footprint, settings.strategy)
    strategist = Strategist(Machine(database.machine, _asked(road_map, route)), road_map, route, footprint, settings.strategy, paths)
    scenes = Scenes(road_map, database, footprint, interpretation=profile)
    assessor = Assessor(database, footprint, interpretation=profile, road_map=road_map)
    sampler = Sampler(footprint, settings.lattice, settings.limits, settings.comfortable, settings.beyond_comfort, settings.cost)
    evaluator = Evaluator(scenes, assessor, sampler)
    return Mind(strategist, evaluator, scenes.history(), predictor or AlongLanes(paths.graph, paths.built), settings)


def _asked(road_map: RoadMap, route: Route) -> frozenset[str]:
    """The extension states that the route asks for: a U-turn where it makes one."""
    turns = any(road_map.lanes[name].turn == "u_turn" for name in route.lanes)
    return frozenset(("intersection_handling.u_turn",)) if turns else frozenset()
