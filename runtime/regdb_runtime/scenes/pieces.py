"""A lane cut into pieces over which nothing that stands still changes: zones, distances that the law compares, crosswalks, rails."""

from __future__ import annotations

import datetime
import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from regdb.condition import Compare, Literal, Within, literals
from regdb.regulation import Regulation
from regdb.vocabulary import Value
from regdb_runtime.maps.lines import inside, project
from regdb_runtime.maps.road_map import Floats, Lane, RoadMap, Zone
from regdb_runtime.scenes.clock_facts import seconds_until
from regdb_runtime.scenes.lane_facts import lane_facts, types_with_lanes
from regdb_runtime.scenes.sign_facts import AT_JUNCTION, Codes, sign_facts

RAIL = "rail"
"""Kind of a zone that lies between the outermost rails of a crossing; its facts hold on the way to it."""
PRECISION = 0.01
"""Metres to which a border is found."""


@dataclass(frozen=True, eq=False)
class Piece:
    """Part of a lane, by its own stations: facts of everything that stands still, and who governs there (None: the whole map's)."""

    start: float
    end: float
    facts: Mapping[str, Value]
    jurisdiction: str | None


@dataclass(frozen=True, slots=True)
class Band:
    """Where a lane lies in an area (a crosswalk, rails), by its own stations."""

    id: str
    start: float
    end: float
    marked: bool = True
    facts: Mapping[str, Value] | None = None


def bounds_by_fact(regulations: Iterable[Regulation]) -> dict[str, tuple[float, ...]]:
    """Fact -> every constant in SI that some condition compares it with alone, ascending: where a distance on the map changes the law."""
    found: dict[str, set[float]] = {}
    for literal in _literals_of(regulations):
        if isinstance(literal, Compare):
            terms = (*literal.left.terms, *((-scale, fact) for scale, fact in literal.right.terms))
            if len(terms) == 1 and terms[0][0]:
                scale, fact = terms[0]
                found.setdefault(fact, set()).add((literal.right.constant - literal.left.constant) / scale)
    return {fact: tuple(sorted(values)) for fact, values in sorted(found.items())}


def hours_of(regulations: Iterable[Regulation]) -> set[int]:
    """Every time of the day, in seconds, at which some condition begins or ceases to hold."""
    rules = tuple(regulations)
    spans = [literal for literal in _literals_of(rules) if isinstance(literal, Within) and literal.fact == "clock.time"]
    found = {second for span in spans for second in (span.start, span.end)}
    return {int(second) % 86400 for second in (*found, *bounds_by_fact(rules).get("clock.time", ()))}


def _literals_of(regulations: Iterable[Regulation]) -> Iterator[Literal]:
    for rule in regulations:
        for node in (rule.when, rule.unless):
            if node is not None:
                yield from literals(node)


