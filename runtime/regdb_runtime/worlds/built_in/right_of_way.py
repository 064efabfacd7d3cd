"""Who may enter a junction: lights, stop signs, crossing ways that are taken or about to be, and room beyond, as people judge them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from regdb_runtime.worlds.built_in.lane_tables import LaneTable, LaneTables
from regdb_runtime.worlds.built_in.mover import Mover, TrafficSettings
from regdb_runtime.worlds.built_in.signals import Signals

TOUCH = 2.4
"""Two middles nearer than this belong to ways that conflict, metres: two half widths and half a metre."""


@dataclass(frozen=True, slots=True)
class Conflict:
    """Another way through the junction that touches one's own: stations on one's own lane and on the other's."""

    other: str
    begin: float
    end: float
    other_begin: float
    other_end: float


@dataclass(frozen=True, slots=True)
class Approaching:
    """Somebody on the way to a junction lane: distance from the front to the lane's beginning, speed, and the name."""

    name: str
    lane: str
    distance: float
    speed: float
    since: float | None


def find_conflicts(tables: LaneTables) -> dict[str, tuple[Conflict, ...]]:
    """For every junction lane the others it touches; ways from the same lane queue behind one another and do not count."""
    inner: dict[str, list[LaneTable]] = {}
    for table in tables.values():
        if table.junction is not None:
            inner.setdefault(table.junction, []).append(table)
    return {lane.id: tuple(_conflicts(lane, others)) for others in inner.values() for lane in others}


def _conflicts(lane: LaneTable, others: Iterable[LaneTable]) -> Iterable[Conflict]:
    for other in others:
        if other is lane or set(other.predecessors) & set(lane.predecessors):
            continue
        gaps = np.hypot(*(lane.points[:, None, :] - other.points[None, :, :]).transpose(2, 0, 1))
        near = gaps < TOUCH
        if near.any():
            own, theirs = np.flatnonzero(near.any(axis=1)), np.flatnonzero(near.any(axis=0))
            begin, end = (float(own[place]) * lane.step for place in (0, -1))
            yield Conflict(other.id, begin, end, *(float(theirs[place]) * other.step for place in (0, -1)))


def find_siblings(tables: LaneTables) -> dict[str, tuple[tuple[str, float], ...]]:
    """For every junction lane the others that begin where it begins, and the station up to which they still overlap."""
    found: dict[str, tuple[tuple[str, float], ...]] = {}
    for lane in tables.values():
        if lane.junction is None:
            continue
        pairs = []
        for other in tables.values():
            if other is not lane and other.junction == lane.junction and set(other.predecessors) & set(lane.predecessors):
                count = min(len(lane.points), len(other.points))
                apart = np.flatnonzero(np.hypot(*(lane.points[:count] - other.points[:count]).T) > TOUCH)
                pairs.append((other.id, float(apart[0]) * other.step if len(apart) else other.length))
        found[lane.id] = tuple(pairs)
    return found


