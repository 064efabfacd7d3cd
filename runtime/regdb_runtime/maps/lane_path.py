"""Paths along lanes: the lanes ahead and behind on a route, one smooth line through their centres, and the next junction on it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np

from regdb_runtime.maps.junctions import turn_along
from regdb_runtime.maps.lines import angle, crossing, headings, inside
from regdb_runtime.maps.reference_path import ReferencePath
from regdb_runtime.maps.road_map import Control, Floats, Lane, RoadMap, SignalDirection, StopLine, Turn
from regdb_runtime.maps.route import Route

JOINT = 1.0
"""Lane ends nearer than this to the next lane's beginning, metres, are one point of the path: the middle between them."""
SPEAKS_TO: dict[SignalDirection, frozenset[Turn]] = {
    "all": frozenset(("straight", "left", "right", "u_turn")),
    "straight": frozenset(("straight",)),
    "left": frozenset(("left", "u_turn")),
    "right": frozenset(("right",)),
    "left_straight": frozenset(("left", "u_turn", "straight")),
    "straight_right": frozenset(("straight", "right")),
    "left_right": frozenset(("left", "u_turn", "right")),
}


@dataclass(frozen=True, slots=True)
class JunctionReach:
    """How far before a junction's entrance (a crosswalk: also beyond its exit) what belongs to it may stand; how finely paths are sampled. Metres."""

    stop_line_before: float = 30.0
    crosswalk_before: float = 15.0
    sample: float = 0.25


@dataclass(frozen=True, slots=True)
class LaneSpan:
    """The part of a path that runs along one lane: stations along the path, and the lane's own station at `start`."""

    lane: str
    start: float
    end: float
    lane_start: float = 0.0


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
class LanePath:
    """A path along lanes, one after the other, with the stations of each. `crossed` remembers the junctions found on it, per map."""

    path: ReferencePath
    spans: tuple[LaneSpan, ...]
    crossed: dict[int, tuple[Junction, ...]] = field(default_factory=dict, repr=False)

    @property
    def lanes(self) -> tuple[str, ...]:
        """The lanes in order."""
        return tuple(span.lane for span in self.spans)

    def lane_at(self, station: float) -> LaneSpan:
        """The span at a station; the first or last beyond the ends."""
        for span in self.spans:
            if station < span.end:
                return span
        return self.spans[-1]

    def span_of(self, lane: str) -> LaneSpan | None:
        """The first span along a lane, None where the path does not run along it."""
        return next((span for span in self.spans if span.lane == lane), None)


def lane_path(
    road_map: RoadMap, route: Route | None, lane: str, length_ahead: float, length_behind: float, station: float = 0.0
) -> LanePath:
    """The path along a lane's centre, on along the route, whole lanes: from the one that lies `length_behind` metres before `station` of the
    lane to the one that lies `length_ahead` beyond it, or to the map's ends. Since lanes are taken whole, the path stays the same line while
    the vehicle moves on within them.

    Where the route cannot be followed without a lane change, and without a route, the path follows the straightest way.
    """
    return path_along(road_map, lanes_along(road_map, route, lane, length_ahead, length_behind, station))


class LanePaths:
    """Paths of one map, each built once: a spline costs a millisecond, and the same lanes are asked for at every tick."""

    def __init__(self, road_map: RoadMap, capacity: int = 256) -> None:
        self.road_map, self.capacity = road_map, capacity
        self._known: dict[tuple[str, ...], LanePath] = {}

    def ahead(self, route: Route | None, lane: str, length_ahead: float, length_behind: float, station: float = 0.0) -> LanePath:
        """As `lane_path`."""
        return self.along(lanes_along(self.road_map, route, lane, length_ahead, length_behind, station))

    def along(self, lanes: tuple[str, ...]) -> LanePath:
        """As `path_along`; the oldest path is forgotten when there are too many."""
        found = self._known.get(lanes)
        if found is None:
            if len(self._known) >= self.capacity:
                del self._known[next(iter(self._known))]
            found = self._known[lanes] = path_along(self.road_map, lanes)
        return found