class LanePieces:
    """The pieces of every lane of a map, each worked out when first asked for. `bounds`: see `bounds_by_fact`; `codes`: see `sign_codes`."""

    def __init__(self, road_map: RoadMap, bounds: Mapping[str, tuple[float, ...]], codes: Codes, step: float = 1.0) -> None:
        self.road_map, self._bounds, self._codes, self._step = road_map, bounds, codes, step
        self._pieces: dict[tuple[str, tuple[int, ...]], tuple[Piece, ...]] = {}
        self._bands: dict[str, tuple[tuple[Band, ...], tuple[Band, ...]]] = {}
        self._facts: dict[str, Mapping[str, Value]] = {}
        self._timed = tuple(index for index, zone in enumerate(road_map.zones) if zone.hours)

    def at(self, lane: str, clock: datetime.datetime) -> tuple[Piece, ...]:
        """The pieces of a lane at a local time, in order, from 0 to its length."""
        running = tuple(index for index in self._timed if runs(self.road_map.zones[index], clock))
        key = lane, running
        if key not in self._pieces:
            self._pieces[key] = tuple(self._cut(self.road_map.lanes[lane], frozenset(running)))
        return self._pieces[key]

    def crosswalks(self, lane: str) -> tuple[Band, ...]:
        """Crosswalks that the lane's middle crosses, in order."""
        return self._areas(lane)[0]

    def rails(self, lane: str) -> tuple[Band, ...]:
        """Rail crossings on the lane, in order."""
        return self._areas(lane)[1]

    def next_change(self, clock: datetime.datetime, within: float) -> float | None:
        """Seconds until the first hours of a zone begin or end, None when none do within so many seconds."""
        changes = [wait for index in self._timed for wait in _waits(self.road_map.zones[index], clock) if 0 < wait <= within]
        return min(changes, default=None)

    def facts_of(self, lane: Lane) -> Mapping[str, Value]:
        """Facts of a whole lane: the map's everywhere, then what is worked out, then its own. Within a junction the road is the one it comes from."""
        if lane.id not in self._facts:
            self._facts[lane.id] = self._whole(lane)
        return self._facts[lane.id]

    def _whole(self, lane: Lane) -> dict[str, Value]:
        lanes = self.road_map.lanes
        road = next((lanes[name] for name in lane.predecessors if name in lanes), lane) if lane.junction is not None else lane
        told = dict(self.road_map.facts)
        found = lane_facts(self.road_map, road)
        if road is not lane:
            own = lane_facts(self.road_map, lane)
            found |= {name: own[name] for name in ("lane.width", "posted.speed", "sign.speed_limit") if name in own}
        if "road.two_way" not in found and told.get("road.divided") is False and road.facts.get("road.divided") is not True and road.junction is None:
            found |= {"road.one_way": True, "road.two_way": False, "road.lanes": found["road.lanes_same_direction"]}
        facts = told | found | dict(road.facts) | self._junction_signs(road) | dict(lane.facts)
        types = lane.facts.get("road.types", road.facts.get("road.types", told.get("road.types")))
        if isinstance(types, frozenset):
            facts["road.types"] = types_with_lanes(types, found | dict(road.facts))
        return facts

    def _cut(self, lane: Lane, running: frozenset[int]) -> Iterable[Piece]:
        zones = [zone for index, zone in enumerate(self.road_map.zones) if zone.kind != RAIL and (not zone.hours or index in running)]
        inner = [(zone, start, end) for zone in zones for start, end in areas_along(lane, zone.polygon, self._step)]
        signs = self._signs_on(lane)
        borders = {0.0, lane.length} | {at for _, start, end in inner for at in (start, end)} | {at for at, _ in signs}
        for zone, start, end in inner:
            borders |= self._where_distance_counts(lane, zone, start, end)
        ordered = sorted(borders)
        base = self.facts_of(lane)
        for start, end in pairwise(ordered):
            if end - start > PRECISION:
                here = [zone for zone, first, last in inner if first <= (start + end) / 2 <= last]
                facts = dict(base)
                for at, said in signs:
                    if at <= start + PRECISION:
                        facts |= said
                yield Piece(start, end, self._with_zones(lane, facts, here, start, end), _governing(here))

    def _junction_signs(self, lane: Lane) -> dict[str, Value]:
        """What signs of the lane say of the junction at its end."""
        said = [sign_facts(self.road_map.signs[name], self._codes) for name in lane.signs if name in self.road_map.signs]
        return {fact: value for facts in said for fact, value in facts.items() if fact in AT_JUNCTION}

    def _signs_on(self, lane: Lane) -> list[tuple[float, dict[str, Value]]]:
        """The other signs of the lane, each with the station from which it speaks (0 where its place is not known), in order."""
        found = []
        for name in lane.signs:
            sign = self.road_map.signs.get(name)
            said = {} if sign is None else {fact: value for fact, value in sign_facts(sign, self._codes).items() if fact not in AT_JUNCTION}
            if sign is not None and said:
                at = 0.0 if sign.position is None else float(project(np.array([sign.position]), lane.center)[0][0])
                found.append((min(max(at, 0.0), lane.length), said))
        return sorted(found, key=lambda item: item[0])

    def _where_distance_counts(self, lane: Lane, zone: Zone, start: float, end: float) -> set[float]:
        """Stations at which the distance to the zone's landmark passes a number that a condition compares it with."""
        if zone.distance_fact is None or zone.landmark is None:
            return set()
        stations = np.linspace(start, end, max(2, math.ceil((end - start) / self._step) + 1))
        away = distances(lane, stations, zone.landmark)
        found: set[float] = set()
        for bound in self._bounds.get(zone.distance_fact, ()):
            for row in np.flatnonzero((away[:-1] <= bound) != (away[1:] <= bound)):
                share = (bound - away[row]) / (away[row + 1] - away[row])
                found.add(float(stations[row] + share * (stations[row + 1] - stations[row])))
        return found

    def _with_zones(self, lane: Lane, base: Mapping[str, Value], zones: list[Zone], start: float, end: float) -> dict[str, Value]:
        facts = dict(base)
        for zone in zones:
            facts |= zone.facts
            if zone.distance_fact is not None and zone.landmark is not None:
                margin = min(PRECISION, (end - start) / 4)  # within its borders the piece lies on one side of each number
                stations = np.linspace(start + margin, end - margin, max(2, math.ceil((end - start) / self._step) + 1))
                facts[zone.distance_fact] = float(distances(lane, stations, zone.landmark).min())
        return facts

    def _areas(self, lane: str) -> tuple[tuple[Band, ...], tuple[Band, ...]]:
        if lane not in self._bands:
            found = self.road_map.lanes[lane]
            walks = [
                Band(walk.id, start, end, walk.marked)
                for walk in self.road_map.crosswalks for start, end in areas_along(found, walk.polygon, self._step / 2)
            ]  # fmt: skip
            rails = [
                Band(zone.id, start, end, facts=zone.facts)
                for zone in self.road_map.zones if zone.kind == RAIL for start, end in areas_along(found, zone.polygon, self._step / 2)
            ]  # fmt: skip
            self._bands[lane] = tuple(sorted(walks, key=_in_order)), tuple(sorted(rails, key=_in_order))
        return self._bands[lane]


