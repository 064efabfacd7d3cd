"""Predicted road users as a path sees them, and how near every plan along that path comes to them: for the soft terms of the cost.

Distances here are taken along and across the path, at a few instants: right on a straight, and near enough on a bend to prefer one plan to
another. What the law and collision ask is measured in the plane (`contacts`).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from regdb_runtime.observation import Footprint
from regdb_runtime.planning.cost_settings import CostSettings
from regdb_runtime.planning.prediction import Path, Predictions
from regdb_runtime.planning.safe_distance import SafeDistances, shortfall
from regdb_runtime.trajectory import Candidates

Floats = NDArray[np.float64]


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
    instants = np.unique(np.linspace(0, len(predictions.time) - 1, settings.instants).round().astype(np.int64))
    away = np.hypot(predictions.x[:, instants] - ego[0], predictions.y[:, instants] - ego[1]).min(axis=1, initial=np.inf)
    rows = np.argsort(away, kind="stable")[: settings.nearby_most]
    rows = rows[away[rows] <= settings.nearby]
    x, y, heading, speed = (part[rows][:, instants] for part in (predictions.x, predictions.y, predictions.heading, predictions.speed))
    s, d = (part.reshape(x.shape) for part in path.project(np.stack((x.ravel(), y.ravel()), axis=1), extend=True))
    turn = heading - path.heading(np.clip(s, path.start, path.end))
    cos, sin = np.cos(turn), np.sin(turn)
    long, wide = predictions.length[rows, None] / 2, predictions.width[rows, None] / 2
    reach = predictions.reach[rows][:, instants]
    along, across = long * np.abs(cos) + wide * np.abs(sin) + reach, long * np.abs(sin) + wide * np.abs(cos) + reach
    return UsersAlongPath(
        instants, s, d, speed * cos, speed * sin, along, across, footprint.center, footprint.length / 2, footprint.width / 2
    )


def nearness(candidates: Candidates, settings: CostSettings, users: UsersAlongPath) -> Mapping[str, Floats]:
    """Worst over users and instants, (N,) from 0 to 1: how much of the wanted clearance is missing, and of the safe longitudinal and lateral
    distance. Of the safe distances (arXiv:1708.06374) each counts only while the other is missing too: beside one another or far behind
    one another nobody is in danger. Whoever drives behind in our own way keeps his distance himself."""
    if not len(users):
        zero = np.zeros(len(candidates))
        return {"clearance": zero, "rss_longitudinal": zero, "rss_lateral": zero}
    at = users.indices
    station, offset, speed = (part[:, None, at] for part in (candidates.station, candidates.offset, candidates.speed))
    ahead, aside = users.s - users.center - station, users.d - offset
    gap_along = np.abs(ahead) - (users.half_along + users.half_length)
    gap_across = np.abs(aside) - (users.half_across + users.half_width)
    short_along = _short_along(gap_along, ahead, speed, users, settings.safe)
    short_along *= ~_behind_us_now(users, float(candidates.station[0, 0]), float(candidates.offset[0, 0]))[:, None]
    short_across = _short_across(gap_across, aside, candidates, users, settings.safe)
    near = np.hypot(np.maximum(gap_along, 0.0), np.maximum(gap_across, 0.0))
    return {
        "clearance": 1.0 - np.minimum(near.min(axis=(1, 2)) / settings.wanted_clearance, 1.0),
        "rss_longitudinal": np.asarray((short_along * (short_across > 0.0)).max(axis=(1, 2))),
        "rss_lateral": np.asarray((short_across * (short_along > 0.0)).max(axis=(1, 2))),
    }


def _short_along(gap: Floats, ahead: Floats, speed: Floats, users: UsersAlongPath, safe: SafeDistances) -> Floats:
    """Definition 1 for whoever goes the same way (the rear one needs the gap), both stopping ways for one ahead who comes towards us."""
    towards = users.s_dot < 0.0
    theirs = np.where(towards, safe.rear(np.abs(users.s_dot)), -safe.front(users.s_dot))
    behind = np.where(towards, -np.inf, safe.rear(users.s_dot))
    needed = np.where(ahead > 0.0, safe.rear(speed) + theirs, behind - safe.front(speed))
    return shortfall(gap, np.maximum(needed, 0.0))


def _short_across(gap: Floats, aside: Floats, candidates: Candidates, users: UsersAlongPath, safe: SafeDistances) -> Floats:
    """Definition 6, with the plan's lateral speed between neighbouring instants."""
    at = users.indices
    after, before = np.minimum(at + 1, len(candidates.time) - 1), np.maximum(at - 1, 0)
    rate = (candidates.offset[:, after] - candidates.offset[:, before]) / (candidates.time[after] - candidates.time[before])
    leftwards, rightwards = safe.side(rate)[:, None, :], safe.side(-rate)[:, None, :]
    on_left = aside > 0.0
    needed = np.where(on_left, leftwards + safe.side(-users.d_dot), rightwards + safe.side(users.d_dot))
    return shortfall(gap, safe.fluctuation_margin + np.maximum(needed, 0.0))


def _behind_us_now(users: UsersAlongPath, station: float, offset: float) -> NDArray[np.bool_]:
    """Who is behind the vehicle in its own way at the first instant, (M,)."""
    behind = users.s[:, 0] < station + users.center
    return np.asarray(behind & (np.abs(users.d[:, 0] - offset) < users.half_across[:, 0] + users.half_width))
