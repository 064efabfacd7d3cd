"""A driven vehicle or cyclist: where on which lanes, how fast, and what its driver would like."""

from __future__ import annotations

import random
from dataclasses import dataclass

from regdb_runtime.observation import Track, TrackKind, TurnSignal
from regdb_runtime.planning.idm import IdmParameters
from regdb_runtime.worlds.built_in.lane_tables import LaneTable, LaneTables


@dataclass(frozen=True, slots=True)
class TrafficSettings:
    """How people drive; metres, seconds, SI.

    `scatter`: standard deviation of wished speed over the limit (free-flow surveys: about a tenth), at most `most_scatter`. `gap`: time to
    spare when giving way (HCM critical headways: 4-7 s, less the crossing's own time). `stop_short`: front from the limit line when standing.
    `stand`: time at a stop line before going on. `patience`: how long somebody who does not go is waited for; by `impatient_after` no time
    is to spare any more. `beside_bicycle`, `beside_parked`: clearance kept when passing. `lateral`: sideways speed. `looks_ahead`: seconds
    at which a walking pedestrian's place is kept clear.
    """

    scatter: float = 0.07
    most_scatter: float = 0.12
    comfortable: float = 2.0
    hardest: float = 3.5
    step: float = 0.1
    sight: float = 70.0
    gap: float = 2.0
    stop_short: float = 0.7
    stand: float = 1.2
    patience: float = 5.0
    impatient_after: float = 20.0
    beside_bicycle: float = 1.05
    beside_parked: float = 0.7
    lateral: float = 0.9
    right_on_red: bool = True
    looks_ahead: tuple[float, ...] = (0.0, 1.2, 2.4)


class Mover:
    """Held by the traffic; `station` and `offset` are of its middle along its present lane."""

    __slots__ = (
        "acceleration", "bicycle", "enters", "gone", "half_length", "half_width", "hazard_kind", "id", "idm", "kind", "leaves_at", "length",
        "offset", "place", "resting_offset", "route", "scattered", "speed", "speeds", "station", "stood", "stopped", "table", "tables",
        "waiting_since", "warning_lights", "weave", "width", "wish",
    )  # fmt: skip

    def __init__(
        self, name: str, kind: TrackKind, length: float, width: float, route: tuple[str, ...], tables: LaneTables, station: float, speed: float,
        idm: IdmParameters,
    ) -> None:  # fmt: skip
        self.id, self.kind, self.length, self.width = name, kind, length, width
        self.half_length, self.half_width = length / 2, width / 2
        self.route, self.place = route, 0
        self.tables = tables
        self.table: LaneTable = tables[route[0]]
        self.station, self.speed, self.acceleration = station, speed, 0.0
        self.offset = self.resting_offset = 0.0
        self.idm = idm
        self.bicycle = kind == "bicycle"
        self.wish: float | None = None
        self.scattered = 1.0
        self.speeds: tuple[tuple[float, float], ...] = ()
        self.enters = 0.0
        self.leaves_at: float | None = None
        self.weave = 0.0
        self.stood = 0.0
        self.stopped = False
        self.waiting_since: float | None = None
        self.warning_lights, self.hazard_kind = "none", "none"
        self.gone = False

    @property
    def following_lane(self) -> str | None:
        """The next lane of its route."""
        return self.route[self.place + 1] if self.place + 1 < len(self.route) else None

    def wished_speed(self, time: float) -> float:
        """What the driver would like here: told, or the limit as people take it."""
        wish = self.wish
        for since, told in self.speeds:
            if time >= since - 1e-9:
                wish = told
        return self.table.limit * self.scattered if wish is None else wish

    def advance(self, acceleration: float, step: float) -> None:
        """Move on by a step under an acceleration; stops rather than roll back; `gone` beyond the route's end."""
        before = self.speed
        self.speed = max(0.0, before + acceleration * step)
        self.acceleration = (self.speed - before) / step
        self.station += (before + self.speed) / 2 * step
        if self.leaves_at is not None and self.place == 0 and self.station >= self.leaves_at:
            self.gone = True
        while self.station > self.table.length:
            following = self.following_lane
            if following is None:
                self.gone = True
                return
            self.station -= self.table.length
            self.place += 1
            self.stopped, self.waiting_since = False, None
            before_half = self.table.half_width
            self.table = self.tables[following]
            if self.bicycle:
                shift = before_half - self.table.half_width
                self.offset += shift
                self.resting_offset += shift

    def track(self) -> Track:
        """As the ego's sensors see it."""
        x, y, heading = self.table.pose(self.station, self.offset)
        return Track(
            self.id, self.kind, x, y, heading, self.speed, self.length, self.width, self.acceleration, self.speed * self.table.bend(self.station),
            self._signal(), self.warning_lights, self.hazard_kind,
        )  # fmt: skip

    def _signal(self) -> TurnSignal:
        """Signalled from 40 m before the turn until it is done; cyclists are not seen to signal."""
        if self.bicycle:
            return "off"
        turn, following = self.table.turn, self.following_lane
        if turn is None and following is not None and self.table.length - self.station < 40.0:
            turn = self.tables[following].turn
        return "left" if turn == "left" else "right" if turn == "right" else "off"


def scattered(chance: random.Random, settings: TrafficSettings) -> float:
    """One driver's share of the limit."""
    return 1.0 + min(max(chance.gauss(0.0, settings.scatter), -settings.most_scatter), settings.most_scatter)
