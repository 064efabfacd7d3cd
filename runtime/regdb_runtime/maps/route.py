"""Routes: the cheapest way along lanes and lane changes, kept as segments so that every lane of one knows where it must go."""

from __future__ import annotations

import heapq
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Literal

from regdb_runtime.errors import NoRoute
from regdb_runtime.maps.junctions import side_by_side, turn_along
from regdb_runtime.maps.lane_graph import is_driven
from regdb_runtime.maps.road_map import CROSSABLE, Lane, RoadMap, Turn


@dataclass(frozen=True, slots=True)
class RouteSettings:
    """What a lane change costs beside the length of lanes, metres: along a line that may be crossed, and along one of unknown marking."""

    lane_change: float = 20.0
    unknown_marking: float = 60.0


@dataclass(frozen=True, slots=True)
class NextTurn:
    """The next junction on a route: the lane within, how it leads, and how far off it begins (metres along the route, lane changes not counted)."""

    lane: str
    junction: str
    turn: Turn
    distance: float


@dataclass(frozen=True)
class Route:
    """The lanes of a route, one per segment: the one by which the segment is left; `segments`: all driven lanes of each, from left to right."""

    lanes: tuple[str, ...]
    segments: tuple[tuple[str, ...], ...]
    road_map: RoadMap = field(repr=False, compare=False)
    _places: Mapping[str, int] = field(repr=False, compare=False, default_factory=dict)

    @property
    def goal(self) -> str:
        """The last lane."""
        return self.lanes[-1]

    def segment_of(self, lane: str) -> int | None:
        """The number of the segment a lane belongs to, the last one where a route comes by twice; None off the route."""
        return self._places.get(lane)

    def lanes_on_segment(self, lane: str) -> tuple[str, ...]:
        """All driven lanes beside this one on its segment of the route, itself among them, from left to right; empty off the route."""
        place = self.segment_of(lane)
        return () if place is None else self.segments[place]

    def leads_on(self, lane: str) -> bool:
        """Whether the route goes on from this lane, or ends in it, without a lane change."""
        return self.onward(lane) is not None or lane == self.goal

    def onward(self, lane: str) -> str | None:
        """The lane that follows this one on the route, None where a lane change must come first, at the end, and off the route."""
        place = self.segment_of(lane)
        if place is None or place + 1 >= len(self.lanes):
            return None
        following = self.road_map.lanes[lane].successors
        if lane == self.lanes[place] and self.lanes[place + 1] in following:
            return self.lanes[place + 1]
        fitting = [name for name in following if name in self.segments[place + 1]]
        return min(fitting, key=lambda name: (abs(self.changes(name)), name)) if fitting else None

    def changes(self, lane: str) -> int:
        """Lane changes from this lane to the nearest one of its segment that leads on: positive to the left, 0 for none and off the route."""
        place = self.segment_of(lane)
        if place is None:
            return 0
        row = self.segments[place]
        here = row.index(lane)
        ways = [here - row.index(name) for name in row if self._leaves(name, place)]
        return min(ways, key=lambda count: (abs(count), count), default=0)

    def _leaves(self, lane: str, place: int) -> bool:
        if lane == self.lanes[place]:
            return True
        if place + 1 >= len(self.lanes):
            return False
        return any(name in self.segments[place + 1] for name in self.road_map.lanes[lane].successors)

    def next_turn(self, lane: str, station: float = 0.0) -> NextTurn | None:
        """The next junction from a station of a lane on, the present one where the lane lies in it; None without one or off the route."""
        place = self.segment_of(lane)
        if place is None:
            return None
        distance = -station
        for index in range(place, len(self.lanes)):
            name = lane if index == place else self.lanes[index]
            found = self.road_map.lanes[name]
            if found.junction is not None:
                return NextTurn(name, found.junction, turn_along(self.road_map.lanes, self._way(name, index)), max(distance, 0.0))
            distance += found.length
        return None

    def _way(self, lane: str, place: int) -> list[str]:
        """The lanes of the junction from this one on."""
        way = [lane]
        for name in self.lanes[place + 1 :]:
            if self.road_map.lanes[name].junction != self.road_map.lanes[lane].junction:
                break
            way.append(name)
        return way

    def remaining(self, lane: str, station: float) -> float:
        """Metres from a station of a lane to the end of the route; NoRoute off the route."""
        place = self.segment_of(lane)
        if place is None:
            raise NoRoute(f"lane {lane} is not on the route to {self.goal}")
        return self.road_map.lanes[lane].length - station + sum(self.road_map.lanes[name].length for name in self.lanes[place + 1 :])


def find_route(road_map: RoadMap, start_lane: str, goal_lane: str, settings: RouteSettings | None = None) -> Route:
    """The cheapest route between two lanes: length of lanes, and a price per lane change, which markings that may not be crossed forbid.

    NoRoute where none leads there or a lane is not on the map; ties are broken by id.
    """
    for lane in (start_lane, goal_lane):
        _on_map(road_map, lane)
    steps = _cheapest(road_map, start_lane, goal_lane, settings or RouteSettings())
    return route_along(road_map, steps)


def _on_map(road_map: RoadMap, lane: str) -> None:
    if lane not in road_map.lanes:
        raise NoRoute(f"lane {lane} is not on the map {road_map.source}".rstrip())


def route_through(road_map: RoadMap, lanes: Sequence[str], settings: RouteSettings | None = None) -> Route:
    """The cheapest route through lanes in their order, lane changes and lanes between them added where needed. NoRoute."""
    for lane in lanes:
        _on_map(road_map, lane)
    steps = tuple(lanes[:1])
    for before, lane in pairwise(lanes):
        steps += _cheapest(road_map, before, lane, settings or RouteSettings())[1:]
    return route_along(road_map, steps)


