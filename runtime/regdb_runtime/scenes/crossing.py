"""Where other ways through a junction meet the planned one, and who is on his way there: how far, how fast, from which side."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from regdb_runtime.maps.junctions import side_by_side
from regdb_runtime.maps.lines import at_stations, project
from regdb_runtime.maps.road_map import Floats, Lane, RoadMap
from regdb_runtime.observation import Track
from regdb_runtime.scenes.lane_facts import NOT_FOR_TRAFFIC

From = Literal["same", "cross", "oncoming"]
"""From which highway somebody comes: the planned movement's own approach, another highway, or the opposite direction of the same one."""


@dataclass(frozen=True, slots=True)
class CrossingSettings:
    """Metres and radians. `meets`: two ways meet where their middles come so near: a car's width with half a metre of room."""

    meets: float = 2.3
    sample: float = 0.5
    beyond: float = 25.0
    """How far beyond the junction ways that end in one lane are still compared."""
    upstream: float = 120.0
    """How far before the junction others are looked for."""
    beside_way: float = 2.0
    """A vehicle whose middle is no farther from a way's middle is on it."""
    along_way: float = math.radians(50)
    """... and whose heading differs by no more from the way's."""
    opposite: float = math.radians(135)
    same: float = math.radians(45)


@dataclass(frozen=True, slots=True)
class Way:
    """One other way that meets the planned one: lane within the junction, where its traffic comes from, and the turn it makes."""

    lane: str
    entry: str
    comes_from: From
    turn: str
    bearing: float
    """Of its approach relative to the planned one's, radians: positive comes from the right."""
    line: float = 0.0
    """Metres from where its traffic stops (its limit line) to the junction's edge."""


@dataclass(frozen=True, slots=True)
class Arriving:
    """A road user on a way that meets the plan's: metres from its front to the meeting place (negative: in it), and to the junction's edge."""

    track: Track
    way: Way
    to_meeting: float
    to_entrance: float
    inside: bool


class Crossings:
    """The ways that meet one planned way through a junction, ready to place road users on them."""

    def __init__(self, road_map: RoadMap, inner: Sequence[str], settings: CrossingSettings | None = None) -> None:
        self.settings = settings or CrossingSettings()
        self.ways: list[Way] = []
        self._ends: list[tuple[float, float]] = []
        parts: list[Floats] = []
        names = set(inner)
        junction = road_map.lanes[inner[0]].junction
        planned = _line(road_map, inner, self.settings)
        entry = _entries(road_map, inner[0])
        for lane in sorted(road_map.lanes):
            other = road_map.lanes[lane]
            if other.junction == junction and lane not in names and not other.kinds & NOT_FOR_TRAFFIC:
                self._add(road_map, other, planned, entry, parts)
        self._segments = np.vstack(parts) if parts else np.empty((0, 7))
        ends = self._segments[:, :2] + self._segments[:, 2:4] * self._segments[:, 4:5]
        corners = np.vstack((self._segments[:, :2], ends)) if parts else np.zeros((1, 2))
        self._box = (*(corners.min(axis=0) - self.settings.beside_way).tolist(), *(corners.max(axis=0) + self.settings.beside_way).tolist())
        self._last: tuple[object, tuple[Arriving, ...]] = (None, ())

    def _add(self, road_map: RoadMap, lane: Lane, planned: Floats, entry: frozenset[str], parts: list[Floats]) -> None:
        if set(lane.predecessors) & entry:
            return
        own = _line(road_map, (lane.id,), self.settings)
        gaps = np.hypot(*(own[:, None, :2] - planned[None, :, :2]).transpose(2, 0, 1)).min(axis=1)
        meeting = np.flatnonzero(gaps < self.settings.meets)
        if not len(meeting):
            return
        starts, ends = float(own[meeting[0], 2]), min(float(own[meeting[-1], 2]), lane.length)  # who has left the junction is ahead, not crossing
        turned = math.remainder(_first_heading(lane.center) - math.atan2(planned[1, 1] - planned[0, 1], planned[1, 0] - planned[0, 0]), math.tau)
        came: From = "oncoming" if abs(turned) > self.settings.opposite else "same" if abs(turned) < self.settings.same else "cross"
        if came == "same" and set(lane.predecessors) & {name for item in entry for name in side_by_side(road_map.lanes, item)}:
            return  # a neighbour in the planned movement's own approach is no other traffic at the junction
        for feeder in (*lane.predecessors, "") if not lane.predecessors else lane.predecessors:
            self.ways.append(Way(lane.id, feeder, came, lane.turn or "straight", turned, _line_before(road_map, feeder)))
            self._ends.append((starts, ends))
            before = _upstream(road_map, feeder, self.settings.upstream) if feeder else np.empty((0, 2))
            parts.append(_segments(before, own, len(self.ways) - 1))

    def arriving(self, tracks: tuple[Track, ...]) -> tuple[Arriving, ...]:
        """Who is on those ways and has not left the meeting place behind: each road user on each way it may take, nearest first."""
        if self._last[0] is not tracks:
            self._last = tracks, self._arriving(tracks)
        return self._last[1]

    def _arriving(self, tracks: Iterable[Track]) -> tuple[Arriving, ...]:
        left, low, right, high = self._box
        listed = [
            track for track in tracks
            if left <= track.x <= right and low <= track.y <= high and track.kind not in ("pedestrian", "animal", "obstacle")
        ]  # fmt: skip
        if not listed or not len(self._segments):
            return ()
        place = np.array([(track.x, track.y, track.heading) for track in listed])
        seg = self._segments
        dx, dy = place[:, None, 0] - seg[:, 0], place[:, None, 1] - seg[:, 1]
        along, across = dx * seg[:, 2] + dy * seg[:, 3], dy * seg[:, 2] - dx * seg[:, 3]
        facing = np.cos(place[:, None, 2]) * seg[:, 2] + np.sin(place[:, None, 2]) * seg[:, 3]
        on = (np.abs(across) <= self.settings.beside_way) & (facing >= math.cos(self.settings.along_way))
        on &= (along >= -0.01) & (along <= seg[:, 4] + 0.01)
        found: dict[tuple[int, int], tuple[float, float]] = {}
        for row, column in np.argwhere(on):
            key = int(row), int(seg[column, 6])
            offset = abs(float(across[row, column]))
            if key not in found or offset < found[key][0]:
                found[key] = offset, float(seg[column, 5] + along[row, column])
        arriving = [item for (row, way), (_, at) in found.items() if (item := self._placed(listed[row], way, at)) is not None]
        return tuple(sorted(arriving, key=lambda item: (item.to_meeting, item.track.id, item.way.lane, item.way.entry)))

    def _placed(self, track: Track, way: int, at: float) -> Arriving | None:
        """`at`: station of its middle along the way, 0 at the junction's edge."""
        starts, ends = self._ends[way]
        if at - track.length / 2 > ends:
            return None
        front = at + track.length / 2
        return Arriving(track, self.ways[way], starts - front, -front, front > 0.0)


