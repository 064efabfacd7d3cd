"""Contacts and clearances of planned motion with predicted road users, over the whole swept time, between the instants too.

Between two instants poses go over linearly into one another (heading by the shorter way). An interval in which the circles, and then the
rectangles, could meet at all is cut so finely that no point of one moves more than `RESOLUTION` against the other from cut to cut; at every cut the
rectangles are tested grown by half of that. So nothing is jumped over, however thin: a contact of the interpolated motion is always found, and a
miss by more than `RESOLUTION / sqrt(2)` (4 cm) is never called one.
"""

from __future__ import annotations

import math
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
Own = tuple[Floats, Floats, Floats, Floats]
"""Middle x and y of the vehicle's rectangle and its heading (T,), and the change of heading to the next instant (T - 1,)."""

RESOLUTION: Final = 0.06
"""Relative motion from cut to cut, metres."""
MOST_CUTS: Final = 64
"""Cuts of one interval at most: 3.8 m of relative motion in one step, 38 m/s at 10 Hz; beyond, the growth follows the coarser cut."""


@dataclass(frozen=True, eq=False)
class Contacts:
    """For k plans: time of the first contact (seconds from now; inf without one) and the row of the road user in the predictions (-1).

    The time is never later than the contact, and earlier by 6 cm of motion at most.
    """

    time: Floats
    track: Integers

    @property
    def free(self) -> NDArray[np.bool_]:
        """Which plans touch nothing."""
        return np.isinf(self.time)


