"""All driven vehicles and cyclists: each keeps behind what is ahead, stops for lights and signs, gives way, and passes what stands or is slow."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Protocol

from regdb_runtime.observation import EgoState, Footprint, Track
from regdb_runtime.planning.idm import idm_acceleration
from regdb_runtime.worlds.built_in.lane_tables import LaneTable, LaneTables
from regdb_runtime.worlds.built_in.mover import Mover, TrafficSettings
from regdb_runtime.worlds.built_in.people import Pedestrian
from regdb_runtime.worlds.built_in.right_of_way import Approaching, RightOfWay, find_siblings
from regdb_runtime.worlds.built_in.signals import Signals


class Entry:
    """Something on a lane: its middle's station and offset, half its extent along and across, its speed along the lane."""

    __slots__ = ("half_length", "half_width", "mover", "offset", "slow", "speed", "station")

    def __init__(self, station: float, offset: float, half_length: float, half_width: float, speed: float, slow: str, mover: Mover | None) -> None:
        self.station, self.offset, self.half_length, self.half_width = station, offset, half_length, half_width
        self.speed, self.slow, self.mover = speed, slow, mover


@dataclass(frozen=True, slots=True)
class EgoAhead:
    """What others make of the ego: its approach to its next junction lane, if it has one."""

    lane: str | None
    distance: float
    since: float | None


class TrafficModel(Protocol):
    """Whoever drives everybody but the ego and the people on foot; `movers` are those in it or waiting to enter."""

    movers: list[Mover]

    def add_standing(self, track: Track) -> None: ...

    def room_at(self, lane: str, station: float, half_length: float, gap: float) -> bool: ...

    def step(self, time: float, step: float, ego: EgoState, footprint: Footprint, ahead: EgoAhead, people: Iterable[Pedestrian]) -> None: ...

    def tracks(self, time: float) -> list[Track]: ...


