"""Predicted road users as a path sees them, and how near every plan along that path comes to them: for the soft terms of the cost.

Distances here are taken along and across the path, at a few instants: right on a straight, and near enough on a bend to prefer one plan to
another. What the law and collision ask is measured in the plane (`contacts`).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from regdb_runtime.observation import Footprint
from regdb_runtime.planning.cost_settings import CostSettings
from regdb_runtime.planning.prediction import Path, Predictions
from regdb_runtime.planning.safe_distance import SafeDistances, shortfall
from regdb_runtime.trajectory import Candidates

Floats = NDArray[Any]


@dataclass(frozen=True, eq=False)
class UsersAlongPath:
    """M nearby road users at the instants `indices` (t,) of the plans: middle `s`, `d`, speeds `s_dot`, `d_dot`, and half their extents along
    and across the path, (M, t) each, SI. `center`, `half_length`, `half_width`: the vehicle's own, from its rear axle."""

    indices: NDArray[np.int64]
    s: Floats
    d: Floats
    s_dot: Floats
    d_dot: Floats
    half_along: Floats
    half_across: Floats
    center: float
    half_length: float
    half_width: float

    def __len__(self) -> int:
        return len(self.s)


def users_along(path: Path, predictions: Predictions, ego: tuple[float, float], footprint: Footprint, settings: CostSettings) -> UsersAlongPath:
    """Those who come within `settings.nearby` of the vehicle's place now (x, y) at some instant, at most `nearby_most`, the nearest first."""
    instants = _instants(len(predictions.time), settings.instants)
    away = np.hypot(predictions.x[:, instants] - ego[0], predictions.y[:, instants] - ego[1]).min(axis=1, initial=np.inf)
    rows = np.argsort(away, kind="stable")[: settings.nearby_most]
    rows = rows[away[rows] <= settings.nearby]
    x, y, heading, speed = (part[rows][:, instants] for part in (predictions.x, predictions.y, predictions.heading, predictions.speed))
    s, d = (part.reshape(x.shape) for part in path.project(np.stack((x.ravel(), y.ravel()), axis=1), extend=True))
    turn = heading - path.heading(np.minimum(np.maximum(s, path.start), path.end))
    cos, sin = np.cos(turn), np.sin(turn)
    long, wide = predictions.length[rows, None] / 2, predictions.width[rows, None] / 2
    reach = predictions.reach[rows][:, instants]
    along, across = long * np.abs(cos) + wide * np.abs(sin) + reach, long * np.abs(sin) + wide * np.abs(cos) + reach
    return UsersAlongPath(
        instants, s, d, speed * cos, speed * sin, along, across, footprint.center, footprint.length / 2, footprint.width / 2
    )


@cache
def _instants(points: int, wanted: int) -> NDArray[np.int64]:
    """So many of a plan's instants, evenly spread; not to be written to."""
    return np.unique(np.linspace(0, points - 1, wanted).round().astype(np.int64))


def nearness(candidates: Candidates, settings: CostSettings, users: UsersAlongPath) -> Mapping[str, Floats]:
    """Worst over users and instants, (N,) from 0 to 1: how much of the wanted clearance is missing, and of the safe longitudinal and lateral
    distance. Of the safe distances (arXiv:1708.06374) each counts only while the other is missing too: beside one another or far behind
    one another nobody is in danger. Whoever drives behind in our own way keeps his distance himself."""
    found = {name: np.zeros(len(candidates)) for name in ("clearance", "rss_longitudinal", "rss_lateral")}
    if len(users):
        plans = _at(candidates, users, settings.safe)
        for user in range(len(users)):
            _worsen(found, plans, users, user, settings)
    return found


@dataclass(frozen=True, eq=False)
class _Plans:
    """All plans at the instants looked at, (t, N): the instants first, so that the worst of a plan is found row by row.

    `station` counts from `origin`. `rear`, `front`: the plan's halves of the longitudinal distance; `leftwards`, `rightwards`: those of the
    lateral one, towards either side. `lowest`, `highest`: offsets among all plans, (t, 1); `most_needed`: the greatest of the lateral halves.
    """

    origin: float
    station: Floats
    offset: Floats
    rear: Floats
    front: Floats
    leftwards: Floats
    rightwards: Floats
    lowest: Floats
    highest: Floats
    most_needed: float


