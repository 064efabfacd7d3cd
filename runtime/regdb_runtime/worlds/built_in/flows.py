"""Vehicles that keep coming at the beginning of a lane, at random times that the seed fixes."""

from __future__ import annotations

import random

from regdb_runtime.errors import WorldError
from regdb_runtime.maps.road_map import RoadMap, Turn
from regdb_runtime.observation import TrackKind
from regdb_runtime.worlds.built_in.lane_tables import LaneTables
from regdb_runtime.worlds.built_in.mover import Mover, TrafficSettings, scattered
from regdb_runtime.worlds.built_in.participants import driver
from regdb_runtime.worlds.built_in.traffic import TrafficModel
from regdb_runtime.worlds.scene_spec import FlowSpec

_LONGEST_ROUTE = 40


class Flow:
    """Held by the world; arrivals follow one another at exponential times and wait outside while there is no room."""

    def __init__(self, spec: FlowSpec, seed: int, road_map: RoadMap, tables: LaneTables, settings: TrafficSettings) -> None:
        if spec.lane not in tables:
            raise WorldError(f"{spec.id}: there is no lane {spec.lane!r}")
        if spec.per_hour <= 0.0:
            raise WorldError(f"{spec.id}: {spec.per_hour:g} vehicles an hour are no flow")
        self._spec, self._map, self._tables, self._settings = spec, road_map, tables, settings
        self._chance = random.Random(f"{seed} {spec.id}")
        self._count = 0
        self._next = spec.start + self._chance.expovariate(spec.per_hour / 3600.0)

    def step(self, time: float, traffic: TrafficModel) -> None:
        """Let in whoever has arrived by now, one at a time."""
        if time < self._next or time >= self._spec.until:
            return
        kind: TrackKind = "truck" if self._truck_next() else "car"
        length, width = (8.5, 2.4) if kind == "truck" else (4.6, 1.8)
        if not traffic.room_at(self._spec.lane, length / 2, length / 2, 15.0):
            return
        self._count += 1
        self._next = max(self._next, time - 5.0) + self._chance.expovariate(self._spec.per_hour / 3600.0)
        mover = Mover(f"{self._spec.id}_{self._count}", kind, length, width, self._way(), self._tables, length / 2, 0.0, driver(kind, self._chance))
        mover.scattered = scattered(self._chance, self._settings)
        mover.speed = 0.8 * min(mover.wished_speed(time), mover.table.curve_speed)
        traffic.movers.append(mover)

    def _truck_next(self) -> bool:
        """Fixed for each arrival, however long it waits outside."""
        return random.Random(f"{self._spec.id} {self._count}").random() < self._spec.trucks

    def _way(self) -> tuple[str, ...]:
        """A route drawn junction by junction from what the lane offers."""
        route, weights = [self._spec.lane], dict(zip(("right", "straight", "left"), self._spec.turn_weights, strict=True))
        while len(route) < _LONGEST_ROUTE:
            onward = [name for name in self._map.lanes[route[-1]].successors if name not in route]
            if not onward:
                break
            odds = [weights.get(self._turn(name), 0.5) for name in onward]
            route.append(self._chance.choices(onward, odds if sum(odds) > 0.0 else None)[0])
        return tuple(route)

    def _turn(self, lane: str) -> Turn | str:
        return self._map.lanes[lane].turn or "on"
