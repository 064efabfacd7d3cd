"""A candidate next state made concrete: the path it would follow, what it would pass or stop for, and what to sample."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

from regdb_runtime.maps.reference_path import ReferencePath
from regdb_runtime.maps.road_map import Turn
from regdb_runtime.observation import TurnSignal
from regdb_runtime.planning.goal import Goal


@dataclass(frozen=True, slots=True)
class LaneSpan:
    """The part of a path that runs along one lane: stations along the path, and the lane's own station at `start`."""

    lane: str
    start: float
    end: float
    lane_start: float = 0.0


@dataclass(frozen=True, eq=False)
class LanePath:
    """A path along lanes, one after the other, with the stations of each."""

    path: ReferencePath
    spans: tuple[LaneSpan, ...]

    def lane_at(self, station: float) -> LaneSpan:
        """The span at a station; the first or last beyond the ends."""
        for span in self.spans:
            if station < span.end:
                return span
        return self.spans[-1]


@dataclass(frozen=True, slots=True)
class Junction:
    """The next junction on the path, stations along the path: where to stop (limit line, else crosswalk, else entrance), where it begins and ends.

    `control`: `signal`, `stop`, `all_way_stop`, `yield`, `none` or `unknown`. `lights`: those that speak to the turn. `turn`: how the route leads.
    """

    id: str
    stop_station: float
    entrance: float
    exit: float
    turn: Turn
    control: str
    lights: tuple[str, ...] = ()
    crosswalks: tuple[str, ...] = ()
    stop_line_marked: bool = True


@dataclass(frozen=True, eq=False)
class Maneuver:
    """One candidate: the transition, the lane path, the goal to sample, and the roles that depend on it.

    `lane`: where the vehicle is now; `target_lane`: where it would go, None to stay. `passes`: the track to be passed. `junction`: the next one
    on the path within the horizon, None without. `refused`: why it cannot be done at all (`route`, `no_lane` …), empty when it can.
    `via`: the micro-steps between the state now in force and `current`, all within one tick and without motion. `commits`: the manoeuvre is to
    enter the junction, so it is judged as entering it (`plan.enters_intersection`) wherever its sampled horizon ends. `biases`: what the
    strategist adds to the weighted cost, by name (`lane_needed`, `promise`, `switch`), never to legality.
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
    biases: tuple[tuple[str, float], ...] = ()
