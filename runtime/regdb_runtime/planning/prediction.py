"""Where other road users will be: prediction behind one protocol, by constant velocity, by the intelligent driver model, or as recorded."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from regdb_runtime.geometry import Boxes, boxes
from regdb_runtime.observation import Track
from regdb_runtime.planning.idm import IdmParameters, idm_acceleration

Floats = NDArray[np.float64]
ON_FOOT = frozenset(("pedestrian", "animal"))
DRIVEN = frozenset(("car", "truck", "bus", "motorcycle"))


@dataclass(frozen=True, eq=False)
class Predictions:
    """M road users over T instants: `x`, `y` (middle), `heading`, `speed` (M, T); `length`, `width` (M,); SI, radians.

    `reach` (M, T): how far from there each may be all the same, metres; contacts count a body grown by it.
    """

    ids: tuple[str, ...]
    kinds: tuple[str, ...]
    time: Floats
    x: Floats
    y: Floats
    heading: Floats
    speed: Floats
    length: Floats
    width: Floats
    reach: Floats

    def __len__(self) -> int:
        return len(self.ids)

    @property
    def boxes(self) -> Boxes:
        """Their rectangles, (M, T), without reach."""
        return boxes(self.x, self.y, self.heading, self.length[:, None], self.width[:, None])

    def row(self, track: str) -> int:
        """The row of a road user. Raises KeyError for one that is not predicted."""
        try:
            return self.ids.index(track)
        except ValueError:
            raise KeyError(track) from None


class Predictor(Protocol):
    """Whatever can say where road users will be; pure: the same input gives the same bytes."""

    def predict(self, tracks: Sequence[Track], times: Floats) -> Predictions:
        """Poses at `times` (T,), seconds from now, one row per track in its order."""
        ...


class Path(Protocol):
    """What a predicted road user follows: a reference path of the map (`maps.reference_path.ReferencePath`)."""

    @property
    def start(self) -> float: ...
    @property
    def end(self) -> float: ...
    def project(self, xy: Floats, extend: bool = False) -> tuple[Floats, Floats]: ...
    def to_plane(self, s: Floats, d: Floats) -> Floats: ...
    def heading(self, s: Floats) -> Floats: ...
    def extended(self, before: float = 0.0, after: float = 0.0) -> Path: ...


@dataclass(frozen=True, slots=True)
class ReachSettings:
    """How far somebody on foot may stray from constant velocity: `base` metres at once, `rate` metres a second more, `most` at most.

    A walker can turn or set off within a step (0.7 m/s is half a walking pace), but a plan need not yield the whole road to one on the
    pavement: so the reach ends at the walker's own room.
    """

    base: float = 0.1
    rate: float = 0.3
    most: float = 0.6


@dataclass(frozen=True)
class ConstantVelocity:
    """Everybody goes on as they are; with `turning` along the arc of the yaw rate, for `turning_time` at most (a yaw rate does not last)."""

    turning: bool = True
    turning_time: float = 2.0
    reach: ReachSettings = field(default_factory=ReachSettings)

    def predict(self, tracks: Sequence[Track], times: Floats) -> Predictions:
        """See `Predictor`."""
        rates = _column(tracks, "yaw_rate") if self.turning else np.zeros((len(tracks), 1))
        return _along_arcs(tracks, times, _column(tracks, "speed") * times, rates, self.turning_time, self.reach)


@dataclass(frozen=True)
class IdmPrediction:
    """Vehicles follow their leader by the intelligent driver model; everybody else as by constant velocity.

    Each vehicle keeps to its path where `paths` knows one for its id, else to the arc of its yaw rate. Its leader is whoever is nearest
    ahead of it within half a lane of its way now. It wants `desired_speeds[id]`, else the speed it has or the parameters' own if that is less.
    """

    parameters: IdmParameters = field(default_factory=IdmParameters)
    paths: Mapping[str, Path] = field(default_factory=dict)
    desired_speeds: Mapping[str, float] = field(default_factory=dict)
    half_lane: float = 1.5
    step: float = 0.1
    turning_time: float = 2.0
    reach: ReachSettings = field(default_factory=ReachSettings)

    def predict(self, tracks: Sequence[Track], times: Floats) -> Predictions:
        """See `Predictor`."""
        leaders = [self._leader(track, tracks) for track in tracks]
        ways, speeds = self._drive(tracks, leaders, times)
        found = _along_arcs(tracks, times, ways, _column(tracks, "yaw_rate"), self.turning_time, self.reach)
        x, y, heading = found.x.copy(), found.y.copy(), found.heading.copy()
        for row, track in enumerate(tracks):
            path = self.paths.get(track.id)
            if path is not None:
                x[row], y[row], heading[row] = _along_path(path, track, ways[row])
        return Predictions(found.ids, found.kinds, times, x, y, heading, speeds, found.length, found.width, found.reach)

    def _leader(self, own: Track, tracks: Sequence[Track]) -> tuple[int, float] | None:
        """Row of the leader and the gap to it now, bumper to bumper."""
        best: tuple[int, float] | None = None
        for row, other in enumerate(tracks):
            if other is own or own.kind not in DRIVEN:
                continue
            ahead, aside = self._seen_from(own, other)
            gap = ahead - (own.length + other.length) / 2
            if ahead > 0.0 and abs(aside) < self.half_lane and (best is None or gap < best[1]):
                best = row, gap
        return best

    def _seen_from(self, own: Track, other: Track) -> tuple[float, float]:
        """How far ahead and aside the other one is along the way of this one."""
        path = self.paths.get(own.id)
        if path is not None:
            s, d = path.project(np.array([[own.x, own.y], [other.x, other.y]]), extend=True)
            return float(s[1] - s[0]), float(d[1] - d[0])
        dx, dy = other.x - own.x, other.y - own.y
        cos, sin = math.cos(own.heading), math.sin(own.heading)
        return dx * cos + dy * sin, dy * cos - dx * sin

    def _drive(self, tracks: Sequence[Track], leaders: Sequence[tuple[int, float] | None], times: Floats) -> tuple[Floats, Floats]:
        """Ways and speeds (M, T): the model stepped for all together, then read at the instants asked for."""
        count = len(tracks)
        grid: Floats = np.arange(math.ceil(float(times[-1]) / self.step - 1e-9) + 1) * np.float64(self.step)
        ways, speeds = np.zeros((count, len(grid))), np.zeros((count, len(grid)))
        speeds[:, 0] = [track.speed for track in tracks]
        wanted = np.array([self.desired_speeds.get(t.id, min(max(t.speed, 1e-3), self.parameters.desired_speed)) for t in tracks])
        driven = np.array([track.kind in DRIVEN for track in tracks], dtype=bool)
        lead = np.array([-1 if found is None else found[0] for found in leaders], dtype=np.int64)
        room = np.array([math.inf if found is None else found[1] for found in leaders])
        pairs = zip(tracks, leaders, strict=True)
        toward = np.array([1.0 if found is None else math.cos(tracks[found[0]].heading - own.heading) for own, found in pairs])
        for now in range(len(grid) - 1):
            speed = speeds[:, now]
            gap = np.where(lead >= 0, room + toward * ways[lead, now] - ways[:, now], np.inf)
            closing = np.where(lead >= 0, speed - toward * speeds[lead, now], 0.0)
            rate = np.where(driven, idm_acceleration(speed, gap, closing, self.parameters, wanted), 0.0)
            after = np.maximum(speed + rate * self.step, 0.0)
            speeds[:, now + 1], ways[:, now + 1] = after, ways[:, now] + (speed + after) / 2 * self.step
        return _read(grid, ways, times), _read(grid, speeds, times)


@dataclass(frozen=True, eq=False)
class Recording:
    """The known motion of one road user: `time` (K,) ascending, in the run's seconds; the rest (K,)."""

    time: Floats
    x: Floats
    y: Floats
    heading: Floats
    speed: Floats


