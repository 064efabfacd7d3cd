"""The road across a path: where, at each station, the lanes beside it begin and end, so that plans can be told what they drive over."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from regdb_runtime.maneuver import LanePath, LaneSpan
from regdb_runtime.maps.reference_path import ReferencePath
from regdb_runtime.maps.road_map import Lane, RoadMap
from regdb_runtime.trajectory import Floats

NOT_ROADWAY: frozenset[str] = frozenset(("sidewalk", "shoulder", "border", "crosswalk"))
"""Kinds of lane that are no part of the roadway (CVC 530, 555)."""
STEP = 1.0
"""Metres between the stations at which the cross-section is kept."""


@dataclass(frozen=True, slots=True)
class Strip:
    """One lane beside the path over a span: the lane, and whether its traffic goes the path's way."""

    lane: Lane
    same_direction: bool

    @property
    def roadway(self) -> bool:
        return not self.lane.kinds & NOT_ROADWAY


@dataclass(frozen=True, eq=False)
class CrossSections:
    """Offsets (metres, left positive) at stations 0, STEP, 2 STEP … of a path, NaN where there is none (and within junctions).

    `dividers` (B, G): boundaries between lanes of the path's direction. `center` (G,): between those and the opposing ones. `right_edge`,
    `left_edge` (G,): ends of the roadway. `kinds`: kind of lane -> its right and left boundary (2, G), only those beside the path.
    `opposing` (2, G): the half for opposing traffic. `strips` (L, 2, G): every lane of the path's direction.
    """

    dividers: Floats
    center: Floats
    right_edge: Floats
    left_edge: Floats
    opposing: Floats
    strips: Floats
    kinds: dict[str, Floats]

    @cached_property
    def across(self) -> Floats:
        """Right edge, dividers from the right, centre and left edge, one below the other (B + 3, G)."""
        return np.vstack((self.right_edge[None], self.dividers, self.center[None], self.left_edge[None]))

    @cached_property
    def has_opposing(self) -> bool:
        """Whether there is a half for opposing traffic anywhere along the path."""
        return bool(np.isfinite(self.opposing).any())

    def at(self, lines: Floats, index: tuple[NDArray[np.intp], Floats]) -> Floats:
        """Lines (..., G) at stations given as `columns` gives them: (..., *stations.shape)."""
        lower, share = index
        found = lines.take(lower, axis=-1)
        found += (lines.take(lower + 1, axis=-1) - found) * share
        return np.asarray(found)

    def columns(self, stations: Floats) -> tuple[NDArray[np.intp], Floats]:
        """Grid columns below stations and the share of the way to the next, both of the stations' shape."""
        place = np.minimum(np.maximum(stations / STEP, 0.0), self.center.shape[0] - 1.001)
        lower = place.astype(np.intp)
        return lower, place - lower


class Roads:
    """Cross-sections of lane paths on one map, kept as long as the paths are."""

    def __init__(self, road_map: RoadMap) -> None:
        self.road_map = road_map
        self._known: WeakKeyDictionary[LanePath, CrossSections] = WeakKeyDictionary()

    def sections(self, lane_path: LanePath) -> CrossSections:
        """The cross-sections along a path, built on first use."""
        found = self._known.get(lane_path)
        if found is None:
            found = self._known[lane_path] = self._build(lane_path)
        return found

    def strips(self, lane: Lane) -> tuple[Strip, ...]:
        """The lanes across the road at a lane, from the right to the left of its direction."""
        right = list(self._beside(lane, leftward=False))
        return (*reversed(right), Strip(lane, same_direction=True), *self._beside(lane, leftward=True))

    def _beside(self, lane: Lane, *, leftward: bool) -> Iterator[Strip]:
        """Neighbours one after the other; past a lane of the other direction, its own left and right are swapped."""
        seen, same = {lane.id}, True
        while True:
            to_left = leftward if same else not leftward
            name, agrees = (lane.left, lane.left_same_direction) if to_left else (lane.right, lane.right_same_direction)
            following = self.road_map.lanes.get(name) if name is not None else None
            if following is None or following.id in seen:
                return
            same = same if agrees else not same
            seen.add(following.id)
            yield Strip(following, same)
            lane = following

    def _build(self, lane_path: LanePath) -> CrossSections:
        path = lane_path.path
        stations = np.arange(0.0, path.end + 2 * STEP, STEP)
        spans = [(span, lane) for span in lane_path.spans if (lane := self.road_map.lanes.get(span.lane)) is not None and lane.junction is None]
        parts = [_Part(path, span, self.strips(lane), stations) for span, lane in spans]
        center, opposing_end, right_edge, left_edge = (
            _merged(name, parts, stations) for name in ("center", "opposing_end", "right_edge", "left_edge")
        )
        return CrossSections(
            _stacked((part.dividers for part in parts), parts, stations), center, right_edge, left_edge,
            np.stack([center, opposing_end]), _strips(parts, stations), _kinds(parts, stations),
        )  # fmt: skip