class Traffic:
    """Held by the world; `step` moves everybody on."""

    def __init__(self, tables: LaneTables, signals: Signals, settings: TrafficSettings) -> None:
        self.tables, self.signals, self.settings = tables, signals, settings
        self.right_of_way = RightOfWay(tables, signals, settings)
        self._siblings = find_siblings(tables)
        self.movers: list[Mover] = []
        self._standing: dict[str, list[Entry]] = {}
        self._entries: dict[str, list[Entry]] = {}

    def add_standing(self, track: Track) -> None:
        """Something that never moves."""
        for lane, entry in self._project(track.x, track.y, track.heading, track.length, track.width, 0.0, "parked"):
            self._standing.setdefault(lane.id, []).append(entry)

    def room_at(self, lane: str, station: float, half_length: float, gap: float) -> bool:
        """Whether a vehicle could appear there with `gap` metres before and behind."""
        return all(abs(item.station - station) > item.half_length + half_length + gap for item in self._entries.get(lane, ()))

    def step(self, time: float, step: float, ego: EgoState, footprint: Footprint, ahead: EgoAhead, people: Iterable[Pedestrian]) -> None:
        """Everybody decides on what is now, then everybody moves."""
        self.right_of_way.free_ways()
        self._enter_all(ego, footprint, people)
        coming = self._coming(ahead, ego.speed)
        inner = ((name, entries) for name, entries in self._entries.items() if self.tables[name].inner)
        occupied = {name: [item.station for item in entries if item.mover is None] for name, entries in inner}
        present = [mover for mover in self.movers if mover.enters <= time + 1e-9]
        wanted = [self._acceleration(mover, time, coming, occupied) for mover in present]
        for mover, acceleration in zip(present, wanted, strict=True):
            self._sideways(mover, time, step)
            mover.advance(acceleration, step)
            mover.stood = mover.stood + step if mover.speed < 0.05 else 0.0
        self.movers = [mover for mover in self.movers if not mover.gone]

    def tracks(self, time: float) -> list[Track]:
        """Everybody who is there now."""
        return [mover.track() for mover in self.movers if mover.enters <= time + 1e-9]

    def _enter_all(self, ego: EgoState, footprint: Footprint, people: Iterable[Pedestrian]) -> None:
        """List everything by lane, sorted by station."""
        entries = {name: list(items) for name, items in self._standing.items()}
        self._entries = entries
        for mover in self.movers:
            self._enter_mover(mover)
        x, y = ego.box_center(footprint)
        self._enter_loose(x, y, ego.heading, footprint.length, footprint.width, ego.speed, "")
        for person in people:
            px, py, heading = person.place()
            for ahead in self.settings.looks_ahead if person.moving else (0.0,):
                reach, size = ahead * person.spec.speed, person.spec.size
                self._enter_loose(px + reach * math.cos(heading), py + reach * math.sin(heading), heading, size, size, 0.0, "person")
        for items in entries.values():
            items.sort(key=_by_station)

    def _enter_mover(self, mover: Mover) -> None:
        entries, table = self._entries, mover.table
        slow = "bicycle" if mover.bicycle else ""
        entry = Entry(mover.station, mover.offset, mover.half_length, mover.half_width, mover.speed, slow, mover)
        entries.setdefault(table.id, []).append(entry)
        rear = mover.station - mover.half_length
        if rear < 0.0 and mover.place > 0:
            before = self.tables[mover.route[mover.place - 1]]
            entries.setdefault(before.id, []).append(
                Entry(mover.station + before.length, mover.offset, mover.half_length, mover.half_width, mover.speed, slow, mover))
        for sibling, apart in self._siblings.get(table.id, ()):
            if rear < apart:
                entries.setdefault(sibling, []).append(entry)

    def _enter_loose(self, x: float, y: float, heading: float, length: float, width: float, speed: float, slow: str) -> None:
        for lane, entry in self._project(x, y, heading, length, width, speed, slow):
            self._entries.setdefault(lane.id, []).append(entry)

    def _project(
        self, x: float, y: float, heading: float, length: float, width: float, speed: float, slow: str
    ) -> list[tuple[LaneTable, Entry]]:
        """An object that is on no lane of its own, on every lane it reaches into."""
        found = []
        for table, station, offset in self.tables.under(x, y, 6.0):
            turn = heading - table.heading[min(max(int(station / table.step), 0), len(table.heading) - 1)]
            cos, sin = math.cos(turn), math.sin(turn)
            half_length = (length * abs(cos) + width * abs(sin)) / 2
            half_width = (length * abs(sin) + width * abs(cos)) / 2
            if abs(offset) - half_width < table.half_width + 0.3:
                found.append((table, Entry(station, offset, half_length, half_width, max(speed * cos, 0.0), slow, None)))
        return found

    def _coming(self, ahead: EgoAhead, ego_speed: float) -> dict[str, list[Approaching]]:
        """Who is on the way to which junction lane; whoever queues behind somebody who stands is not."""
        found: dict[str, list[Approaching]] = {}
        blocked: set[str] = set()
        for mover in sorted(self.movers, key=_from_front):
            following = mover.following_lane
            if following is not None and mover.table.junction is None and self.tables[following].inner:
                distance = mover.table.length - mover.station - mover.half_length
                if distance < 150.0 and mover.table.id not in blocked:
                    if mover.speed < 1.0:
                        blocked.add(mover.table.id)
                    found.setdefault(following, []).append(Approaching(mover.id, following, distance, mover.speed, mover.waiting_since))
        if ahead.lane is not None:
            found.setdefault(ahead.lane, []).append(Approaching("", ahead.lane, ahead.distance, ego_speed, ahead.since))
        return found

    def _acceleration(
        self, mover: Mover, time: float, coming: dict[str, list[Approaching]], occupied: dict[str, list[float]]
    ) -> float:
        speed, idm = mover.speed, mover.idm
        wish = self._reachable_speed(mover, time)
        gentle = speed / (1.0 + self.settings.comfortable / idm.acceleration) ** 0.25
        wish = max(wish, gentle, 0.1)
        gap, lead_speed = self._lead(mover)
        wanted = float(idm_acceleration(speed, gap, speed - lead_speed, idm, wish))
        line = self._line_ahead(mover, time, coming, occupied)
        if line is not None:
            to_line = line - self.settings.stop_short + idm.jam_distance
            wanted = min(wanted, float(idm_acceleration(speed, to_line, speed, idm, wish)))
        return wanted

    def _reachable_speed(self, mover: Mover, time: float) -> float:
        """The wished speed, and what the next curve or lower limit lets it be from here."""
        wish = min(mover.wished_speed(time), mover.table.curve_speed)
        following = mover.following_lane
        if following is not None:
            table = self.tables[following]
            ahead = min(table.curve_speed, table.limit * mover.scattered if mover.wish is None else 40.0)
            if ahead < wish:
                distance = max(0.0, mover.table.length - mover.station - mover.half_length)
                wish = min(wish, math.sqrt(ahead * ahead + 2 * 0.7 * self.settings.comfortable * distance))
        return wish

    def _lead(self, mover: Mover) -> tuple[float, float]:
        """Gap to the nearest thing ahead in its way, bumper to bumper, and that thing's speed; inf without one."""
        table, begin, place = mover.table, 0.0, mover.place
        sight = min(self.settings.sight, 25.0 + 3.0 * mover.speed)
        while True:
            for entry in self._entries.get(table.id, ()):
                ahead = begin + entry.station - mover.station
                if ahead <= 0.0 or entry.mover is mover:
                    continue
                if ahead - entry.half_length - mover.half_length > sight:
                    break
                if abs(entry.offset - mover.offset) < entry.half_width + mover.half_width + 0.25:
                    return ahead - entry.half_length - mover.half_length, entry.speed
            begin += table.length
            place += 1
            if place >= len(mover.route) or begin - mover.station > sight:
                return math.inf, 0.0
            table = self.tables[mover.route[place]]

    def _line_ahead(
        self, mover: Mover, time: float, coming: dict[str, list[Approaching]], occupied: dict[str, list[float]]
    ) -> float | None:
        """Distance from the front to the line to stop at before the next junction; None when it may go on."""
        following, table = mover.following_lane, mover.table
        if following is None or table.inner or not self.tables[following].inner:
            return None
        line = table.length if table.stop_station is None else table.stop_station
        distance = line - mover.station - mover.half_length
        lane, way = self.tables[following], self.right_of_way
        if distance > mover.speed * mover.speed / 3.0 + 25.0:
            return None
        if distance < -1.0:
            if not way.holds(mover, following):
                way.take(mover, following)
            return None
        if distance < 4.0 and mover.speed < 0.3 and mover.waiting_since is None:
            mover.waiting_since = time
        if distance < 4.0 and mover.stood >= self.settings.stand:
            mover.stopped = True
        stopped = way.light_stops(mover, lane, time, distance) or way.sign_stops(mover, lane)
        if way.holds(mover, following):
            can_stop = mover.speed * mover.speed / (2 * max(distance, 0.1)) < self.settings.comfortable
            if not (stopped and can_stop and distance > 0.0):
                return None
            way.give_back(mover, following)
        if stopped:
            return distance
        if distance > mover.speed * mover.speed / (2 * self.settings.comfortable) + 6.0:
            return None if way.clear(mover, lane, time, distance, coming, occupied) else distance
        if self._room_beyond(mover, lane) and way.clear(mover, lane, time, distance, coming, occupied):
            way.take(mover, following)
            return None
        return distance

    def _room_beyond(self, mover: Mover, lane: LaneTable) -> bool:
        """Whether the lane after the junction has room for the vehicle, so that it need not stand in the junction."""
        for entry in self._entries.get(lane.successors[0] if lane.successors else "", ()):
            rear = entry.station - entry.half_length
            in_the_way = abs(entry.offset) < entry.half_width + mover.half_width
            if entry.mover is not mover and rear < mover.length + 3.0 and entry.speed < 2.0 and in_the_way:
                return False
        return True

    def _sideways(self, mover: Mover, time: float, step: float) -> None:
        """Move towards the offset from the lane's middle that the driver wants."""
        if mover.bicycle:
            mover.offset = mover.resting_offset + mover.weave * math.sin(math.pi / 2 * time)
            return
        target = self._passing_offset(mover)
        most = min(self.settings.lateral, 0.2 * mover.speed) * step
        mover.offset += min(max(target - mover.offset, -most), most)

    def _passing_offset(self, mover: Mover) -> float:
        """How far to the left the vehicle must go to pass what stands or is slow ahead or beside; 0 when there is nothing or no room."""
        table = mover.table
        needed = 0.0
        for entry in self._entries.get(table.id, ()):
            ahead = entry.station - mover.station
            if not entry.slow or entry.slow == "person" or entry.offset > 0.0 or ahead > 15.0 + 2.5 * mover.speed:
                continue
            if ahead < -(entry.half_length + mover.half_length + 1.5) or (entry.mover is not None and entry.speed > 0.8 * mover.table.limit):
                continue
            clearance = self.settings.beside_bicycle if entry.slow == "bicycle" else self.settings.beside_parked
            needed = max(needed, entry.offset + entry.half_width + clearance + mover.half_width)
        if needed <= 0.0 or mover.bicycle:
            return 0.0
        room = table.half_width - mover.half_width
        if needed <= room + 0.1:
            return needed
        return needed if needed <= room + table.left_room and self._left_free(mover) else 0.0

    def _left_free(self, mover: Mover) -> bool:
        """Whether the lane on the left can be used for passing."""
        table = mover.table
        if table.left is None or table.length - mover.station < 30.0:
            return False
        if mover.offset > table.half_width - mover.half_width + 0.2:
            return True
        other = self.tables[table.left]
        if table.left_same_direction:
            return all(not -25.0 < item.station - mover.station < 15.0 for item in self._entries.get(other.id, ()))
        here = other.length - mover.station
        reach = 8.0 * (mover.speed + other.limit)
        return all(not -10.0 < here - item.station < reach for item in self._entries.get(other.id, ()))


def _from_front(mover: Mover) -> float:
    return mover.table.length - mover.station


def _by_station(entry: Entry) -> float:
    return entry.station