class Sweeper:
    """Predictions made ready once per tick, to test plans against them one by one in the order of their cost.

    `among`: plans that will be tested; whom none of them comes near is left out from the start.
    """

    def __init__(self, predictions: Predictions, footprint: Footprint, margin: float = 0.0, among: Candidates | None = None) -> None:
        self.predictions, self.footprint, self.margin = predictions, footprint, margin
        self._wide = np.hypot(predictions.length, predictions.width) / 2 + math.hypot(footprint.length, footprint.width) / 2 + margin
        self._users = np.arange(len(predictions)) if among is None else self._reachable(among)
        x, y, heading, reach = (part[self._users] for part in (predictions.x, predictions.y, predictions.heading, predictions.reach))
        self._x, self._y, self._heading = x, y, heading
        self._turn = _turns(heading)
        self._grown = np.maximum(reach[:, 1:], reach[:, :-1]) + margin
        self._half = predictions.length[self._users, None] / 2, predictions.width[self._users, None] / 2
        self._middle = (x[:, 1:] + x[:, :-1]) / 2, (y[:, 1:] + y[:, :-1]) / 2
        self._step = x[:, 1:] - x[:, :-1], y[:, 1:] - y[:, :-1]
        middle = heading[:, :-1] + self._turn / 2
        self._direction = np.cos(middle), np.sin(middle)
        self._round = self._wide[self._users, None] - margin + self._grown

    def _reachable(self, plans: Candidates) -> Integers:
        """Rows of users that come into the square about all plans at some instant, grown by what each moves until the next."""
        seen, steps = self.predictions, min(len(plans.time), len(self.predictions.time))
        near = np.ones((len(seen), steps), dtype=bool)
        for own, other in ((plans.x, seen.x), (plans.y, seen.y)):
            low, high = own[:, :steps].min(axis=0), own[:, :steps].max(axis=0)
            room = self._wide[:, None] + abs(self.footprint.center) + seen.reach[:, :steps]
            room += _widest(other[:, :steps]) + np.maximum(_widest(low[None]), _widest(high[None]))
            near &= (other[:, :steps] >= low - room) & (other[:, :steps] <= high + room)
        return np.flatnonzero(near.any(axis=1))

    def first_contact(self, x: Floats, y: Floats, heading: Floats) -> tuple[float, int]:
        """Time and row of the first contact of one plan (rear axle, (T,) each); (inf, -1) without one."""
        if not len(self._users):
            return math.inf, -1
        cos, sin = np.cos(heading), np.sin(heading)
        own_x, own_y = x + self.footprint.center * cos, y + self.footprint.center * sin
        turn = _turns(heading)
        # An interval is tested at its middle, grown by all that one can move against the other until either end
        dx = self._middle[0] - (own_x[1:] + own_x[:-1]) / 2
        dy = self._middle[1] - (own_y[1:] + own_y[:-1]) / 2
        moved = np.hypot(self._step[0] - (own_x[1:] - own_x[:-1]), self._step[1] - (own_y[1:] - own_y[:-1]))
        moved += np.abs(self._turn) * self._half[0] + np.abs(turn) * (self.footprint.length / 2)
        within = self._round + moved / 2
        users, intervals = np.nonzero(dx * dx + dy * dy <= within * within)
        if not len(users):
            return math.inf, -1
        middle = heading[intervals] + turn[intervals] / 2
        own = boxes(0.0, 0.0, middle, self.footprint.length, self.footprint.width)
        pair = users, intervals
        other = Boxes(
            dx[pair], dy[pair], self._direction[0][pair], self._direction[1][pair], self._half[0][users, 0], self._half[1][users, 0]
        )
        touching = overlap(own.grown(self._grown[pair] + moved[pair] / 2), other)
        if not touching.any():
            return math.inf, -1
        return self._finely((own_x, own_y, heading, turn), users[touching], intervals[touching], moved[pair][touching])

    def _finely(self, own: Own, users: Integers, intervals: Integers, moved: Floats) -> tuple[float, int]:
        """The first contact within some intervals of some users, in the order of time (of equal times the first row)."""
        order = np.argsort(intervals, kind="stable")
        first: tuple[float, int] = math.inf, -1
        for start in range(0, len(order), 6):
            part = order[start : start + 6]
            if self.predictions.time[intervals[part[0]]] >= first[0]:
                break
            found = self._cut(own, users[part], intervals[part], moved[part])
            if found[1] >= 0 and (found[0], found[1]) < (first[0], first[1]):
                first = found
        return first

    def _cut(self, own: Own, users: Integers, intervals: Integers, moved: Floats) -> tuple[float, int]:
        """The same, for intervals tested together at every cut."""
        x, y, heading, turn = own
        cuts = min(max(math.ceil(float(moved.max()) / RESOLUTION), 1), MOST_CUTS)
        shares = np.linspace(0.0, 1.0, cuts + 1)
        at, other_at = intervals, (users, intervals)
        dx = _between(self._x[other_at] - x[at], self._step[0][other_at] - (x[at + 1] - x[at]), shares)
        dy = _between(self._y[other_at] - y[at], self._step[1][other_at] - (y[at + 1] - y[at]), shares)
        ours = boxes(0.0, 0.0, _between(heading[at], turn[at], shares), self.footprint.length, self.footprint.width)
        facing = _between(self._heading[other_at], self._turn[other_at], shares)
        theirs = boxes(dx, dy, facing, 2 * self._half[0][users], 2 * self._half[1][users])
        hits = overlap(ours.grown((self._grown[other_at] + moved / cuts / 2)[:, None]), theirs)
        if not hits.any():
            return math.inf, -1
        time = self.predictions.time
        earliest = np.maximum(shares - 0.5 / cuts, 0.0)  # a cut speaks for half of what lies to either side of it
        when = np.where(hits, _between(time[at], time[at + 1] - time[at], earliest), np.inf).min(axis=1)
        best = int(np.lexsort((users, when))[0])
        return float(when[best]), int(self._users[users[best]])


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
    sweeper = Sweeper(predictions, footprint, margin, plans)
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


def _between(start: Floats, change: Floats, shares: Floats) -> Floats:
    return start[:, None] + change[:, None] * shares


def _turns(heading: Floats) -> Floats:
    """Change of heading from each instant to the next, by the shorter way."""
    turn = np.diff(heading, axis=-1)
    return np.asarray(turn - 2 * np.pi * np.round(turn / (2 * np.pi)))


def _widest(values: Floats) -> Floats:
    """The greatest step of each row, (k, 1)."""
    return np.asarray(np.abs(np.diff(values, axis=1)).max(axis=1, keepdims=True, initial=0.0))


def _refined(values: Floats, shares: Floats, turns: bool = False) -> Floats:
    """Values (k, T) with looks between the instants, (k, 1 + (T - 1) * len(shares))."""
    step = _turns(values) if turns else np.diff(values, axis=1)
    between = values[:, :-1, None] + step[:, :, None] * shares
    return np.concatenate((values[:, :1], between.reshape(len(values), -1)), axis=1)