class _Part:
    """The lines across one span of the path, on the columns of the grid that the span covers."""

    def __init__(self, path: ReferencePath, span: LaneSpan, strips: tuple[Strip, ...], stations: Floats) -> None:
        self.where = (stations >= span.start - STEP) & (stations <= span.end + STEP) & ((stations >= span.start) | (span.start <= 0.0))
        here = stations[self.where]
        self.strips = strips
        self.bounds = [_offsets(path, strip, here) for strip in strips]
        nothing = np.full(here.shape, np.nan)
        ours = [index for index, strip in enumerate(strips) if strip.same_direction and strip.roadway]
        theirs = [index for index, strip in enumerate(strips) if not strip.same_direction and strip.roadway and index > ours[-1]] if ours else []
        roadway = [*ours, *theirs]
        self.dividers = [(self.bounds[left][0] + self.bounds[right][1]) / 2 for right, left in pairwise(ours)]
        self.center = (self.bounds[theirs[0]][0] + self.bounds[ours[-1]][1]) / 2 if theirs else nothing
        self.opposing_end = self.bounds[theirs[-1]][1] if theirs else nothing
        self.right_edge = self.bounds[roadway[0]][0] if roadway else nothing
        self.left_edge = self.bounds[roadway[-1]][1] if roadway else nothing


def _offsets(path: ReferencePath, strip: Strip, stations: Floats) -> tuple[Floats, Floats]:
    """Offsets of the right and left boundary of a lane at stations of the path."""
    lines = [_line(path, line, stations) for line in (strip.lane.right_line, strip.lane.left_line)]
    return (lines[0], lines[1]) if strip.same_direction else (lines[1], lines[0])


def _line(path: ReferencePath, points: Floats, stations: Floats) -> Floats:
    """Offsets of a polyline at stations; its first and last offset hold beyond its ends."""
    s, d = path.project(_dense(points), extend=True)
    order = np.argsort(s, kind="stable")
    return np.interp(stations, s[order], d[order])


def _dense(points: Floats) -> Floats:
    """A polyline with a point at least every two steps of the grid."""
    along = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))))
    wanted = np.union1d(along, np.arange(0.0, along[-1], 2 * STEP))
    return np.column_stack([np.interp(wanted, along, points[:, axis]) for axis in (0, 1)])


def _merged(name: str, parts: list[_Part], stations: Floats) -> Floats:
    found = np.full(stations.shape, np.nan)
    for part in parts:
        found[part.where] = getattr(part, name)
    return found


def _stacked(lines: Iterable[list[Floats]], parts: list[_Part], stations: Floats) -> Floats:
    listed = list(lines)
    found = np.full((max(map(len, listed), default=0), stations.shape[0]), np.nan)
    for part, rows in zip(parts, listed, strict=True):
        for index, row in enumerate(rows):
            found[index, part.where] = row
    return found


def _strips(parts: list[_Part], stations: Floats) -> Floats:
    listed = [[bounds for strip, bounds in zip(part.strips, part.bounds, strict=True) if strip.same_direction] for part in parts]
    found = np.full((max(map(len, listed), default=0), 2, stations.shape[0]), np.nan)
    for part, rows in zip(parts, listed, strict=True):
        for index, (right, left) in enumerate(rows):
            found[index, 0, part.where], found[index, 1, part.where] = right, left
    return found


def _kinds(parts: list[_Part], stations: Floats) -> dict[str, Floats]:
    """Boundaries of the lanes of each kind that stand apart from the driving lanes."""
    found: dict[str, Floats] = {}
    for part in parts:
        for strip, (right, left) in zip(part.strips, part.bounds, strict=True):
            for kind in sorted(strip.lane.kinds & {"bicycle_lane", "sidewalk"}):
                lines = found.setdefault(kind, np.full((2, stations.shape[0]), np.nan))
                lines[0, part.where], lines[1, part.where] = right, left
    return found