@dataclass(frozen=True)
class Recorded:
    """Known futures by id, seen from `now` (the run's seconds); whoever has none, or whose record ends, goes on at constant velocity."""

    recordings: Mapping[str, Recording]
    now: float = 0.0
    otherwise: ConstantVelocity = field(default_factory=ConstantVelocity)

    def at(self, now: float) -> Recorded:
        """The same recordings seen from another instant."""
        return Recorded(self.recordings, now, self.otherwise)

    def predict(self, tracks: Sequence[Track], times: Floats) -> Predictions:
        """See `Predictor`."""
        found = self.otherwise.predict(tracks, times)
        parts = [part.copy() for part in (found.x, found.y, found.heading, found.speed, found.reach)]
        for row, track in enumerate(tracks):
            record = self.recordings.get(track.id)
            if record is not None:
                self._fill(record, times, [part[row] for part in parts])
        x, y, heading, speed, reach = parts
        return Predictions(found.ids, found.kinds, times, x, y, heading, speed, found.length, found.width, reach)

    def _fill(self, record: Recording, times: Floats, row: Sequence[Floats]) -> None:
        x, y, heading, speed, reach = row
        when = np.minimum(self.now + times, record.time[-1])
        past = self.now + times - when
        turns = np.interp(when, record.time, np.unwrap(record.heading))
        rate = np.interp(when, record.time, record.speed)
        x[:] = np.interp(when, record.time, record.x) + past * rate * np.cos(turns)
        y[:] = np.interp(when, record.time, record.y) + past * rate * np.sin(turns)
        heading[:], speed[:] = turns, rate
        reach[past == 0.0] = 0.0