def lanes_along(
    road_map: RoadMap, route: Route | None, lane: str, length_ahead: float, length_behind: float, station: float = 0.0
) -> tuple[str, ...]:
    """The lanes of `lane_path`, in order."""
    lanes = [lane]
    ahead = road_map.lanes[lane].length - station
    while ahead < length_ahead and (onward := _onward(road_map, route, lanes[-1])) is not None:
        lanes.append(onward)
        ahead += road_map.lanes[onward].length
    behind = station
    while behind < length_behind and (before := _before(road_map, route, lanes[0])) is not None:
        lanes.insert(0, before)
        behind += road_map.lanes[before].length
    return tuple(lanes)


def _onward(road_map: RoadMap, route: Route | None, lane: str) -> str | None:
    onward = None if route is None else route.onward(lane)
    return onward if onward is not None else _straightest(road_map, lane, road_map.lanes[lane].successors)


def _before(road_map: RoadMap, route: Route | None, lane: str) -> str | None:
    """The lane before: on the route's segment before this one, else the one from which the way is straightest."""
    before = road_map.lanes[lane].predecessors
    place = None if route is None else route.segment_of(lane)
    if route is not None and place:
        on_route = [name for name in before if name in route.segments[place - 1]]
        before = tuple(on_route) or before
    return _straightest(road_map, lane, before, backward=True)


def _straightest(road_map: RoadMap, lane: str, ways: Iterable[str], *, backward: bool = False) -> str | None:
    """Of the lanes that follow (or precede), the one that turns least over its length and the joint; ties by id."""
    here = headings(road_map.lanes[lane].center)

    def bend(name: str) -> tuple[float, str]:
        there = headings(road_map.lanes[name].center)
        joint = angle(here[0] - there[1]) if backward else angle(there[0] - here[1])
        return abs(joint) + abs(angle(there[1] - there[0])), name

    return min(ways, key=bend, default=None)


def path_along(road_map: RoadMap, lanes: tuple[str, ...]) -> LanePath:
    """One smooth path through the centres of lanes that follow each other, with the stations of each lane's joints."""
    points, joints = _joined([road_map.lanes[lane].center for lane in lanes])
    path = ReferencePath(points)
    at = path.project(points[joints[1:-1]], extend=True)[0] if len(lanes) > 1 else np.empty(0)
    edges = [0.0, *(float(value) for value in at), path.length]
    return LanePath(path, tuple(LaneSpan(lane, edges[index], edges[index + 1]) for index, lane in enumerate(lanes)))


def _joined(centers: list[Floats]) -> tuple[Floats, list[int]]:
    """All points in order without repeats, and the row at which each centre line begins (and the last row)."""
    points, joints = [centers[0]], [0]
    count = len(centers[0])
    for center in centers[1:]:
        if np.hypot(*(center[0] - points[-1][-1])) < JOINT:
            middle = (center[0] + points[-1][-1]) / 2
            points[-1] = np.vstack((points[-1][:-1], middle))
            joints.append(count - 1)
            center = center[1:]
        else:
            joints.append(count)
        points.append(center)
        count += len(center)
    return np.vstack(points), [*joints, count - 1]


def next_junction(road_map: RoadMap, lane_path: LanePath, station: float) -> Junction | None:
    """The first junction on the path that ends beyond a station (of the front bumper), None without one.

    `stop_station` is where the limit line crosses the path, else where the crosswalk before the junction begins, else the entrance, and never
    beyond the entrance.
    """
    known = lane_path.crossed.get(id(road_map))
    if known is None:
        known = lane_path.crossed[id(road_map)] = tuple(_junctions(road_map, lane_path, JunctionReach()))
    return next((junction for junction in known if junction.exit > station), None)


def _junctions(road_map: RoadMap, lane_path: LanePath, reach: JunctionReach) -> list[Junction]:
    found, spans, index = [], lane_path.spans, 0
    while index < len(spans):
        name = road_map.lanes[spans[index].lane].junction
        last = index
        while name is not None and last + 1 < len(spans) and road_map.lanes[spans[last + 1].lane].junction == name:
            last += 1
        if name is not None:
            found.append(_junction(road_map, lane_path, name, index, last, reach))
        index = last + 1
    return found


