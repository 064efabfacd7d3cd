"""Streets while they are being laid: the lanes of every road with markings, neighbours and facts, joined end to end."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from regdb.vocabulary import FactError, Value, Vocabulary
from regdb_runtime.errors import WorldError
from regdb_runtime.maps.road_map import Floats, Lane, Marking, Sign
from regdb_runtime.worlds.curves import aside, middle_line
from regdb_runtime.worlds.road_spec import RoadEnd, RoadSpec, StreetsSpec

COMPASS = ("e", "ne", "n", "nw", "w", "sw", "s", "se")
_SEEN_FROM_THE_OTHER_SIDE: Mapping[Marking, Marking] = {"solid_dashed": "dashed_solid", "dashed_solid": "solid_dashed"}
_CENTER_FACT: Mapping[Marking, str] = {
    "none": "none", "dashed": "broken_yellow", "double_solid": "double_solid_yellow",
    "solid_dashed": "solid_on_right", "dashed_solid": "solid_on_left",
}  # fmt: skip


def compass(heading: float) -> str:
    """The compass point of a heading in radians: `e`, `ne`, `n` …"""
    return COMPASS[round(heading / (math.pi / 4)) % 8]


@dataclass(frozen=True, eq=False)
class Carriageway:
    """One direction of a road: its line is the road's middle, in the direction of travel; all lanes lie to the right of it."""

    road: RoadSpec
    backward: bool
    line: Floats
    headings: Floats
    lanes: tuple[str, ...]
    """General lanes from the right-hand edge to the middle."""
    bicycle: str | None

    def begins_at(self) -> RoadEnd:
        return "end" if self.backward else "start"

    def ends_at(self) -> RoadEnd:
        return "start" if self.backward else "end"

    @property
    def width(self) -> float:
        """From the middle line to the kerb, metres."""
        return len(self.lanes) * self.road.width + self.road.bicycle_lane + self.road.parking_lane


class Streets:
    """Lanes, signs and lights while they are being laid; `junction_builder` adds the junctions'."""

    def __init__(self, spec: StreetsSpec, vocabulary: Vocabulary) -> None:
        self.spec, self.vocabulary = spec, vocabulary
        self.lanes: dict[str, Lane] = {}
        self.signs: dict[str, Sign] = {}
        self.middles: dict[str, tuple[Floats, Floats]] = {}
        self.carriageways: list[Carriageway] = []
        for road in spec.roads:
            if road.id in self.middles:
                raise WorldError(f"there are two roads {road.id!r}")
            self._lay(road)

    def carriageway(self, road: str, *, backward: bool) -> Carriageway | None:
        """A road's one direction, None where it is one-way the other way. Raises WorldError for a road that is not there."""
        if road not in self.middles:
            raise WorldError(f"there is no road {road!r}; roads: {', '.join(self.middles)}")
        return next((item for item in self.carriageways if item.road.id == road and item.backward is backward), None)

    def read(self, facts: Mapping[str, object], place: str) -> dict[str, Value]:
        """Facts as people write them, in SI. Raises WorldError that names the place."""
        found: dict[str, Value] = {}
        for name, text in facts.items():
            try:
                value = self.vocabulary.fact(name).read(text)
            except FactError as error:
                raise WorldError(f"{place}: {error}") from None
            if value is not None:
                found[name] = value
        return found

    def add_link(self, lane: str, following: str) -> None:
        """Make one lane lead to another."""
        before, after = self.lanes[lane], self.lanes[following]
        self.lanes[lane] = replace(before, successors=(*before.successors, following))
        self.lanes[following] = replace(after, predecessors=(*after.predecessors, lane))

    def _lay(self, road: RoadSpec) -> None:
        if road.forward < 0 or road.backward < 0 or road.forward + road.backward == 0 or not road.pieces:
            raise WorldError(f"road {road.id!r} needs pieces and at least one lane")
        points, headings = middle_line(road.start, road.pieces)
        self.middles[road.id] = points, headings
        sides = []
        if road.forward:
            sides.append(_carriageway(road, points, headings, backward=False))
        if road.backward:
            sides.append(_carriageway(road, points[::-1], headings[::-1] + math.pi, backward=True))
        self.carriageways.extend(sides)
        for side in sides:
            other = next((item for item in sides if item is not side), None)
            self.lanes.update(_lanes(side, other, self.read(road.facts, f"road {road.id}")))


def _carriageway(road: RoadSpec, line: Floats, headings: Floats, *, backward: bool) -> Carriageway:
    stem = f"{road.id}.{compass(float(headings[0]))}"
    count = road.backward if backward else road.forward
    lanes = tuple(f"{stem}.{number}" for number in range(1, count + 1))
    return Carriageway(road, backward, line, headings, lanes, f"{stem}.bike" if road.bicycle_lane else None)


