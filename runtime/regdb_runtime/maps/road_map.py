"""The vector map: lanes with their centre lines, markings, limits, lights, stop lines and zones; nothing here knows a file format."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from regdb.vocabulary import Value

Floats = NDArray[np.float64]
Side = Literal["left", "right"]
Control = Literal["signal", "stop", "all_way_stop", "yield", "none", "unknown"]
"""How the entry into a junction is regulated; `none` only where the map says so, else `unknown`."""
Turn = Literal["straight", "left", "right", "u_turn"]
Marking = Literal["none", "dashed", "solid", "double_solid", "solid_dashed", "dashed_solid", "double_dashed", "curb", "edge", "unknown"]
"""Marking of a lane's boundary as its driver sees it, own side first: `dashed_solid` may be crossed from this lane, `solid_dashed` not.
`curb`: the kerb or end of the pavement; `edge`: an edge line (broad lines count as what they separate)."""
SignalDirection = Literal["right", "straight", "left", "left_straight", "straight_right", "left_right", "all"]
CROSSABLE: frozenset[Marking] = frozenset(("none", "dashed", "dashed_solid", "double_dashed"))
"""Markings that say nothing against crossing; what the law makes of them is the law's. `unknown` is not among them."""


@dataclass(frozen=True)
class StopLine:
    """A limit line: its two ends (x, y) in metres, whether it is marked or stands for the entrance, and what makes it one."""

    id: str
    start: tuple[float, float]
    end: tuple[float, float]
    marked: bool = True
    lights: tuple[str, ...] = ()
    signs: tuple[str, ...] = ()


@dataclass(frozen=True)
class Phase:
    """One phase of a light's cycle: colour (`red`, `yellow`, `green`, `red_yellow`, `inactive`) and duration in seconds."""

    color: str
    duration: float


@dataclass(frozen=True)
class Light:
    """A traffic light: what movements it speaks to, and its nominal plan (no truth about any moment)."""

    id: str
    position: tuple[float, float] | None = None
    direction: SignalDirection = "all"
    active: bool = True
    cycle: tuple[Phase, ...] = ()
    offset: float = 0.0
    arrow: bool = False


@dataclass(frozen=True)
class Sign:
    """A sign: MUTCD code (`R2-1`, `R10-11`, `S1-1` …) where known, else the map's own; `values` as the map prints them; speeds in SI in `speed`."""

    id: str
    code: str
    position: tuple[float, float] | None = None
    values: tuple[str, ...] = ()
    speed: float | None = None


@dataclass(frozen=True, slots=True)
class Hours:
    """A span of the local day in seconds, half-open, on some weekdays (Monday 0; empty: all); one that ends before it begins runs over midnight."""

    start: int
    end: int
    weekdays: frozenset[int] = frozenset()


@dataclass(frozen=True)
class Zone:
    """An area with facts of its own: a school's road, a work zone, another jurisdiction.

    `polygon` (n, 2). `facts` hold inside it, in the vocabulary's words and SI. `kind` is for people and readers: `school`, `work`,
    `jurisdiction` … `jurisdiction`: the one that governs inside, None where the zone does not change it. `distance_fact`: the fact that takes
    the distance to `landmark` (x, y) (`school.distance`) for points in the zone, None without. `hours`: when the zone is one; empty: always.
    """

    id: str
    kind: str
    polygon: Floats
    facts: Mapping[str, Value] = field(default_factory=dict)
    jurisdiction: str | None = None
    distance_fact: str | None = None
    landmark: tuple[float, float] | None = None
    hours: tuple[Hours, ...] = ()


@dataclass(frozen=True)
class Crosswalk:
    """A crosswalk's area (n, 2), and whether it is marked."""

    id: str
    polygon: Floats
    marked: bool = True


@dataclass(frozen=True)
class Lane:
    """One lane: points in metres along the direction of travel, left, right and centre lines with the same number of rows (n, 2).

    `speed_limit`: m/s posted for it on the map, None unknown. `kinds`: the map's lane kinds (`urban`, `highway`, `bicycle_lane`,
    `crosswalk`, `sidewalk`, `shoulder`, `intersection`, `bus_lane`, `parking` …). `users`: who may use it in its direction; empty: unknown.
    `left`/`right`: neighbouring lane's id with `*_same_direction`. `turn`: how a lane within a junction leads, None elsewhere and
    where ways of different turns share it.
    `facts`: what the map knows of this lane in the vocabulary's words. `control`: for a lane within a junction, how the entry into it is regulated.
    """

    id: str
    left_line: Floats
    right_line: Floats
    center: Floats
    speed_limit: float | None = None
    kinds: frozenset[str] = frozenset()
    users: frozenset[str] = frozenset()
    users_both_ways: frozenset[str] = frozenset()
    left: str | None = None
    left_same_direction: bool = False
    right: str | None = None
    right_same_direction: bool = False
    left_marking: Marking = "unknown"
    right_marking: Marking = "unknown"
    predecessors: tuple[str, ...] = ()
    successors: tuple[str, ...] = ()
    stop_line: StopLine | None = None
    lights: tuple[str, ...] = ()
    signs: tuple[str, ...] = ()
    junction: str | None = None
    turn: Turn | None = None
    road: str | None = None
    facts: Mapping[str, Value] = field(default_factory=dict)
    control: Control = "unknown"

    @cached_property
    def stations(self) -> Floats:
        """Arc length of each centre point, metres, (n,)."""
        steps = np.hypot(*np.diff(self.center, axis=0).T)
        return np.concatenate(([0.0], np.cumsum(steps)))

    @property
    def length(self) -> float:
        """Length of the centre line, metres."""
        return float(self.stations[-1])

    @cached_property
    def widths(self) -> Floats:
        """Width at each centre point, metres, (n,)."""
        found: Floats = np.hypot(*(self.left_line - self.right_line).T)
        return found


@dataclass(frozen=True)
class Approach:
    """One way into a junction: the lanes that end at it, and the id of the approach that comes from its left, None unknown."""

    id: str
    lanes: tuple[str, ...]
    left_of: str | None = None


@dataclass(frozen=True)
class RoadJunction:
    """A junction: its approaches and the lanes within it. `derived`: found from the lanes' geometry, the file names none."""

    id: str
    lanes: tuple[str, ...]
    approaches: tuple[Approach, ...] = ()
    derived: bool = False


@dataclass(frozen=True)
class RoadMap:
    """All lanes by id, with the lights, signs, zones and crosswalks they refer to.

    `origin`: longitude and latitude of (0, 0) in degrees, where known. `facts`: what holds everywhere on it. `jurisdiction`: the one that
    governs where no zone says otherwise, None unknown. `source`: where it was read from, for people. `notes`: what a reader left out,
    repaired or took on trust, a sentence each.
    """

    lanes: Mapping[str, Lane]
    lights: Mapping[str, Light] = field(default_factory=dict)
    signs: Mapping[str, Sign] = field(default_factory=dict)
    zones: tuple[Zone, ...] = ()
    crosswalks: tuple[Crosswalk, ...] = ()
    origin: tuple[float, float] | None = None
    facts: Mapping[str, Value] = field(default_factory=dict)
    jurisdiction: str | None = None
    source: str = ""
    junctions: Mapping[str, RoadJunction] = field(default_factory=dict)
    notes: tuple[str, ...] = ()
