"""Contacts and clearances of planned motion with predicted road users, over the whole swept time, between the instants too.

Between two instants poses go over linearly into one another (heading by the shorter way). An interval in which the circles about two
rectangles could meet is cut so finely that no point of one moves more than `RESOLUTION` against the other from cut to cut; at every cut the
rectangles are tested grown by half of that. So nothing is jumped over, however thin: a contact of the interpolated motion is always found, and a
miss by more than `RESOLUTION / sqrt(2)` (4 cm) is never called one.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from regdb_runtime.geometry import Boxes, boxes, distance, overlap
from regdb_runtime.observation import Footprint
from regdb_runtime.planning.prediction import Predictions
from regdb_runtime.trajectory import Candidates, Trajectory

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
Ends = tuple[tuple[Floats, Floats], tuple[Floats, Floats], tuple[Floats, Floats]]
"""x, y and heading at both ends of some intervals."""

RESOLUTION: Final = 0.06
"""Relative motion from cut to cut, metres."""
MOST_CUTS: Final = 64
"""Cuts of one interval at most: 3.8 m of relative motion in one step, 38 m/s at 10 Hz; beyond, the growth follows the coarser cut."""


@dataclass(frozen=True, eq=False)
class Contacts:
    """For k plans: time of the first contact (seconds from now, inf without one) and the row of the road user in the predictions (-1)."""

    time: Floats
    track: Integers

    @property
    def free(self) -> NDArray[np.bool_]:
        """Which plans touch nothing."""
        return np.isinf(self.time)


class Sweeper:
    """Predictions made ready once per tick, to test plans against them one by one in the order of their cost."""

    def __init__(self, predictions: Predictions, footprint: Footprint, margin: float = 0.0) -> None:
        self.predictions, self.footprint, self.margin = predictions, footprint, margin
        self._radius = np.hypot(predictions.length, predictions.width) / 2 + float(np.hypot(footprint.length, footprint.width)) / 2 + margin
        self._reach = predictions.reach if len(predictions) else np.zeros((0, len(predictions.time)))
        self._wide = self._radius[:, None] + self._reach

    def first_contact(self, x: Floats, y: Floats, heading: Floats) -> tuple[float, int]:
        """Time and row of the first contact of one plan (rear axle, (T,) each); (inf, -1) without one."""
        seen = self.predictions
        if not len(seen):
            return np.inf, -1
        steps = min(len(x), len(seen.time))
        own_x, own_y = x + self.footprint.center * np.cos(heading), y + self.footprint.center * np.sin(heading)
        dx, dy = seen.x[:, :steps] - own_x[:steps], seen.y[:, :steps] - own_y[:steps]
        away = np.sqrt(dx * dx + dy * dy)
        room = away - self._wide[:, :steps]
        # the middle of one goes from one end of an interval to the other in a straight line, as the other one sees it: it comes nearer than
        # both ends by half that line at most
        line = np.hypot(dx[:, 1:] - dx[:, :-1], dy[:, 1:] - dy[:, :-1])
        near = np.minimum(room[:, :-1], room[:, 1:]) <= line / 2
        users, intervals = np.nonzero(near)
        if not len(users):
            return np.inf, -1
        return self._finely(own_x, own_y, heading, users, intervals)

    def _finely(self, x: Floats, y: Floats, heading: Floats, users: Integers, intervals: Integers) -> tuple[float, int]:
        """The first contact within some intervals of some users, in the order of time (of equal times the first row)."""
        order = np.argsort(intervals, kind="stable")
        for part in _pieces(order, 32):
            rows, starts = users[part], intervals[part]
            shares, own, other, grown = self._cuts(x, y, heading, rows, starts)
            hits = overlap(own.grown(grown), other)
            if hits.any():
                time = self.predictions.time
                when = np.where(hits, time[starts, None] + shares * (time[starts + 1] - time[starts])[:, None], np.inf)
                first = when.min(axis=1)
                best = int(np.lexsort((rows, first))[0])
                return float(first[best]), int(rows[best])
        return np.inf, -1

    def _cuts(self, x: Floats, y: Floats, heading: Floats, rows: Integers, starts: Integers) -> tuple[Floats, Boxes, Boxes, Floats]:
        """Both rectangles at the cuts of each interval, (I, C), and how much to grow them."""
        seen = self.predictions
        own = _ends(x, y, heading, starts)
        other = _ends(seen.x, seen.y, seen.heading, starts, rows)
        moved = np.hypot(*(own[i][1] - own[i][0] - other[i][1] + other[i][0] for i in (0, 1)))
        moved += np.abs(own[2][1] - own[2][0]) * self.footprint.length / 2 + np.abs(other[2][1] - other[2][0]) * seen.length[rows] / 2
        cuts = int(np.clip(np.ceil(float(moved.max()) / RESOLUTION), 1, MOST_CUTS)) + 1
        shares = np.linspace(0.0, 1.0, cuts)
        reach = np.maximum(self._reach[rows, starts], self._reach[rows, starts + 1])
        grown = self.margin + reach + moved / (cuts - 1) / 2
        x_own, y_own, heading_own = (_between(part, shares) for part in own)
        x_other, y_other, heading_other = (_between(part, shares) for part in other)
        ours = boxes(x_own, y_own, heading_own, self.footprint.length, self.footprint.width)
        theirs = boxes(x_other, y_other, heading_other, seen.length[rows, None], seen.width[rows, None])
        return shares, ours, theirs, grown[:, None]


def first_contact(
    plans: Trajectory | Candidates, footprint: Footprint, predictions: Predictions, margin: float = 0.0, rows: Integers | None = None
) -> Contacts:
    """First contacts of some plans (all of them, or those `rows`), in their order; plans and predictions share their instants."""
    sweeper = Sweeper(predictions, footprint, margin)
    found = [sweeper.first_contact(*plan) for plan in _plans(plans, rows)]
    return Contacts(np.array([time for time, _ in found]), np.array([track for _, track in found], dtype=np.int64))


def best_free(
    plans: Candidates, order: Integers, footprint: Footprint, predictions: Predictions, margin: float = 0.0
) -> tuple[int | None, dict[int, tuple[float, str]]]:
    """The first plan of `order` that touches nothing, and for those tried before it the time of contact and whom they touch."""
    sweeper = Sweeper(predictions, footprint, margin)
    hit: dict[int, tuple[float, str]] = {}
    for index in order.tolist():
        time, row = sweeper.first_contact(plans.x[index], plans.y[index], plans.heading[index])
        if row < 0:
            return index, hit
        hit[index] = time, predictions.ids[row]
    return None, hit


def clearances(plans: Trajectory | Candidates, footprint: Footprint, predictions: Predictions, track: str, rows: Integers | None = None) -> Floats:
    """Distance between any part of the vehicle and any part of one road user at each instant, (k, T) metres. Raises KeyError."""
    row = predictions.row(track)
    x, y, heading = _stacked(plans, rows)
    other = predictions.boxes[row][: x.shape[1]]
    return distance(_own(x, y, heading, footprint), other)


def least_clearance(
    plans: Trajectory | Candidates, footprint: Footprint, predictions: Predictions, track: str, rows: Integers | None = None, cuts: int = 8
) -> Floats:
    """The least of those distances over the whole time, (k,): between the instants looked at `cuts` times each. Raises KeyError.

    Between two looks a distance cannot fall by more than half the relative motion; a pass at 10 m/s more, at 10 Hz, is looked at every 0.13 m,
    so that a least distance of 1 m beside a straight side is right to 2 mm.
    """
    row = predictions.row(track)
    x, y, heading = _stacked(plans, rows)
    shares = np.linspace(0.0, 1.0, cuts + 1)[1:]
    other = [part[row : row + 1, : x.shape[1]] for part in (predictions.x, predictions.y, predictions.heading)]
    own = _own(_refined(x, shares), _refined(y, shares), _refined(heading, shares, turns=True), footprint)
    size = predictions.length[row], predictions.width[row]
    body = boxes(_refined(other[0], shares), _refined(other[1], shares), _refined(other[2], shares, turns=True), *size)
    return np.asarray(distance(own, body).min(axis=1))


def _plans(plans: Trajectory | Candidates, rows: Integers | None) -> Iterator[tuple[Floats, Floats, Floats]]:
    yield from zip(*_stacked(plans, rows), strict=True)


def _stacked(plans: Trajectory | Candidates, rows: Integers | None) -> tuple[Floats, Floats, Floats]:
    x, y, heading = (np.atleast_2d(part) for part in (plans.x, plans.y, plans.heading))
    return (x, y, heading) if rows is None else (x[rows], y[rows], heading[rows])


def _own(x: Floats, y: Floats, heading: Floats, footprint: Footprint) -> Boxes:
    cos, sin = np.cos(heading), np.sin(heading)
    half = np.asarray(footprint.length / 2), np.asarray(footprint.width / 2)
    return Boxes(x + footprint.center * cos, y + footprint.center * sin, cos, sin, *half)


def _ends(x: Floats, y: Floats, heading: Floats, starts: Integers, rows: Integers | None = None) -> Ends:
    """Values at both ends of some intervals; the second heading is the one nearest to the first."""
    first = starts if rows is None else (rows, starts)
    last = starts + 1 if rows is None else (rows, starts + 1)
    turn = heading[last] - heading[first]
    turn -= 2 * np.pi * np.round(turn / (2 * np.pi))
    return (x[first], x[last]), (y[first], y[last]), (heading[first], heading[first] + turn)


def _between(ends: tuple[Floats, Floats], shares: Floats) -> Floats:
    return ends[0][:, None] + (ends[1] - ends[0])[:, None] * shares


def _refined(values: Floats, shares: Floats, turns: bool = False) -> Floats:
    """Values (k, T) with looks between the instants, (k, 1 + (T - 1) * len(shares))."""
    step = np.diff(values, axis=1)
    if turns:
        step -= 2 * np.pi * np.round(step / (2 * np.pi))
    between = values[:, :-1, None] + step[:, :, None] * shares
    return np.concatenate((values[:, :1], between.reshape(len(values), -1)), axis=1)


def _pieces(order: Integers, size: int) -> Iterator[Integers]:
    for start in range(0, len(order), size):
        yield order[start : start + size]