class RightOfWay:
    """Ways that vehicles have taken, and the answer whether another may be."""

    def __init__(self, tables: LaneTables, signals: Signals, settings: TrafficSettings) -> None:
        self.tables, self.signals, self.settings = tables, signals, settings
        self.conflicts = find_conflicts(tables)
        self.taken: dict[str, dict[str, Mover]] = {}

    def free_ways(self) -> None:
        """Give back the ways of vehicles whose rear has left the junction, or that are gone."""
        for lane, holders in self.taken.items():
            for name, mover in list(holders.items()):
                past = mover.table.id != lane and mover.table.junction is None and mover.place > 0 and mover.route[mover.place - 1] == lane
                if mover.gone or (past and mover.station > mover.half_length):
                    del holders[name]

    def holds(self, mover: Mover, lane: str) -> bool:
        return mover.id in self.taken.get(lane, ())

    def take(self, mover: Mover, lane: str) -> None:
        self.taken.setdefault(lane, {})[mover.id] = mover

    def give_back(self, mover: Mover, lane: str) -> None:
        self.taken.get(lane, {}).pop(mover.id, None)

    def light_stops(self, mover: Mover, lane: LaneTable, time: float, distance: float) -> bool:
        """Whether the light keeps a vehicle back whose front is `distance` metres before the line."""
        governing = self.signals.governing(lane.lights)
        if governing is None:
            return False
        color = self.signals.color(governing, time)
        if color == "green":
            return False
        if color == "yellow":
            return mover.speed * mover.speed / (2 * max(distance, 0.1)) < self.settings.hardest
        turns_on_red = self.settings.right_on_red and lane.turn == "right" and not self.signals.is_arrow(governing) and not mover.bicycle
        return not (turns_on_red and mover.stopped)

    def sign_stops(self, mover: Mover, lane: LaneTable) -> bool:
        """Whether a STOP sign still asks for a full stop."""
        return lane.control in ("stop_ego", "stop_all") and not mover.stopped

    def clear(
        self, mover: Mover, lane: LaneTable, time: float, distance: float, coming: Mapping[str, list[Approaching]],
        occupied: Mapping[str, list[float]],
    ) -> bool:  # fmt: skip
        """Whether the way is neither taken, nor occupied, nor about to be used by somebody who goes first."""
        for conflict in self.conflicts[lane.id]:
            if any(item is not mover and not _past(item, conflict) for item in self.taken.get(conflict.other, {}).values()):
                return False
            if any(station < conflict.other_end for station in occupied.get(conflict.other, ())):
                return False
            if any(self._goes_first(item, conflict, mover, lane, time, distance) for item in coming.get(conflict.other, ())):
                return False
        return True

    def _goes_first(self, other: Approaching, conflict: Conflict, mover: Mover, lane: LaneTable, time: float, distance: float) -> bool:
        theirs = self.tables[conflict.other]
        if other.name == mover.id or not self._has_priority(theirs, lane, time, mover, other):
            return False
        waiting = 0.0 if other.since is None else time - other.since
        if lane.control in ("none", "stop_all") and mover.waiting_since is None and waiting > self.settings.impatient_after / 2:
            return other.name != mover.id
        if other.speed < 0.3 and waiting > self.settings.patience:
            return False
        if lane.control == "stop_all":
            return True
        arrival = (max(other.distance, 0.0) + conflict.other_begin) / max(other.speed, 3.0)
        waited = 0.0 if mover.waiting_since is None else time - mover.waiting_since
        spare = self.settings.gap * max(0.0, 1.0 - waited / self.settings.impatient_after)
        after = _time_to(distance + conflict.end + mover.length, mover.speed, mover.idm.acceleration, lane.curve_speed)
        return arrival < after + spare and other.distance < self.settings.sight

    def _has_priority(self, theirs: LaneTable, own: LaneTable, time: float, mover: Mover, other: Approaching) -> bool:
        """Whether the other way goes before one's own: green before red, main road before side road, straight before left, first come at ALL WAY."""
        if own.lights:
            governing, own_governing = self.signals.governing(theirs.lights), self.signals.governing(own.lights)
            if governing is None or self.signals.color(governing, time) not in ("green", "yellow"):
                return False
            if own_governing is not None and self.signals.color(own_governing, time) == "red":
                return True
            return own.turn == "left" and theirs.turn != "left"
        if own.control == "stop_all":
            return self._came_first(other, mover, time)
        own_waits, they_wait = (item.control in ("stop_ego", "yield_ego") for item in (own, theirs))
        if own_waits != they_wait:
            return own_waits
        if own.turn == "left" and theirs.turn != "left":
            return math.cos(own.heading[0] - theirs.heading[0]) < -0.5
        return not own_waits and _from_right(own, theirs)

    def _came_first(self, other: Approaching, mover: Mover, time: float) -> bool:
        if other.since is None or time - other.since > self.settings.patience:
            return False
        return mover.waiting_since is None or (other.since, other.name) < (mover.waiting_since, mover.id)


def _past(mover: Mover, conflict: Conflict) -> bool:
    """Whether a vehicle's rear has left the place where its way touches another."""
    return mover.table.id == conflict.other and mover.station - mover.half_length > conflict.other_end


def _from_right(own: LaneTable, theirs: LaneTable) -> bool:
    turn = math.remainder(theirs.heading[0] - own.heading[0], 2 * math.pi)
    return math.radians(45) < turn < math.radians(135)


def _time_to(distance: float, speed: float, acceleration: float, most: float) -> float:
    """Seconds for a distance, speeding up from `speed` to at most `most`."""
    if speed >= most:
        return distance / max(most, 1.0)
    reach = (most * most - speed * speed) / (2 * acceleration)
    if distance <= reach:
        return (math.sqrt(speed * speed + 2 * acceleration * distance) - speed) / acceleration
    return (most - speed) / acceleration + (distance - reach) / most
