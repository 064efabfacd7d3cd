"""The course of a recorded vehicle: at each instant the lanes it follows, the lane it changes to, and whether the way it takes next is known."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal

from regdb_runtime.drive.observed.matching import Leg, offset_on
from regdb_runtime.maps.lane_graph import LaneGraph
from regdb_runtime.maps.lane_path import LanePath, LanePaths, lanes_along
from regdb_runtime.maps.road_map import RoadMap
from regdb_runtime.worlds.replay import Motion

AHEAD, BEHIND = 150.0, 60.0
"""Metres of path beyond the last lane driven in and before the first."""
LONGEST_CHANGE = 6.0
"""Seconds on either side of the moment in which the middle of the vehicle passes the line that a change of lane lasts at most."""
MOMENT = 5
"""Rows on either side of one that being over a line must last to count: half a second at 10 Hz. Lanes' edges have kinks where lanes meet."""
MOST_WAYS = 4
"""Ways on from a lane that are looked at when the recording ends before it shows which one was taken."""


@dataclass(frozen=True, slots=True)
class Change:
    """A change of lane: from the first row at which the vehicle is no longer within its lane to the last at which it is not yet within the other."""

    before: str
    after: str
    side: Literal["left", "right"]
    first: int
    last: int
    room: float = math.inf

    def certain(self, error: float) -> bool:
        """Whether there was one, however the places are off by an error: the middle was in either lane by more than that. `room`: by how much."""
        return self.room > error


@dataclass(frozen=True, eq=False)
class Place:
    """Where a vehicle is at one row: its lane, the paths it may be following (one where its way is known), the change it makes."""

    row: int
    lane: str
    ways: tuple[LanePath, ...]
    change: Change | None


class Course:
    """One vehicle's course, path by path. Rows on no lane have no place."""

    def __init__(self, graph: LaneGraph, paths: LanePaths, motion: Motion, legs: Sequence[Leg]) -> None:
        self.graph, self.paths, self.motion, self.legs = graph, paths, motion, legs
        self.changes = tuple(_changes(graph, motion, legs))
        self._ways: dict[int, tuple[LanePath, ...]] = {}
        self._out: list[bool] | None = None

    def at(self, row: int) -> Place | None:
        """The place at a row of the motion."""
        change = next((item for item in self.changes if item.first <= row <= item.last), None)
        index = next(place for place, leg in enumerate(self.legs) if leg.first <= row <= leg.last)
        if change is not None:
            target = next(place for place, leg in enumerate(self.legs) if leg.lane == change.after and leg.last >= change.first)
            return Place(row, change.before if row < self.legs[target].first else change.after, self._along(target), change)
        lane = self.legs[index].lane
        return None if lane is None else Place(row, lane, self._along(index), None)

    def may_be_in_lane(self, row: int) -> bool:
        """Whether being over a line at a row says little: for a moment only, or from the recording's beginning or to its end (a change of lane that
        is shown in part)."""
        if self._out is None:
            lanes = [next(leg.lane for leg in self.legs if leg.first <= place <= leg.last) for place in range(len(self.motion.time))]
            self._out = [lane is not None and not _within(self.graph, lane, self.motion, place) for place, lane in enumerate(lanes)]
        near = self._out[max(row - MOMENT, 0) : row + MOMENT + 1]
        return not all(near) or all(self._out[: row + 1]) or all(self._out[row:])

    def _along(self, index: int) -> tuple[LanePath, ...]:
        """The paths along one leg: the lanes it came by, its own, those it went on by, and every way on from where the recording stops telling."""
        if index not in self._ways:
            road_map = self.graph.road_map
            before, after = self._chain(index, -1), self._chain(index, 1)
            driven = (*before[::-1], self._lane(index), *after)
            behind = lanes_along(road_map, None, driven[0], 0.0, BEHIND)[:-1]
            self._ways[index] = tuple(self.paths.along((*behind, *driven, *onward)) for onward in _onward(road_map, driven[-1]))
        return self._ways[index]

    def _lane(self, index: int) -> str:
        lane = self.legs[index].lane
        assert lane is not None
        return lane

    def _chain(self, index: int, step: Literal[-1, 1]) -> list[str]:
        """The lanes driven in before or after a leg without a change of lane."""
        found: list[str] = []
        here = self._lane(index)
        for leg in self.legs[index + 1 :] if step > 0 else self.legs[:index][::-1]:
            following = self.graph.successors(here) if step > 0 else self.graph.predecessors(here)
            if leg.lane is None or leg.lane not in following:
                break
            found.append(leg.lane)
            here = leg.lane
        return found


def _onward(road_map: RoadMap, lane: str) -> list[tuple[str, ...]]:
    """The ways on from the last lane that is known to have been driven in: one for each way into the next junction, by the straightest lanes else."""
    straight = lanes_along(road_map, None, lane, AHEAD + road_map.lanes[lane].length, 0.0)[1:]
    if road_map.lanes[lane].junction is not None:
        return [straight]
    before: list[str] = []
    here = lane
    for following in straight:
        ways = sorted(name for name in road_map.lanes[here].successors)
        if len(ways) > 1 and any(road_map.lanes[name].junction is not None for name in ways):
            return [(*before, *lanes_along(road_map, None, name, AHEAD, 0.0)) for name in ways[:MOST_WAYS]]
        before.append(following)
        here = following
    return [straight]


def _changes(graph: LaneGraph, motion: Motion, legs: Sequence[Leg]) -> list[Change]:
    found = []
    for before, after in pairwise(legs):
        if before.lane is None or after.lane is None or after.lane in graph.successors(before.lane):
            continue
        side = _side(graph, before.lane, after.lane)
        if side is None:
            continue
        first, last = before.last, after.first
        while first > 0 and not _within(graph, before.lane, motion, first - 1) and motion.time[after.first] - motion.time[first] < LONGEST_CHANGE:
            first -= 1
        end = len(motion.time) - 1
        while last < end and not _within(graph, after.lane, motion, last + 1) and motion.time[last] - motion.time[after.first] < LONGEST_CHANGE:
            last += 1
        room = min(_room(graph, before.lane, motion, before), _room(graph, after.lane, motion, after))
        found.append(Change(before.lane, after.lane, side, first, last, room))
    return found


def _room(graph: LaneGraph, lane: str, motion: Motion, leg: Leg) -> float:
    """How far from the nearer boundary of a lane the middle of the vehicle came while in it."""
    half = float(graph.road_map.lanes[lane].widths.mean()) / 2
    return max(half - abs(offset_on(graph, lane, motion, row)) for row in range(leg.first, leg.last + 1))


def _side(graph: LaneGraph, before: str, after: str) -> Literal["left", "right"] | None:
    """The side to which a lane lies, itself or through one that follows; None where it lies on neither."""
    for lane in (before, *graph.successors(before)):
        row = [*graph.neighbors(lane)]
        if after in row:
            left = graph.left(lane)
            while left is not None:
                if left == after:
                    return "left"
                left = graph.left(left)
            return "right"
    return None


def _within(graph: LaneGraph, lane: str, motion: Motion, row: int) -> bool:
    """Whether the whole width of the vehicle lies in the lane."""
    offset = offset_on(graph, lane, motion, row)
    half = float(graph.road_map.lanes[lane].widths.mean()) / 2
    return math.isfinite(offset) and abs(offset) + motion.obstacle.width / 2 <= half
