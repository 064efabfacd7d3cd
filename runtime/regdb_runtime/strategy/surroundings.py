"""Road users placed on a path: where they are along it and beside it, how fast they go its way, and who is ahead, behind or alongside."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from regdb_runtime.maps.reference_path import ReferencePath
from regdb_runtime.observation import Footprint, Track

RIDERS = frozenset(("bicycle", "pedestrian"))
"""Kinds of road users that get more room."""


@dataclass(frozen=True, slots=True)
class Placed:
    """A road user on a path: stations of its rear and front end, offsets of its right and left side, speed along and across the path (SI)."""

    track: Track
    rear: float
    front: float
    right: float
    left: float
    along: float
    across: float

    @property
    def crosses(self) -> bool:
        """Whether it goes across the path rather than along it: nobody to be followed."""
        return abs(self.across) > max(1.0, abs(self.along))

    @property
    def offset(self) -> float:
        """Offset of its middle."""
        return (self.left + self.right) / 2


def place(path: ReferencePath, tracks: Iterable[Track], reach: float = 12.0) -> tuple[Placed, ...]:
    """Those within `reach` metres beside the path and between its ends, in the order of their rear ends (then ids)."""
    listed = tuple(tracks)
    if not listed:
        return ()
    stations, offsets = path.project(np.array([(item.x, item.y) for item in listed]), extend=True)
    found = []
    for track, station, offset in zip(listed, stations.tolist(), offsets.tolist(), strict=True):
        if abs(offset) <= reach and path.start < station < path.end:
            found.append(_placed(path, track, station, offset))
    return tuple(sorted(found, key=lambda item: (item.rear, item.track.id)))


def _placed(path: ReferencePath, track: Track, station: float, offset: float) -> Placed:
    turned = track.heading - float(np.asarray(path.heading(station)))
    cosine, sine = math.cos(turned), math.sin(turned)
    along = (abs(cosine) * track.length + abs(sine) * track.width) / 2
    across = (abs(sine) * track.length + abs(cosine) * track.width) / 2
    return Placed(
        track, station - along, station + along, offset - across, offset + across, track.speed * cosine, track.speed * sine
    )  # fmt: skip


def lead(
    placed: Sequence[Placed], front: float, footprint: Footprint, offset: float, margins: tuple[float, float], passed: str | None = None
) -> Placed | None:
    """The nearest one ahead of the front bumper that stands or goes in the strip the vehicle would drive through at an offset.

    `margins`: metres beside the vehicle for all, and for riders and walkers that go its way.
    """
    half = footprint.width / 2
    for item in placed:
        beside = half + (margins[1] if item.track.kind in RIDERS and item.along > 0.5 else margins[0])
        if item.crosses:
            continue
        if item.rear > front - 1.0 and item.right < offset + beside and item.left > offset - beside and item.track.id != passed:
            return item
    return None


def in_strip(placed: Sequence[Placed], right: float, left: float, start: float, end: float) -> tuple[Placed, ...]:
    """Those that overlap a strip of the road between two offsets and two stations."""
    return tuple(item for item in placed if item.right < left and item.left > right and item.front > start and item.rear < end)