def route_along(road_map: RoadMap, steps: tuple[str, ...]) -> Route:
    """A route from lanes in order, each following the one before or beside it; NoRoute where one does neither."""
    lanes: list[str] = []
    for before, lane in zip((None, *steps), steps, strict=False):
        if before is not None and lane in side_by_side(road_map.lanes, before):
            lanes[-1] = lane
        elif before is None or lane in road_map.lanes[before].successors:
            lanes.append(lane)
        else:
            raise NoRoute(f"lane {lane} neither follows lane {before} nor runs beside it")
    segments = tuple(_segment(road_map, lanes, index) for index in range(len(lanes)))
    places = {name: index for index, row in enumerate(segments) for name in row}
    return Route(tuple(lanes), segments, road_map, places)


def _segment(road_map: RoadMap, lanes: list[str], index: int) -> tuple[str, ...]:
    """The lanes of a segment; within a junction also those that lead the same way from and to the neighbours of the route's lane."""
    lane = road_map.lanes[lanes[index]]
    beside = [name for name in side_by_side(road_map.lanes, lane.id) if is_driven(road_map.lanes[name]) or name == lane.id]
    if lane.junction is None or not 0 < index < len(lanes) - 1:
        return tuple(beside)
    before = side_by_side(road_map.lanes, lanes[index - 1])
    after = side_by_side(road_map.lanes, lanes[index + 1])
    parallel = [
        name for entry in before for name in road_map.lanes[entry].successors
        if _parallel(lane, road_map.lanes[name]) and set(road_map.lanes[name].successors) & set(after)
    ]  # fmt: skip
    return tuple(dict.fromkeys(parallel)) if set(beside) <= set(parallel) else tuple(beside)


def _parallel(lane: Lane, other: Lane) -> bool:
    return other.junction == lane.junction and other.turn == lane.turn and is_driven(other)


def _cheapest(road_map: RoadMap, start: str, goal: str, settings: RouteSettings) -> tuple[str, ...]:
    """Dijkstra over lanes; the lanes passed through in order, changes of lane included."""
    waiting: list[tuple[float, str, str | None]] = [(0.0, start, None)]
    came_from: dict[str, str | None] = {}
    while waiting:
        cost, lane, before = heapq.heappop(waiting)
        if lane in came_from:
            continue
        came_from[lane] = before
        if lane == goal:
            return _traced(came_from, goal)
        for price, following in _steps(road_map, road_map.lanes[lane], settings):
            if following not in came_from and (following == goal or is_driven(road_map.lanes[following])):
                heapq.heappush(waiting, (cost + price, following, lane))
    raise NoRoute(f"no lanes lead from {start} to {goal}")


def _steps(road_map: RoadMap, lane: Lane, settings: RouteSettings) -> list[tuple[float, str]]:
    steps = [(lane.length, name) for name in lane.successors]
    if lane.junction is not None:
        return steps
    for beside, same, marking in (
        (lane.left, lane.left_same_direction, lane.left_marking),
        (lane.right, lane.right_same_direction, lane.right_marking),
    ):
        if beside is not None and same and beside in road_map.lanes and marking in (*CROSSABLE, "unknown"):
            steps.append((settings.unknown_marking if marking == "unknown" else settings.lane_change, beside))
    return steps


def _traced(came_from: Mapping[str, str | None], goal: str) -> tuple[str, ...]:
    steps = [goal]
    while (before := came_from[steps[-1]]) is not None:
        steps.append(before)
    return tuple(reversed(steps))


MoveKind = Literal["straight", "left", "right", "u_turn", "lane_change_left", "lane_change_right"]


@dataclass(frozen=True, slots=True)
class Move:
    """A way on from a lane: into a following lane, or beside. `needed`: the route asks for it; `within`: metres in which it must happen."""

    kind: MoveKind
    lane: str
    needed: bool
    within: float


def next_moves(road_map: RoadMap, route: Route, lane: str, station: float = 0.0) -> tuple[Move, ...]:
    """The ways on from a station of a lane: its following segments and the lanes beside it, those the route needs first, then by kind and id."""
    here = road_map.lanes[lane]
    left_to_go = here.length - station
    onward, changes = route.onward(lane), route.changes(lane)
    moves = [Move(_kind(road_map, name), name, name == onward, left_to_go) for name in here.successors]
    if here.junction is None:
        reach = _distance_to_leave(road_map, route, lane, station)
        if here.left is not None and here.left_same_direction:
            moves.append(Move("lane_change_left", here.left, changes > 0, reach))
        if here.right is not None and here.right_same_direction:
            moves.append(Move("lane_change_right", here.right, changes < 0, reach))
    return tuple(sorted(moves, key=lambda move: (not move.needed, move.kind, move.lane)))


def _kind(road_map: RoadMap, lane: str) -> MoveKind:
    """How a following lane leads: within a junction its turn, elsewhere straight on."""
    return "straight" if road_map.lanes[lane].junction is None else turn_along(road_map.lanes, [lane])


def _distance_to_leave(road_map: RoadMap, route: Route, lane: str, station: float) -> float:
    """Metres to the place where the route leaves this lane or the lane ends at a junction: the room for lane changes."""
    distance, seen = road_map.lanes[lane].length - station, {lane}
    onward = route.onward(lane)
    while onward is not None and onward not in seen and road_map.lanes[onward].junction is None:
        distance += road_map.lanes[onward].length
        seen.add(onward)
        onward = route.onward(onward)
    return max(distance, 0.0)