def _column(tracks: Sequence[Track], name: str) -> Floats:
    return np.array([getattr(track, name) for track in tracks], dtype=np.float64).reshape(len(tracks), 1)


def _read(grid: Floats, rows: Floats, times: Floats) -> Floats:
    return np.stack([np.interp(times, grid, row) for row in rows]) if len(rows) else np.zeros((0, len(times)))


def _along_path(path: Path, track: Track, ways: Floats) -> tuple[Floats, Floats, Floats]:
    """Middle and heading of a road user that keeps its offset from its path, straight on beyond the path's ends."""
    s, d = path.project(np.array([[track.x, track.y]]), extend=True)
    stations = s[0] + ways
    path = path.extended(max(0.0, path.start - float(stations[0])), max(0.0, float(stations[-1]) - path.end))
    plane = path.to_plane(stations, np.full_like(stations, d[0]))
    return plane[:, 0], plane[:, 1], path.heading(stations)


def _along_arcs(
    tracks: Sequence[Track], times: Floats, ways: Floats, yaw_rates: Floats, turning_time: float, reach: ReachSettings
) -> Predictions:
    """Everybody along the arc of its yaw rate while that lasts, straight on after, by the ways (M, T) they cover."""
    x, y, heading, speed = (_column(tracks, name) for name in ("x", "y", "heading", "speed"))
    moving = speed > 0.1
    curvature = np.where(moving, yaw_rates / np.where(moving, speed, 1.0), 0.0)
    on_arc = np.minimum(ways, speed * turning_time)
    turn = curvature * on_arc
    chord, end = on_arc * np.sinc(turn / (2 * math.pi)), heading + turn
    straight = ways - on_arc
    on_foot = np.array([track.kind in ON_FOOT for track in tracks], dtype=bool).reshape(len(tracks), 1)
    grown = np.where(on_foot, np.minimum(reach.base + reach.rate * times, reach.most), 0.0)
    return Predictions(
        tuple(track.id for track in tracks), tuple(track.kind for track in tracks), times,
        x + chord * np.cos(heading + turn / 2) + straight * np.cos(end), y + chord * np.sin(heading + turn / 2) + straight * np.sin(end),
        end, np.broadcast_to(speed, ways.shape).copy(), _column(tracks, "length")[:, 0], _column(tracks, "width")[:, 0], grown,
    )  # fmt: skip