def _junction(road_map: RoadMap, lane_path: LanePath, name: str, first: int, last: int, reach: JunctionReach) -> Junction:
    """The junction along spans first to last."""
    spans = lane_path.spans
    entrance, leaving = spans[first].start, spans[last].end
    inner = road_map.lanes[spans[first].lane]
    turn = turn_along(road_map.lanes, [span.lane for span in spans[first : last + 1]])
    approach = road_map.lanes[spans[first - 1].lane] if first else None
    line = _stop_line(road_map, lane_path, first, reach) or _line_within(road_map, lane_path, first)
    crosswalks = _crosswalks(road_map, lane_path, entrance - reach.crosswalk_before, leaving + reach.crosswalk_before, reach.sample)
    stop_station = entrance
    if line is not None:
        stop_station = min(line[0], entrance)
    elif crosswalks:
        stop_station = min(crosswalks[0][0], entrance)
    lights = _lights(road_map, approach, inner, line, turn)
    return Junction(
        name, stop_station, entrance, leaving, turn, _control(inner, approach, line), lights,
        tuple(crosswalk for _, crosswalk in crosswalks), line is not None and line[1].marked,
    )  # fmt: skip


def _stop_line(road_map: RoadMap, lane_path: LanePath, first: int, reach: JunctionReach) -> tuple[float, StopLine] | None:
    """The last stop line before span `first`, with its station; not beyond another junction, nor too far off."""
    for index in range(first - 1, -1, -1):
        span, lane = lane_path.spans[index], road_map.lanes[lane_path.spans[index].lane]
        if lane.junction is not None or lane_path.spans[first].start - span.end > reach.stop_line_before:
            return None
        if lane.stop_line is not None:
            return _line_station(lane_path, span, lane, lane.stop_line), lane.stop_line
    return None


def _line_within(road_map: RoadMap, lane_path: LanePath, first: int) -> tuple[float, StopLine] | None:
    """A stop line that the map gives to the lane within the junction, as some Lanelet2 maps do."""
    span = lane_path.spans[first]
    lane = road_map.lanes[span.lane]
    return None if lane.stop_line is None else (_line_station(lane_path, span, lane, lane.stop_line), lane.stop_line)


def _line_station(lane_path: LanePath, span: LaneSpan, lane: Lane, line: StopLine) -> float:
    """Where a stop line crosses the path: where it crosses the lane's centre, else beside its middle."""
    met = crossing(lane.center, np.array([line.start, line.end]))
    if met is not None:
        return span.start + (met[0] - span.lane_start) * (span.end - span.start) / (lane.length - span.lane_start)
    middle = [((line.start[0] + line.end[0]) / 2, (line.start[1] + line.end[1]) / 2)]
    return float(lane_path.path.project(middle, extend=True)[0][0])


def _crosswalks(road_map: RoadMap, lane_path: LanePath, start: float, end: float, sample: float) -> list[tuple[float, str]]:
    """Crosswalks that the path crosses between two stations, in order, with the station where each begins."""
    if not road_map.crosswalks:
        return []
    at = np.arange(max(start, 0.0), min(end, lane_path.path.length), sample)
    if not len(at):
        return []
    points = lane_path.path.to_plane(at, 0.0)
    hits = [(walk.id, inside(points, walk.polygon)) for walk in road_map.crosswalks]
    return sorted((float(at[int(np.argmax(within))]), name) for name, within in hits if within.any())


def _lights(road_map: RoadMap, approach: Lane | None, inner: Lane, line: tuple[float, StopLine] | None, turn: Turn) -> tuple[str, ...]:
    """The lights of the approach, the stop line and the lane within that speak to a turn."""
    carried = (*(approach.lights if approach else ()), *(line[1].lights if line else ()), *inner.lights)
    return tuple(name for name in dict.fromkeys(carried) if turn in SPEAKS_TO[road_map.lights[name].direction])


def _control(inner: Lane, approach: Lane | None, line: tuple[float, StopLine] | None) -> Control:
    """What the lane within says, else a signal where the approach has lights at all."""
    if inner.control != "unknown":
        return inner.control
    return "signal" if (approach is not None and approach.lights) or (line is not None and line[1].lights) else "unknown"
