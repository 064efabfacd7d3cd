"""Road users along a path: where each lies along and beside it, and how fast it goes its way."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from regdb_runtime.maps.reference_path import ReferencePath
from regdb_runtime.observation import EgoState, Footprint, Track, TrackKind

MOTOR: frozenset[TrackKind] = frozenset(("car", "truck", "bus", "motorcycle"))
"""Motor vehicles (CVC 415)."""


@dataclass(frozen=True, slots=True)
class Beside:
    """A road user on the path: stations of its rear and front end, offsets of its right and left side, speed along and across (left positive)."""

    track: Track
    rear: float
    front: float
    right: float
    left: float
    along: float
    across: float

    @property
    def offset(self) -> float:
        """Of its middle."""
        return (self.left + self.right) / 2

    @property
    def is_motor(self) -> bool:
        """Whether it is a motor vehicle."""
        return self.track.kind in MOTOR

    def overlaps(self, right: float, left: float) -> bool:
        """Whether it reaches into a strip between two offsets."""
        return self.right < left and self.left > right


@dataclass(frozen=True, eq=False)
class Around:
    """The vehicle and everybody else on one path at one instant. Stations of the front and rear bumper; `offset` of the rear axle."""

    front: float
    rear: float
    offset: float
    others: tuple[Beside, ...]

    def among(self, right: float, left: float) -> list[Beside]:
        """Those that reach into a strip, in the order of their rear ends."""
        return [item for item in self.others if item.overlaps(right, left)]


def around(path: ReferencePath, ego: EgoState, footprint: Footprint, tracks: Sequence[Track], reach: float) -> Around:
    """Place the vehicle and the road users within `reach` metres of it on a path."""
    near = [item for item in tracks if abs(item.x - ego.x) <= reach and abs(item.y - ego.y) <= reach]
    points = np.array([(ego.x, ego.y), *((item.x, item.y) for item in near)])
    stations, offsets = path.project(points, extend=True)
    at = float(stations[0])
    inside = np.clip(stations, path.start, path.end)
    headings = path.heading(inside[1:]).tolist() if near else []
    placed = [_placed(*item) for item in zip(near, stations[1:].tolist(), offsets[1:].tolist(), headings, strict=True)]
    placed.sort(key=lambda item: (item.rear, item.track.id))
    return Around(at + footprint.front, at - footprint.rear_overhang, float(offsets[0]), tuple(placed))


def _placed(track: Track, station: float, offset: float, heading: float) -> Beside:
    turned = track.heading - heading
    cosine, sine = math.cos(turned), math.sin(turned)
    along = (abs(cosine) * track.length + abs(sine) * track.width) / 2
    across = (abs(sine) * track.length + abs(cosine) * track.width) / 2
    return Beside(track, station - along, station + along, offset - across, offset + across, track.speed * cosine, track.speed * sine)