def _at(candidates: Candidates, users: UsersAlongPath, safe: SafeDistances) -> _Plans:
    at = users.indices
    after, before = np.minimum(at + 1, len(candidates.time) - 1), np.maximum(at - 1, 0)
    origin = candidates.station[0, 0]
    station = _sharp((candidates.station[:, at] - origin).T)
    offset, speed = _sharp(candidates.offset[:, at].T), _sharp(candidates.speed[:, at].T)
    rate = (candidates.offset[:, after] - candidates.offset[:, before]).T / (candidates.time[after] - candidates.time[before])[:, None]
    rate = _sharp(rate)
    left, right = safe.side(rate), safe.side(-rate)
    return _Plans(
        float(origin), station + np.float32(users.center), offset, safe.rear(speed), safe.front(speed), left, right,
        offset.min(axis=1, keepdims=True), offset.max(axis=1, keepdims=True), max(float(left.max()), float(right.max())),
    )  # fmt: skip


def _sharp(values: Floats) -> Floats:
    """In single precision, row by row: 0.01 mm over a hundred metres, at half the memory and time."""
    return np.ascontiguousarray(values, dtype=np.float32)


def _worsen(found: Mapping[str, Floats], plans: _Plans, users: UsersAlongPath, user: int, settings: CostSettings) -> None:
    """Take one user into the worst so far; one that no plan comes near is done at once."""
    safe, wanted = settings.safe, settings.wanted_clearance
    s, d, s_dot, d_dot, half_along, half_across = (
        _sharp(part[user])[:, None] for part in (users.s - plans.origin, users.d, users.s_dot, users.d_dot, users.half_along, users.half_across)
    )
    to_right, to_left = safe.side(-d_dot), safe.side(d_dot)
    least = np.maximum(d - plans.highest, plans.lowest - d) - half_across - users.half_width
    if (least > np.maximum(wanted, safe.fluctuation_margin + plans.most_needed + np.maximum(to_right, to_left))).all():
        return
    aside, ahead = d - plans.offset, s - plans.station
    gap_across, gap_along = np.abs(aside) - (half_across + users.half_width), np.abs(ahead) - (half_along + users.half_length)
    _worsen_clearance(found["clearance"], gap_along, gap_across, wanted)
    if _behind_us_now(users, user, plans.origin + float(plans.station[0, 0]), float(plans.offset[0, 0])):
        return
    needed_across = _choose(aside > 0.0, plans.leftwards + to_right, plans.rightwards + to_left)
    across = shortfall(gap_across, safe.fluctuation_margin + np.maximum(needed_across, 0.0))
    along = shortfall(gap_along, np.maximum(_needed_along(ahead, plans, s_dot, safe), 0.0))
    np.maximum(found["rss_longitudinal"], (along * (across > 0.0)).max(axis=0), out=found["rss_longitudinal"])
    np.maximum(found["rss_lateral"], (across * (along > 0.0)).max(axis=0), out=found["rss_lateral"])


def _choose(where: NDArray[np.bool_], yes: Floats, no: Floats) -> Floats:
    """As numpy's where; most users are on one side of all plans, and then nothing need be mixed."""
    return yes if where.all() else np.where(where, yes, no) if where.any() else no


def _worsen_clearance(found: Floats, gap_along: Floats, gap_across: Floats, wanted: float) -> None:
    out_along, out_across = np.maximum(gap_along, 0.0), np.maximum(gap_across, 0.0)
    nearest = np.sqrt((out_along * out_along + out_across * out_across).min(axis=0))
    np.maximum(found, 1.0 - np.minimum(nearest / wanted, 1.0), out=found)


def _needed_along(ahead: Floats, plans: _Plans, s_dot: Floats, safe: SafeDistances) -> Floats:
    """Definition 1 for whoever goes the same way (the rear one needs the gap), both stopping ways for one ahead who comes towards us."""
    towards = s_dot < 0.0
    theirs = np.where(towards, safe.rear(np.abs(s_dot)), -safe.front(s_dot))
    behind = np.where(towards, -np.inf, safe.rear(s_dot))
    return _choose(ahead > 0.0, plans.rear + theirs, behind - plans.front)


def _behind_us_now(users: UsersAlongPath, user: int, center: float, offset: float) -> bool:
    """Whether a user is behind the vehicle in its own way at the first instant."""
    within = abs(float(users.d[user, 0]) - offset) < float(users.half_across[user, 0]) + users.half_width
    return within and float(users.s[user, 0]) < center
