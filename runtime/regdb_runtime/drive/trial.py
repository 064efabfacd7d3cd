"""A scene driven and held against what no drive may do; what is measured comes from the world, not from the planner's own account.

Faults: an exception; an unlawful plan while a lawful one existed; a red light run; a posted limit exceeded; a collision the vehicle caused; a
standstill without stated reason.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Literal

from regdb_runtime.database import RegulationDatabase
from regdb_runtime.decision import Decision
from regdb_runtime.drive.downtrack import Downtrack
from regdb_runtime.drive.run import Steps
from regdb_runtime.maps.road_map import RoadMap
from regdb_runtime.observation import Observation
from regdb_runtime.planner import Planner
from regdb_runtime.worlds.built_in.world import BuiltInWorld
from regdb_runtime.worlds.scene_spec import SceneSpec

Kind = Literal["exception", "unlawful", "red_light", "speeding", "collision", "standstill"]


@dataclass(frozen=True, slots=True)
class TrialSettings:
    """How long and how strictly; SI.

    `standstill` is the issue's 60 s. A limit counts as exceeded when the speedometer is `speeding` over it for `speeding_time`: what
    following a plan may add, not what planning may. `line`: how far the front may come to stand over a line.
    """

    seconds: float = 60.0
    period: float = 0.1
    standstill: float = 60.0
    standing: float = 0.1
    speeding: float = 0.3
    speeding_time: float = 1.0
    line: float = 0.1
    stop_zone: float = 4.0


@dataclass(frozen=True, slots=True)
class Fault:
    """One thing that must not happen: when first, of what kind, and what exactly."""

    kind: Kind
    time: float
    what: str


@dataclass(frozen=True)
class Outcome:
    """How a trial ended: its faults (the first of each kind), how often each flag was raised, and how far the vehicle came (metres)."""

    scene: str
    faults: tuple[Fault, ...]
    flags: Mapping[str, int]
    driven: float
    seconds: float
    contacts: int


@dataclass
class _Seen:
    """What a trial remembers from tick to tick."""

    faults: dict[str, Fault] = field(default_factory=dict)
    flags: Counter[str] = field(default_factory=Counter)
    front: float | None = None
    stood_since: float | None = None
    fast_since: float | None = None
    stopped_at: dict[float, float] = field(default_factory=dict)

    def fault(self, kind: Kind, time: float, what: str) -> None:
        self.faults.setdefault(kind, Fault(kind, round(time, 3), what))


def trial(
    spec: SceneSpec, database: RegulationDatabase, settings: TrialSettings | None = None,
    driver: Callable[[BuiltInWorld], Steps] | None = None,
) -> Outcome:  # fmt: skip
    """Drive a scene in the built-in world until its time is over, the route ends, or the vehicle has collided. `driver` makes whatever decides;
    without it, our planner."""
    settings = settings or TrialSettings()
    world = BuiltInWorld(spec, database.vocabulary)
    planner = driver(world) if driver is not None else Planner(database, world.road_map, world.route, world.footprint)
    watch = _Watch(world, settings)
    while world.time < settings.seconds - 1e-9 and not world.contacts and not watch.arrived:
        observation = world.observe()
        decision = planner.step(observation)
        watch.tick(observation, decision)
        world.step(decision.trajectory, decision.turn_signal, settings.period)
    return watch.outcome(spec.name)


class _Watch:
    """Looks at every tick."""

    def __init__(self, world: BuiltInWorld, settings: TrialSettings) -> None:
        self.world, self.settings = world, settings
        self.downtrack = Downtrack(world.road_map, world.route)
        self.lines = tuple(_lines(world, self.downtrack))
        self.limits = _limits(world.road_map, self.downtrack, world.route)
        self.seen = _Seen()
        self.begin = self._front(world.observe())

    @property
    def arrived(self) -> bool:
        """Whether the route is about to end; no planner can stand for what lies beyond the map."""
        return self.seen.front is not None and self.seen.front > self.downtrack.length - 10.0

    def tick(self, observation: Observation, decision: Decision) -> None:
        """Hold one decision, and the motion since the last, against what may not be."""
        before, front = self.seen.front, self._front(observation)
        self.seen.front = front
        self.seen.flags[decision.flag] += 1
        self._decided(observation.time, decision)
        self._speed(observation, front, decision)
        self._standing(observation, front, decision)
        if before is not None:
            self._crossed(observation, before, front)

    def _front(self, observation: Observation) -> float:
        near = None if self.seen.front is None else self.seen.front
        return self.downtrack.locate(*observation.ego.front_bumper(self.world.footprint), near)[0]

    def _decided(self, time: float, decision: Decision) -> None:
        errors = [item.because for report in decision.candidates for item in report.rejections if item.rule == "error"]
        if errors or "Error" in decision.reason or decision.reason.partition(":")[0].isidentifier():
            self.seen.fault("exception", time, errors[0] if errors else decision.reason)
        if decision.chosen is not None:
            ranks = [report.rank for report in decision.candidates]
            chosen = decision.candidates[decision.chosen]
            if chosen.rank > min(ranks):
                self.seen.fault("unlawful", time, f"{chosen.next} of rank {chosen.rank}, though there was one of rank {min(ranks)}")

    def _speed(self, observation: Observation, front: float, decision: Decision) -> None:
        limit = next((speed for start, end, speed in self.limits if start <= front < end), None)
        if limit is None or observation.ego.speed <= limit + self.settings.speeding:
            self.seen.fast_since = None
            return
        since = self.seen.fast_since = observation.time if self.seen.fast_since is None else self.seen.fast_since
        if observation.time - since > self.settings.speeding_time and observation.ego.acceleration > -0.5 and not decision.emergency.active:
            self.seen.fault("speeding", observation.time, f"{observation.ego.speed:.2f} m/s where {limit:.2f} m/s is posted")

    def _standing(self, observation: Observation, front: float, decision: Decision) -> None:
        if observation.ego.speed >= self.settings.standing:
            self.seen.stood_since = None
            return
        since = self.seen.stood_since = observation.time if self.seen.stood_since is None else self.seen.stood_since
        for station, _ in self.lines:
            if -self.settings.stop_zone < front - station <= self.settings.line:
                self.seen.stopped_at[station] = observation.time
        if observation.time - since > self.settings.standstill and not _stated(decision):
            self.seen.fault("standstill", observation.time, f"stands since {since:.1f} s in {decision.state}")

    def _crossed(self, observation: Observation, before: float, front: float) -> None:
        """A line passed while the light that governs the route's movement was red; turning right after a stop is for the law, and looked at there."""
        for station, movement in self.lines:
            if before <= station + self.settings.line < front:
                lane = self.world.road_map.lanes[movement]
                light = self.world.signals.governing(lane.lights)
                red = light is not None and self.world.signals.color(light, observation.time - self.settings.period) == "red"
                right = lane.turn == "right" and light is not None and not self.world.signals.is_arrow(light) and station in self.seen.stopped_at
                if red and not right:
                    self.seen.fault("red_light", observation.time, f"{light} is red, {observation.ego.speed:.1f} m/s over the line")

    def outcome(self, name: str) -> Outcome:
        """What the trial came to."""
        world = self.world
        for contact in world.contacts:
            if contact.by != "other":
                what = f"{contact.part} touches the {contact.other_part} of {contact.kind} {contact.other} at {contact.ego_speed:.1f} m/s"
                self.seen.fault("collision", contact.time, what)
        faults = tuple(sorted(self.seen.faults.values(), key=lambda item: (item.time, item.kind)))
        return Outcome(name, faults, dict(self.seen.flags), (self.seen.front or self.begin) - self.begin, world.time, len(world.contacts))


def _stated(decision: Decision) -> bool:
    """Whether the decision says why the vehicle stands: its own reason, the emergency, or what stands against going on."""
    against = any(report.rejections or report.rank > 0 for report in decision.candidates)
    return bool(decision.reason) or decision.emergency.active or decision.stop_phase != "" or against


def _lines(world: BuiltInWorld, downtrack: Downtrack) -> Iterator[tuple[float, str]]:
    """Stations of the stop lines on the route, and the junction lane that follows each."""
    lanes = world.road_map.lanes
    for before, after in zip(world.route, world.route[1:], strict=False):
        station = downtrack.stop_line(before)
        if station is not None and lanes[after].junction is not None and lanes[after].lights:
            yield station, after


def _limits(road_map: RoadMap, downtrack: Downtrack, route: tuple[str, ...]) -> tuple[tuple[float, float, float], ...]:
    spans = downtrack.lane_spans()
    return tuple(
        (spans[name].start, spans[name].end, limit) for name in route if (limit := road_map.lanes[name].speed_limit) is not None
    )  # fmt: skip