def _entries(road_map: RoadMap, lane: str) -> frozenset[str]:
    return frozenset(road_map.lanes[lane].predecessors)


def _line_before(road_map: RoadMap, entry: str) -> float:
    """Metres from a lane's limit line on to its end, 0 without one."""
    lane = road_map.lanes.get(entry)
    if lane is None or lane.stop_line is None:
        return 0.0
    (ax, ay), (bx, by) = lane.stop_line.start, lane.stop_line.end
    stations, _ = project(np.array([((ax + bx) / 2, (ay + by) / 2)]), lane.center)
    return max(0.0, lane.length - float(stations[0]))


def _first_heading(line: Floats) -> float:
    return math.atan2(line[1, 1] - line[0, 1], line[1, 0] - line[0, 0])


def _line(road_map: RoadMap, inner: Sequence[str], settings: CrossingSettings) -> Floats:
    """Points (n, 3) along lanes within a junction and some way beyond: x, y, station."""
    centers = [road_map.lanes[name].center for name in inner]
    following = next((name for name in road_map.lanes[inner[-1]].successors if name in road_map.lanes), None)
    if following is not None:
        lane = road_map.lanes[following]
        keep = np.arange(0.0, min(settings.beyond, lane.length), settings.sample)
        centers.append(at_stations(lane.center, keep))
    line = np.vstack(centers)
    apart = np.hypot(*np.diff(line, axis=0).T) > 1e-6
    line = line[np.concatenate(([True], apart))]
    stations = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))))
    wanted = np.arange(0.0, stations[-1], settings.sample)
    return np.column_stack((at_stations(line, wanted), wanted))


def _upstream(road_map: RoadMap, lane: str, reach: float) -> Floats:
    """Points (n, 2) of a lane and those before it, back to `reach` metres, in the direction of travel."""
    points, length, name = [road_map.lanes[lane].center], road_map.lanes[lane].length, lane
    seen = {lane}
    while length < reach:
        before = sorted(item for item in road_map.lanes[name].predecessors if item in road_map.lanes and item not in seen)
        if not before:
            break
        name = before[0]
        seen.add(name)
        points.insert(0, road_map.lanes[name].center)
        length += road_map.lanes[name].length
    line = np.vstack(points)
    return line[np.concatenate((np.hypot(*np.diff(line, axis=0).T) > 1e-6, [True]))]


def _straightened(line: Floats, bend: float = 0.01) -> Floats:
    """The line without the points at which it hardly turns (radians since the last point kept)."""
    steps = np.diff(line, axis=0)
    headings = np.unwrap(np.arctan2(steps[:, 1], steps[:, 0]))
    keep, last = [0], headings[0]
    for row in range(1, len(headings)):
        if abs(headings[row] - last) > bend:
            keep.append(row)
            last = headings[row]
    return line[[*keep, len(line) - 1]]


def _segments(before: Floats, own: Floats, way: int) -> Floats:
    """Straight pieces (k, 7) of a way: x, y, direction, length, station at its start (0 at the junction's edge), number of the way."""
    inner = _straightened(own[:, :2], 0.08)
    line = np.vstack((_straightened(before), inner)) if len(before) else inner
    steps = np.diff(line, axis=0)
    lengths = np.hypot(*steps.T)
    keep = lengths > 1e-6
    starts = np.concatenate(([0.0], np.cumsum(lengths)))[:-1]
    edge = 0.0
    if len(before):
        straight = _straightened(before)
        edge = float(np.hypot(*np.diff(np.vstack((straight, own[:1, :2])), axis=0).T).sum())
    number = np.full(int(keep.sum()), float(way))
    return np.column_stack((line[:-1][keep], steps[keep] / lengths[keep, None], lengths[keep], starts[keep] - edge, number))
