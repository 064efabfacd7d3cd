"""The strategist: for every state that may follow, a manoeuvre that would do it here, or the reason why none does."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from regdb_runtime.maneuver import Maneuver
from regdb_runtime.maps.road_map import RoadMap
from regdb_runtime.maps.route import Route
from regdb_runtime.observation import Footprint, Observation
from regdb_runtime.strategy import intersection, lane_following, overtaking
from regdb_runtime.strategy.lane_following import Build, refuse
from regdb_runtime.strategy.machine import Machine, Step
from regdb_runtime.strategy.memory import Memory
from regdb_runtime.strategy.paths import Paths
from regdb_runtime.strategy.picture import Picture
from regdb_runtime.strategy.settings import StrategySettings
from regdb_runtime.strategy.stop_line import NO_STOP, StopMemory, chosen, observe

BUILDERS: Mapping[str, Build] = {
    "lane_following.go_straight": lane_following.go_straight,
    "lane_following.car_following": lane_following.car_following,
    "lane_following.prepare_lane_change_left": lane_following.prepare("left"),
    "lane_following.lane_change_left": lane_following.change("left"),
    "lane_following.prepare_lane_change_right": lane_following.prepare("right"),
    "lane_following.lane_change_right": lane_following.change("right"),
    "intersection_handling.go_straight": intersection.go_straight,
    "intersection_handling.car_following": intersection.car_following,
    "intersection_handling.stop": intersection.stop,
    "intersection_handling.turn_left": intersection.turn,
    "intersection_handling.turn_right": intersection.turn,
    "intersection_handling.u_turn": intersection.turn,
    "overtaking.go_straight": overtaking.go_straight,
    "overtaking.prepare_lane_change_left": overtaking.prepare_left,
    "overtaking.lane_change_left": overtaking.change_left,
    "overtaking.prepare_lane_change_right": overtaking.prepare_right,
    "overtaking.lane_change_right": overtaking.change_right,
    "emergency_stop.slow_down": lane_following.slow_down,
}
"""State -> what builds its manoeuvre. A state of another machine, or one without a builder, is refused as such."""


@dataclass(frozen=True, eq=False)
class Strategist:
    """Pictures, manoeuvres and memory; what never changes goes in here."""

    machine: Machine
    road_map: RoadMap
    route: Route
    footprint: Footprint
    settings: StrategySettings
    paths: Paths

    def picture(self, observation: Observation, memory: Memory, free_speed: float | None) -> Picture:
        """Where the vehicle is; without a `free_speed` the posted one is taken. Raises OffRoad when it is on no lane of its route."""
        ego = observation.ego
        lane, lane_station = self.paths.locate(ego, memory.lane, memory.target_lane)
        path = self.paths.along(lane, lane_station)
        station, offset = self.paths.station(path, ego)
        picture = Picture(
            observation, self.road_map, self.route, self.paths, replace(memory, lane=lane), self.settings, self.footprint, lane, lane_station,
            path, station, offset, free_speed or self.road_map.lanes[lane].speed_limit or self.settings.cruise_speed,
        )  # fmt: skip
        return replace(picture, memory=self._looked(picture))

    def maneuvers(self, picture: Picture) -> tuple[Maneuver, ...]:
        """One for each state that may follow, in the machine's order; `refused` says why one cannot be done."""
        return tuple(self._biased(picture, step, self.build(picture, step)) for step in self.machine.successors(picture.memory.state))

    def own(self, picture: Picture) -> Maneuver:
        """The manoeuvre of the state in force, for a motion tick."""
        state = picture.memory.state
        return self.build(picture, Step(state, state))

    def build(self, picture: Picture, step: Step) -> Maneuver:
        """The manoeuvre of one step."""
        builder = BUILDERS.get(step.next)
        if builder is None:
            return refuse(picture, step, "no_builder")
        refused = _super_state_refusal(picture, step)
        return refuse(picture, step, refused) if refused else builder(picture, step)

    def after(self, picture: Picture, maneuver: Maneuver) -> Memory:
        """The memory once a manoeuvre has been chosen."""
        memory, time = picture.memory, picture.observation.time
        state = maneuver.next
        name = state.partition(".")[2]
        passing = overtaking.begun(picture, maneuver) if state.startswith("overtaking.") else None
        changes = name in ("lane_change_left", "lane_change_right")
        return replace(
            memory,
            state=state,
            entered=memory.entered if state == memory.state else time,
            left=memory.left if state == memory.state else memory.state,
            target_lane=maneuver.target_lane if changes else None,
            followed=maneuver.lead,
            passing=passing,
            stop=self._stop(picture, name == "stop", maneuver.commits),
            handling=picture.handling,
            returning=state.startswith("overtaking.") or (memory.returning and abs(picture.offset) > self.settings.settled_offset),
        )

    @staticmethod
    def _stop(picture: Picture, stops: bool, enters: bool) -> StopMemory:
        """The memory of the line after a choice; past the line there is nothing to remember but what was."""
        if picture.inside:
            return picture.memory.stop
        return chosen(picture.memory.stop, picture.junction if picture.handling else None, stops, enters, picture.observation.time)

    def _looked(self, picture: Picture) -> Memory:
        """The memory after a look at place and speed alone."""
        memory, junction = picture.memory, picture.junction
        stop = NO_STOP
        if junction is not None and picture.handling:
            stop = observe(memory.stop, junction, picture.front, picture.speed, picture.observation.time, self.settings)
        target = memory.target_lane
        if target is not None and self.paths.onto(target, picture.lane) == picture.lane and abs(picture.offset) <= self.settings.settled_offset:
            target = None
        return replace(memory, stop=stop, target_lane=target)

    def _biased(self, picture: Picture, step: Step, maneuver: Maneuver) -> Maneuver:
        """With what changing one's mind costs; staying, and leaving a stop, cost nothing."""
        memory, settings = picture.memory, self.settings
        if maneuver.refused:
            return maneuver
        biases = list(maneuver.biases)
        if step.next != memory.state and not memory.state.endswith(".stop"):
            biases.append(("switch", settings.switch))
            if step.next == memory.left and picture.observation.time - memory.entered < settings.least_dwell:
                biases.append(("dwell", settings.abandon))
        if _abandons(picture, step):
            biases.append(("abandon", settings.abandon))
        return replace(maneuver, biases=tuple(biases))


def _super_state_refusal(picture: Picture, step: Step) -> str:
    """Overtaking begins out of lane following alone; alongside what is passed there is no way back behind it."""
    now, then = picture.memory.state.partition(".")[0], step.next.partition(".")[0]
    if now == "emergency_stop":
        over = picture.observation.time - picture.memory.entered >= picture.settings.easing_time - 1e-9
        return "" if over != (then == "emergency_stop") else "over" if over else "easing"
    if then == "overtaking" and now == "intersection_handling":
        return "not_from_here"
    if now == "overtaking" and then != "overtaking":
        passed = overtaking.passed_now(picture)
        if passed is not None and picture.front > passed.rear and not overtaking.done(picture, passed):
            return "alongside"
    return ""


def _abandons(picture: Picture, step: Step) -> bool:
    memory = picture.memory
    if memory.target_lane is not None:
        return step.next != memory.state
    if memory.passing is None or step.next.startswith("overtaking."):
        return False
    away = memory.passing.mode == "by_lane" and picture.lane != picture.paths.onto(memory.passing.home, picture.lane)
    return away or not overtaking.done(picture, overtaking.passed_now(picture))