def _lanes(side: Carriageway, other: Carriageway | None, own_facts: dict[str, Value]) -> dict[str, Lane]:
    """All lanes of one direction, from the kerb to the middle."""
    road, count, width = side.road, len(side.lanes), side.road.width
    shared = _road_facts(side, other) | own_facts
    center: Marking = "edge" if other is None else _center(road, side.backward)
    found: dict[str, Lane] = {}
    for number, lane_id in enumerate(side.lanes, 1):
        inner = -(count - number) * width
        rightmost, leftmost = number == 1, number == count
        beyond = None if other is None or not leftmost or center == "curb" else other.lanes[-1]
        found[lane_id] = _lane(
            lane_id, side, inner, width, ("urban",), ("vehicle", "bicycle"),
            shared | {"ego.lane_from_right": float(number), "ego.lane_position": _position(number, count), "lane.width": width},
            left=side.lanes[number] if not leftmost else beyond, left_same_direction=not leftmost,
            right=side.lanes[number - 2] if not rightmost else side.bicycle, right_same_direction=not rightmost or side.bicycle is not None,
            left_marking=center if leftmost else road.divider,
            right_marking=_edge(road) if rightmost else _SEEN_FROM_THE_OTHER_SIDE.get(road.divider, road.divider),
        )  # fmt: skip
    if side.bicycle is not None:
        found[side.bicycle] = _lane(
            side.bicycle, side, -count * width, road.bicycle_lane, ("urban", "bicycle_lane"), ("bicycle",),
            shared | {"lane.kind": "bicycle", "ego.lane_position": "bicycle_lane", "lane.width": road.bicycle_lane},
            left=side.lanes[0], left_same_direction=True, left_marking="solid", right_marking="dashed" if road.parking_lane else "curb",
        )  # fmt: skip
    if road.parking_lane:
        # No neighbour of the driven lanes: nobody changes into it, one draws up in it.
        parking = f"{side.lanes[0].rsplit('.', 1)[0]}.parking"
        found[parking] = _lane(
            parking, side, -count * width - road.bicycle_lane, road.parking_lane, ("urban", "parking"), ("vehicle",),
            shared | {"lane.kind": "parking", "lane.width": road.parking_lane}, left_marking="none", right_marking="curb",
        )  # fmt: skip
    return found


def _lane(
    lane_id: str, side: Carriageway, inner: float, width: float, kinds: tuple[str, ...], users: tuple[str, ...], facts: Mapping[str, Value],
    *, left: str | None = None, left_same_direction: bool = False, right: str | None = None, right_same_direction: bool = False,
    left_marking: Marking = "unknown", right_marking: Marking = "unknown",
) -> Lane:  # fmt: skip
    left_line, right_line = aside(side.line, side.headings, inner), aside(side.line, side.headings, inner - width)
    return Lane(
        lane_id, left_line, right_line, (left_line + right_line) / 2, side.road.limit, frozenset(kinds), frozenset(users), frozenset(),
        left, left_same_direction, right, right_same_direction, left_marking, right_marking, road=side.road.id, facts=dict(facts),
    )  # fmt: skip


def _edge(road: RoadSpec) -> Marking:
    if road.bicycle_lane:
        return "solid"
    return "none" if road.parking_lane else "curb"


def _center(road: RoadSpec, backward: bool) -> Marking:
    return _SEEN_FROM_THE_OTHER_SIDE.get(road.center, road.center) if backward else road.center


def _position(number: int, count: int) -> str:
    if count == 1:
        return "only"
    return "rightmost" if number == 1 else "leftmost" if number == count else "middle"


def _road_facts(side: Carriageway, other: Carriageway | None) -> dict[str, Value]:
    road = side.road
    lanes = road.forward + road.backward
    divided = road.center == "curb" and other is not None
    types = {"highway"} | ({"two_lane_undivided"} if lanes == 2 and other is not None and not divided else set())
    return {
        "road.lanes": float(lanes), "road.lanes_same_direction": float(len(side.lanes)),
        "road.one_way": other is None, "road.two_way": other is not None,
        "road.width": side.width + (0.0 if other is None or divided else other.width), "road.types": frozenset(types), "road.divided": divided,
        "lane.center_marking": "none" if other is None or divided else _CENTER_FACT.get(_center(road, side.backward), "other"),
        "bicycle_lane.present": road.bicycle_lane > 0.0, "lane.kind": "general",
    }  # fmt: skip


def join_ends(streets: Streets, at_junctions: frozenset[tuple[str, RoadEnd]]) -> None:
    """Lead lanes on where one direction's end coincides with another's beginning and no junction lies between."""
    for before in streets.carriageways:
        if (before.road.id, before.ends_at()) in at_junctions:
            continue
        for after in streets.carriageways:
            apart = np.hypot(*(before.line[-1] - after.line[0]))
            bend = abs(math.remainder(float(before.headings[-1] - after.headings[0]), 2 * math.pi))
            if after.road is not before.road and apart < 0.2 and bend < math.radians(3):
                for number, lane in enumerate(before.lanes):
                    streets.add_link(lane, after.lanes[min(number, len(after.lanes) - 1)])
                if before.bicycle is not None and after.bicycle is not None:
                    streets.add_link(before.bicycle, after.bicycle)


def place_on(streets: Streets, road: str, station: float, offset: float = 0.0) -> tuple[float, float]:
    """The point (x, y) at a station of a road's middle line, `offset` metres to the left of it. Raises WorldError beyond its ends."""
    streets.carriageway(road, backward=False)
    points, headings = streets.middles[road]
    stations = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))))
    if not -1e-6 <= station <= stations[-1] + 0.5:
        raise WorldError(f"road {road!r} is {stations[-1]:.1f} m long; {station:g} m is not on it")
    x, y, heading = (float(np.interp(station, stations, row)) for row in (points[:, 0], points[:, 1], headings))
    return x - offset * math.sin(heading), y + offset * math.cos(heading)
