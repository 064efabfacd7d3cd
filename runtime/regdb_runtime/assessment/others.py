"""The road users about a path while it is driven: where they will be along and beside it, and how near plans come to them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from regdb_runtime.assessment.extents import Extents
from regdb_runtime.assessment.measured import Bools
from regdb_runtime.geometry import Boxes, boxes, distance
from regdb_runtime.maps.reference_path import ReferencePath
from regdb_runtime.planning.prediction import Predictions
from regdb_runtime.trajectory import Floats

NEAR = 5.0
"""Metres along the path beyond which the distance is taken to be that length; no law asks for such a distance to the side."""
SAME_WAY = 0.5
"""Least cosine of the angle to the path at which somebody goes the path's way: within 60 degrees."""


@dataclass(frozen=True, eq=False)
class Other:
    """One road user predicted over the T instants of the plans: stations of its ends, offsets of its sides, speed along the path, (T,)."""

    id: str
    kind: str
    rear: Floats
    front: Floats
    left: Floats
    right: Floats
    along: Floats
    speed: Floats
    boxes: Boxes

    @property
    def middle(self) -> Floats:
        """Offset of its middle, (T,)."""
        return np.asarray((self.left + self.right) / 2)


def others(path: ReferencePath, predictions: Predictions, wanted: Sequence[int]) -> tuple[Other, ...]:
    """Some of the predicted road users (by their rows) placed on the path, which goes on straight beyond its ends."""
    if not len(wanted):
        return ()
    rows = list(wanted)
    x, y, heading = predictions.x[rows], predictions.y[rows], predictions.heading[rows]
    station, offset = path.project(np.column_stack([x.ravel(), y.ravel()]), extend=True)
    station, offset = station.reshape(x.shape), offset.reshape(x.shape)
    turned = heading - path.heading(np.minimum(np.maximum(station, path.start), path.end))
    cosine, sine = np.cos(turned), np.sin(turned)
    length, width = predictions.length[rows, None], predictions.width[rows, None]
    along, across = (np.abs(cosine) * length + np.abs(sine) * width) / 2, (np.abs(sine) * length + np.abs(cosine) * width) / 2
    found = []
    for row, place in enumerate(rows):
        found.append(Other(
            str(predictions.ids[place]), predictions.kinds[place], station[row] - along[row], station[row] + along[row],
            offset[row] + across[row], offset[row] - across[row], predictions.speed[place] * cosine[row], predictions.speed[place],
            boxes(x[row], y[row], heading[row], length[row], width[row]),
        ))  # fmt: skip
    return tuple(found)


def beside(plans: Extents, other: Other) -> Bools:
    """Whether the plan is alongside, at each instant: some part of it level with some part of the other, (k, T)."""
    return np.asarray((plans.front > other.rear) & (plans.rear < other.front))


def overtakes(plans: Extents, other: Other, reach: float) -> Bools:
    """Whether each plan goes past somebody who goes the same way or stands, no farther than `reach` beside it, (k,).

    It comes alongside (or is so now) without having him wholly behind, and gains on him.
    """
    if other.along[0] < SAME_WAY * other.speed[0] or not plans.front.shape[1]:
        return np.zeros(plans.front.shape[0], dtype=np.bool_)
    level = beside(plans, other)
    near = np.maximum(plans.right - other.left, other.right - plans.left) < reach
    gains = (plans.front[:, -1] - other.rear[-1]) > (plans.front[:, 0] - other.rear[0])
    return np.asarray((level & near).any(axis=1) & gains & (plans.rear[:, 0] < other.front[0]))


@dataclass(frozen=True, eq=False)
class Pass:
    """Plans that go past one road user. `intended`: the manoeuvre means to pass him.

    A pass that is not over when the plan ends goes on beside him at the plan's last offset, so its last instant counts as alongside; an intended
    one does so even where the plan has not come up to him by then: what it means to do is judged, not only what its horizon shows.
    """

    plans: Extents
    other: Other
    intended: bool

    @cached_property
    def seen(self) -> Bools:
        """Where the plan's own horizon shows it alongside, (k, T)."""
        return beside(self.plans, self.other)

    @cached_property
    def level(self) -> Bools:
        """Alongside, (k, T)."""
        if not self.intended:
            return self.seen
        level = self.seen.copy()
        level[:, -1] |= self.plans.rear[:, -1] < self.other.front[-1]
        return level

    @cached_property
    def side_gap(self) -> Floats:
        """Gap to the side while alongside, infinite else, (k, T)."""
        gap = np.maximum(np.maximum(self.plans.right - self.other.left, self.other.right - self.plans.left), 0.0)
        return np.asarray(np.where(self.level, gap, np.inf))

    @cached_property
    def clearance(self) -> Floats:
        """Least distance, edge to edge, over the whole pass, (k,). Where the two are more than `NEAR` apart along the path, that counts."""
        along = np.maximum(self.other.rear - self.plans.front, self.plans.rear - self.other.front)
        found = np.where(along > NEAR, along, np.inf)
        rows, instants = np.nonzero(along <= NEAR)
        if len(rows):
            found[rows, instants] = distance(self.plans.boxes(rows, instants), self.other.boxes[instants])
        return np.asarray(np.minimum(found.min(axis=1), self.side_gap[:, -1]))


def gap_behind(plans: Extents, other: Other) -> Floats:
    """Bumper to bumper, from the front of the vehicle to the rear end of who drives ahead, (k, T); infinite while no part of it is behind him."""
    behind = (plans.left > other.right) & (plans.right < other.left)
    return np.asarray(np.where(behind, other.rear - plans.front, np.inf))


def passing_distance(plans: Extents, other: Other, speed: Floats) -> Floats:
    """Distance driven from now until the other is wholly behind, (k,); beyond the plan's end at the last speeds, infinite if that is never."""
    behind = plans.rear > other.front
    first = np.argmax(behind, axis=1)
    driven = plans.front[np.arange(len(first)), first] - plans.front[:, 0]
    gaining = speed[:, -1] - other.along[-1]
    with np.errstate(divide="ignore", invalid="ignore"):
        left = np.where(gaining > 0.0, (other.front[-1] - plans.rear[:, -1]) / gaining * speed[:, -1], np.inf)
    return np.asarray(np.where(behind.any(axis=1), driven, plans.front[:, -1] - plans.front[:, 0] + left))
