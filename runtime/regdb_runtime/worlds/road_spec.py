"""Streets in a few readable lines: roads of straight and curved pieces, junctions where their ends meet, signal phases, signs and zones."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from regdb_runtime.maps.road_map import Marking, Turn

Control = Literal["signal", "stop", "all_way_stop", "yield", "none"]
RoadEnd = Literal["start", "end"]


@dataclass(frozen=True, slots=True)
class Pose:
    """A place and a direction: metres; degrees anticlockwise of east (0 east, 90 north, 180 west, 270 south)."""

    x: float = 0.0
    y: float = 0.0
    degrees: float = 0.0


@dataclass(frozen=True, slots=True)
class Piece:
    """A piece of a road's middle line: `length` metres; `radius` 0 is straight, positive curves to the left, negative to the right.

    A curve begins and ends with a clothoid (a third of its length, `curves.TRANSITION` at most), so curvature never jumps.
    """

    length: float
    radius: float = 0.0


@dataclass(frozen=True)
class RoadSpec:
    """A road without junctions. Its middle line divides the directions; `forward` lanes lie to the right of it, `backward` ones to the left.

    `width` of a lane, `bicycle_lane` and `parking_lane` (width, 0 without; kerb side, both directions) in metres; `limit` in m/s, posted for
    it, None where nothing is posted; `center` is the marking as seen from the forward direction; `facts`: of the vocabulary, as people write
    them. Lanes are named `road.e.1`: the compass point they lead to at their beginning, and their number from the right-hand edge.
    """

    id: str
    pieces: tuple[Piece, ...]
    start: Pose = field(default_factory=Pose)
    forward: int = 1
    backward: int = 1
    width: float = 3.5
    limit: float | None = 15.6464
    center: Marking = "dashed"
    divider: Marking = "dashed"
    bicycle_lane: float = 0.0
    parking_lane: float = 0.0
    facts: Mapping[str, object] = field(default_factory=dict)


@dataclass(frozen=True)
class Arm:
    """One road's end at a junction. `arrows`: turns with an arrow head of their own besides the circular one.

    `allowed`: turns that this arm's traffic may make; empty: all that the junction's shape offers. `right_turn_lane`/`left_turn_lane`: the
    outermost lane is for that turn alone. `crosswalk`: whether one is marked; None: where something controls the arm. `control` overrides the
    junction's for this arm (`none` beside a `stop`: the main road).
    """

    road: str
    end: RoadEnd
    arrows: tuple[Turn, ...] = ()
    allowed: tuple[Turn, ...] = ()
    right_turn_lane: bool = False
    left_turn_lane: bool = False
    crosswalk: bool | None = None
    stop_line: bool = True
    control: Control | None = None


@dataclass(frozen=True, slots=True)
class SignalPhase:
    """Heads that are green together for `green` seconds, then `yellow`, then all red; a head green in the next phase too stays green.

    A head is named by the compass point its traffic drives to, with the turn of an arrow: `e`, `w`, `e.right`, `n.left`.
    """

    heads: tuple[str, ...]
    green: float
    yellow: float = 3.5
    all_red: float = 1.5


@dataclass(frozen=True)
class JunctionSpec:
    """Where ends of roads meet. `phases` run in a circle from `offset` seconds before the run begins; heads in no phase stay red."""

    id: str
    arms: tuple[Arm, ...]
    control: Control = "none"
    phases: tuple[SignalPhase, ...] = ()
    offset: float = 0.0


@dataclass(frozen=True)
class SignSpec:
    """A sign beside a road at a station of its middle line (metres from its start): MUTCD code; `speed` in m/s where it shows one."""

    id: str
    code: str
    road: str
    station: float
    direction: Literal["forward", "backward"] = "forward"
    speed: float | None = None
    values: tuple[str, ...] = ()


@dataclass(frozen=True)
class ZoneSpec:
    """A zone along a road from one station of its middle line to another, over the whole width and `margin` metres beyond, or a `polygon`.

    `facts` as people write them. `landmark`: the place that `distance_fact` measures the distance to. `hours`: seconds of the local day from and
    to which the zone is one; empty: always.
    """

    id: str
    kind: str
    road: str = ""
    start: float = 0.0
    end: float = 0.0
    margin: float = 2.0
    polygon: tuple[tuple[float, float], ...] = ()
    facts: Mapping[str, object] = field(default_factory=dict)
    jurisdiction: str | None = None
    distance_fact: str | None = None
    landmark: tuple[float, float] | None = None
    hours: tuple[tuple[int, int], ...] = ()


@dataclass(frozen=True)
class StreetsSpec:
    """All streets of a world. Road ends that coincide without a junction are joined lane to lane, counted from the right-hand edge."""

    roads: tuple[RoadSpec, ...]
    junctions: tuple[JunctionSpec, ...] = ()
    signs: tuple[SignSpec, ...] = ()
    zones: tuple[ZoneSpec, ...] = ()
    jurisdiction: str = "los_angeles"
    facts: Mapping[str, object] = field(default_factory=dict)