def _in_order(band: Band) -> tuple[float, str]:
    return band.start, band.id


def _governing(zones: list[Zone]) -> str | None:
    return next((zone.jurisdiction for zone in reversed(zones) if zone.jurisdiction is not None), None)


def runs(zone: Zone, clock: datetime.datetime) -> bool:
    """Whether a zone's facts hold at a local time; a span that ends before it begins runs over midnight, of the day on which it begins."""
    second = clock.hour * 3600 + clock.minute * 60 + clock.second
    for span in zone.hours:
        today = not span.weekdays or clock.weekday() in span.weekdays
        yesterday = not span.weekdays or (clock.weekday() - 1) % 7 in span.weekdays
        if span.start <= span.end:
            if today and span.start <= second < span.end:
                return True
        elif (today and second >= span.start) or (yesterday and second < span.end):
            return True
    return False


def _waits(zone: Zone, clock: datetime.datetime) -> list[float]:
    return [seconds_until(border, clock) for span in zone.hours for border in (span.start, span.end)]


def points_at(lane: Lane, stations: Floats) -> Floats:
    """Points (n, 2) of the lane's middle at stations (n,)."""
    return np.column_stack([np.interp(stations, lane.stations, lane.center[:, axis]) for axis in (0, 1)])


def distances(lane: Lane, stations: Floats, place: tuple[float, float]) -> Floats:
    """Distance of the lane's middle at stations (n,) to a place, metres."""
    return np.asarray(np.hypot(*(points_at(lane, stations) - np.asarray(place)).T))


def areas_along(lane: Lane, polygon: Floats, step: float) -> list[tuple[float, float]]:
    """Where the lane's middle lies in a polygon: (from, to) by its stations, borders to a centimetre."""
    low, high = polygon.min(axis=0), polygon.max(axis=0)
    if (lane.center.max(axis=0) < low).any() or (lane.center.min(axis=0) > high).any():
        return []
    stations = np.linspace(0.0, lane.length, max(2, math.ceil(lane.length / step) + 1))
    within = inside(points_at(lane, stations), polygon)
    changes = np.flatnonzero(within[:-1] != within[1:])
    borders = [_border(lane, polygon, float(stations[row]), float(stations[row + 1]), bool(within[row])) for row in changes]
    if within[0]:
        borders.insert(0, 0.0)
    if within[-1]:
        borders.append(lane.length)
    return list(zip(borders[::2], borders[1::2], strict=True))


def _border(lane: Lane, polygon: Floats, low: float, high: float, within: bool) -> float:
    """Where the middle enters or leaves the polygon between two stations, by halving."""
    while high - low > PRECISION:
        middle = (low + high) / 2
        if bool(inside(points_at(lane, np.array([middle])), polygon)[0]) == within:
            low = middle
        else:
            high = middle
    return (low + high) / 2
