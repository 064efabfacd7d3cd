"""The planner: observation in, decision out; strategy twice a second, motion at every tick, and an emergency check that needs neither.

 observation -> emergency check (boxes alone)
      |
 history, place on the route
      |
 strategic tick: every state that may follow -> manoeuvre -> plans -> cost -> law -> the cheapest of the best rank
 motion tick:    the same for the state in force alone
      |
 Decision

`Planner.step` never raises: where a part fails, the vehicle brakes comfortably along its last plan, and the decision says why.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from regdb_runtime.decision import CandidateReport, Decision, Flag
from regdb_runtime.emergency import EmergencyBrake, EmergencyReport
from regdb_runtime.maps.route import Route, route_along
from regdb_runtime.observation import Footprint, Observation, TurnSignal
from regdb_runtime.strategy.continuation import braking_along, starting_state
from regdb_runtime.strategy.memory import Memory
from regdb_runtime.strategy.planner_settings import PlannerSettings as PlannerSettings
from regdb_runtime.trajectory import Trajectory

if TYPE_CHECKING:
    from regdb_runtime.assessment.assessed import Assessed
    from regdb_runtime.database import RegulationDatabase
    from regdb_runtime.maps.road_map import RoadMap
    from regdb_runtime.planning.prediction import Predictor
    from regdb_runtime.strategy.mind import Mind, Thought

EMERGENCY = "emergency_stop.emergency_stop"
SLOW_DOWN = "emergency_stop.slow_down"


class Planner:
    """Drives one vehicle along one route. Holds what it remembers between ticks; not shared between threads.

    `route`: ids of lanes, one per segment, as a world names them, or a `Route`. `predictor` says where others will be (default: along
    their lanes at the speed they have).
    """

    def __init__(
        self, database: RegulationDatabase, road_map: RoadMap, route: Route | Sequence[str], footprint: Footprint | None = None,
        settings: PlannerSettings | None = None, predictor: Predictor | None = None,
    ) -> None:  # fmt: skip
        self.settings = settings or PlannerSettings()
        self.footprint = footprint or Footprint()
        self.brake = EmergencyBrake(self.footprint, self.settings.emergency)
        self._parts = database, road_map, route, predictor
        self._mind: Mind | None = None
        self._memory = Memory("")
        self._plan: Trajectory | None = None
        self._planned_at = 0.0
        self._next_strategy = float("-inf")
        self._signal: TurnSignal = "off"

    @property
    def state(self) -> str:
        """The state in force."""
        return self._memory.state

    def step(self, observation: Observation) -> Decision:
        """One tick. Never raises; see the module."""
        try:
            report = self.brake.check(observation.ego, observation.tracks, observation.time)
        except Exception as error:  # noqa: BLE001  # an emergency check that cannot check brakes
            report = EmergencyReport(active=True, gap=None, required=0.0, track=None)
            return self._emergency(observation, report, f"emergency check failed: {_said(error)}")
        if report.active:
            return self._emergency(observation, report, "")
        try:
            return self._drive(observation, report)
        except Exception as error:  # noqa: BLE001  # fails closed: braking, and the reason
            return self._fall_back(observation, report, _said(error))

    def judge(self, observation: Observation, plan: Trajectory) -> Assessed:
        """The law on a plan made elsewhere, for the state in force after `step` of the same observation: rank, verdicts, and what it breaks.

        `plan`: as `Trajectory`; its stations and offsets are worked out here. Raises RegdbRuntimeError off the road, and RuntimeError before `step`.
        """
        if self._mind is None:
            raise RuntimeError("judge before step: there is no state in force yet")
        return self._mind.judge(observation, self._memory, plan)

    def warm(self, observation: Observation) -> None:
        """Make everything ready that the first ticks would otherwise wait for: paths, the law's decisions. Takes some
        seconds; call it before the vehicle moves. Raises RegdbRuntimeError for what does not fit together, where `step` would brake and say so."""
        mind = self._awake()
        mind.warm(observation.clock)
        picture = mind.strategist.picture(observation, Memory(mind.initial), None)
        mind.strategist.maneuvers(picture)

    def _drive(self, observation: Observation, report: EmergencyReport) -> Decision:
        mind = self._awake()
        if not self._memory.state:
            self._memory = replace(self._memory, state=mind.initial, entered=observation.time)
        if self._memory.state == EMERGENCY:
            self._memory = replace(self._memory, state=SLOW_DOWN, entered=observation.time, left=EMERGENCY)
        strategic = observation.time >= self._next_strategy - 1e-6
        start = starting_state(observation.ego, self._plan, observation.time - self._planned_at, self.settings.tracking)
        thought = mind.think(observation, self._memory, start, strategic)
        if strategic:
            self._next_strategy = observation.time + self.settings.strategic_period
        if thought.trajectory is None:
            return self._fall_back(observation, report, "no plan is possible", thought)
        before = self._memory.state
        self._memory = thought.memory
        return self._decision(observation, report, thought, thought.trajectory, before)

    def _decision(
        self, observation: Observation, report: EmergencyReport, thought: Thought, trajectory: Trajectory, before: str
    ) -> Decision:
        self._keep(observation, trajectory, thought.turn_signal)
        events = (*_over(before, thought.memory.state), *thought.events)
        return Decision(
            observation.time, self._memory.state, thought.steps, trajectory, thought.turn_signal, self._memory.stop.phase, thought.strategic,
            thought.candidates, thought.chosen, thought.margin, thought.flag, report, events, thought.reason,
        )  # fmt: skip

    def _emergency(self, observation: Observation, report: EmergencyReport, reason: str) -> Decision:
        """Brake, straight from numbers; nothing of law, map or strategy is asked."""
        before, ego = self._memory, observation.ego
        self._memory = Memory(EMERGENCY, observation.time if before.state != EMERGENCY else before.entered, before.state, before.lane)
        self._next_strategy = float("-inf")
        try:
            trajectory = self.brake.brake(ego)
        except Exception as error:  # noqa: BLE001  # then brake by the fallback's own numbers
            trajectory, reason = braking_along(ego, None, 0.0, self.settings.tracking), f"{reason} {_said(error)}".strip()
        self._keep(observation, trajectory, ego.turn_signal)
        steps = (EMERGENCY,) if before.state != EMERGENCY else ()
        events = ("emergency",) if before.state != EMERGENCY else ()
        return Decision(
            observation.time, EMERGENCY, steps, trajectory, ego.turn_signal, "", strategic=False, candidates=(), chosen=None, margin=None,
            flag="emergency", emergency=report, events=events, reason=reason,
        )  # fmt: skip

    def _fall_back(self, observation: Observation, report: EmergencyReport, reason: str, thought: Thought | None = None) -> Decision:
        """Comfortable braking to a stand along the last plan; the state stays, and the next tick thinks again."""
        elapsed = observation.time - self._planned_at
        trajectory = braking_along(observation.ego, self._plan, elapsed, self.settings.tracking)
        self._keep(observation, trajectory, self._signal)
        self._next_strategy = float("-inf")
        candidates: tuple[CandidateReport, ...] = () if thought is None else thought.candidates
        flag: Flag = "no_trajectory"
        return Decision(
            observation.time, self._memory.state, (), trajectory, self._signal, self._memory.stop.phase, thought is not None and thought.strategic,
            candidates, None, None, flag, report, (), reason,
        )  # fmt: skip

    def _keep(self, observation: Observation, trajectory: Trajectory, signal: TurnSignal) -> None:
        self._plan, self._planned_at, self._signal = trajectory, observation.time, signal

    def _awake(self) -> Mind:
        """What thinks, made at the first tick: a map or database that cannot be used must not keep the brake from working."""
        if self._mind is None:
            from regdb_runtime.strategy.mind import make_mind

            database, road_map, route, predictor = self._parts
            way = route if isinstance(route, Route) else route_along(road_map, tuple(route))
            self._mind = make_mind(database, road_map, way, self.footprint, self.settings, predictor)
        return self._mind


def _over(before: str, after: str) -> tuple[str, ...]:
    return ("emergency_over",) if before.startswith("emergency_stop.") and not after.startswith("emergency_stop.") else ()


def _said(error: Exception) -> str:
    return f"{type(error).__name__}: {error}"

