"""Small scenes in which one section of the law is what matters, and drives through them watched from outside.

A crossing of four roads, each named by where it lies (`west` leads east into it); stations in metres, speeds in m/s.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache

from regdb_runtime.database import RegulationDatabase
from regdb_runtime.decision import Decision
from regdb_runtime.observation import Footprint, Track
from regdb_runtime.planner import Planner
from regdb_runtime.worlds.road_spec import Arm, Control, JunctionSpec, Piece, Pose, RoadSpec, SignalPhase, StreetsSpec
from regdb_runtime.worlds.scene_spec import SceneSpec
from watched_drives import Instant, Watched, bumper, gap

from regdb.front import database

HALF = 12.0
"""From the crossing's middle to the mouths of its roads."""
DAY = "2026-03-02T12:00:00"
MPH = 0.44704
STANDS = 0.1


@lru_cache(maxsize=1)
def shipped() -> RegulationDatabase:
    """The shipped codes."""
    return RegulationDatabase.open(database())


def crossing(
    control: Control, own: Control | None = None, others: Control | None = None, phases: tuple[SignalPhase, ...] = (), offset: float = 0.0,
    length: float = 110.0, limit: float = 35 * MPH, facts: Mapping[str, object] | None = None,
) -> StreetsSpec:  # fmt: skip
    """Four arms; `own` controls west and east, `others` north and south; `length` of the road on which the ego comes from the west."""
    roads = (
        RoadSpec("west", (Piece(length),), Pose(-length - HALF, 0.0, 0.0), 1, 1, 3.5, limit, "double_solid", facts=facts or {}),
        RoadSpec("east", (Piece(200.0),), Pose(HALF, 0.0, 0.0), 1, 1, 3.5, limit, "double_solid"),
        RoadSpec("north", (Piece(200.0),), Pose(0.0, HALF, 90.0), 1, 1, 3.5, limit, "double_solid"),
        RoadSpec("south", (Piece(200.0),), Pose(0.0, -HALF, 270.0), 1, 1, 3.5, limit, "double_solid"),
    )
    along = (Arm("west", "end", control=own), Arm("east", "start", control=own))
    arms = (*along, Arm("north", "start", control=others), Arm("south", "start", control=others))
    return StreetsSpec(roads, (JunctionSpec("crossing", arms, control, phases, offset),))


@dataclass(frozen=True)
class Drive:
    """What the world says of a drive: instants, and what the planner decided at each."""

    world: Watched
    instants: tuple[Instant, ...]
    decisions: tuple[Decision, ...]
    footprint: Footprint

    def before_line(self, item: Instant) -> float:
        """Metres from the front bumper on to the first stop line of the route, square to it; negative past it."""
        line = next(line for name in self.world.route if (line := self.world.road_map.lanes[name].stop_line) is not None)
        along = math.atan2(line.end[1] - line.start[1], line.end[0] - line.start[0])

        def left(point: tuple[float, float]) -> float:
            return -math.sin(along) * (point[0] - line.start[0]) + math.cos(along) * (point[1] - line.start[1])

        side = math.copysign(1.0, left(bumper(self.instants[0].ego, self.footprint)))
        return side * left(bumper(item.ego, self.footprint))

    @property
    def crossed(self) -> Instant:
        """The first instant at which the front bumper is past the line."""
        return next(item for item in self.instants if self.before_line(item) < 0.0)

    def stops(self) -> list[tuple[float, float, float]]:
        """Times at which the vehicle came to stand and moved off again, and the metres that were left to the line."""
        found: list[tuple[float, float, float]] = []
        for item in self.instants:
            if item.ego.speed < STANDS:
                begin = found[-1][0] if found and found[-1][1] > item.time - 0.15 else item.time
                if found and begin == found[-1][0]:
                    found.pop()
                found.append((begin, item.time, self.before_line(item)))
        return found

    def track(self, item: Instant, name: str) -> Track | None:
        return next((track for track in item.tracks if track.id == name), None)

    def clearance(self, name: str) -> float:
        """The least distance edge to edge to a road user."""
        return min(gap(item.ego, self.footprint, track) for item in self.instants if (track := self.track(item, name)) is not None)

    def braking(self) -> float:
        """The hardest braking of the vehicle, m/s2."""
        return -min(item.ego.acceleration for item in self.instants)

    def braking_of(self, name: str) -> float:
        """The hardest braking of another, by its speeds, m/s2."""
        speeds = [(item.time, track.speed) for item in self.instants if (track := self.track(item, name)) is not None]
        return max((speeds[i][1] - speeds[i + 5][1]) / (speeds[i + 5][0] - speeds[i][0]) for i in range(len(speeds) - 5))


def driven(spec: SceneSpec, seconds: float, route_end: float = 15.0) -> Drive:
    """Drive a scene; what no drive may do is asserted here: touch anybody, fail, or choose among plans none of which is lawful."""
    world = Watched(spec, shipped())
    planner = Planner(shipped(), world.road_map, world.route, world.footprint)
    last = world.road_map.lanes[world.route[-1]].center[-1]
    decisions = []
    while world.time < seconds - 1e-9:
        observation = world.observe()
        decision = planner.step(observation)
        decisions.append(decision)
        assert decision.flag not in ("least_violation", "no_trajectory"), _why(decision)
        failed = [item.because for report in decision.candidates for item in report.rejections if item.rule == "error"]
        assert not failed, failed
        world.step(decision.trajectory, decision.turn_signal, 0.1)
        assert not world.contacts, world.contacts
        front = bumper(world.ego, world.footprint)
        if math.hypot(front[0] - last[0], front[1] - last[1]) < route_end:
            break
    return Drive(world, tuple(world.instants), tuple(decisions), world.footprint)


def _why(decision: Decision) -> str:
    said = [f"{report.next}: rank {report.rank} {[item.rule for item in report.rejections][:6]}" for report in decision.candidates]
    return f"{decision.time:.1f} s, {decision.state}, {decision.flag} {decision.reason}: " + "; ".join(said)
