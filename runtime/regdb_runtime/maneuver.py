"""A candidate next state made concrete: the path it would follow, what it would pass or stop for, and what to sample."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

from regdb_runtime.maps.lane_path import Junction as Junction
from regdb_runtime.maps.lane_path import LanePath as LanePath
from regdb_runtime.maps.lane_path import LaneSpan as LaneSpan
from regdb_runtime.observation import TurnSignal
from regdb_runtime.planning.goal import Goal


@dataclass(frozen=True, eq=False)
class Maneuver:
    """One candidate: the transition, the lane path, the goal to sample, and the roles that depend on it.

    `lane`: where the vehicle is now; `target_lane`: where it would go, None to stay. `passes`: the track to be passed. `junction`: the next one
    on the path within the horizon, None without. `refused`: why it cannot be done at all (`route`, `no_lane` …), empty when it can.
    `via`: the micro-steps between the state now in force and `current`, all within one tick and without motion. `commits`: the manoeuvre is to
    enter the junction, so it is judged as entering it (`plan.enters_intersection`) wherever its horizon ends. `may_wait`: it is far enough from
    the line for what is unknown there to become known: then it is judged by its plans alone, as if it did not commit. `biases`: what the
    strategist adds to C_distance, by name (`lane_needed`, `promise`, `switch`), in metres; never to legality.
    `prepares`: the manoeuvre that this one only gets ready for: where that one would not be lawful once signalled, this one falls out too.
    `credit`: C_distance counts as no more than this, metres: what it prepares makes up for the rest.
    """

    current: str
    next: str
    lane: str
    lane_path: LanePath
    goal: Goal
    turn_signal: TurnSignal = "off"
    target_lane: str | None = None
    passes: str | None = None
    passing_side: Literal["none", "left", "right"] = "none"
    lead: str | None = None
    junction: Junction | None = None
    beyond: LanePath | None = field(default=None)
    refused: str = ""
    via: tuple[str, ...] = ()
    commits: bool = False
    may_wait: bool = False
    biases: tuple[tuple[str, float], ...] = ()
    credit: float | None = None
    prepares: Maneuver | None = None
