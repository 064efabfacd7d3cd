"""Oriented rectangles in numpy: whether they overlap, and how far apart they are edge to edge; metres and radians."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Boxes:
    """Rectangles: middle, direction as cosine and sine, half length and half width. The arrays broadcast with one another."""

    x: Floats
    y: Floats
    cos: Floats
    sin: Floats
    half_length: Floats
    half_width: Floats

    def __getitem__(self, index: Any) -> Boxes:
        """The same part of every array; arrays are first spread to the common shape."""
        spread = np.broadcast_arrays(self.x, self.y, self.cos, self.sin, self.half_length, self.half_width)
        return Boxes(*(part[index] for part in spread))

    def grown(self, margin: ArrayLike) -> Boxes:
        """Each rectangle with `margin` metres more on every side."""
        more = np.asarray(margin, dtype=np.float64)
        return Boxes(self.x, self.y, self.cos, self.sin, self.half_length + more, self.half_width + more)

    @property
    def radius(self) -> Floats:
        """Half the diagonal."""
        return np.asarray(np.hypot(self.half_length, self.half_width))


def boxes(x: ArrayLike, y: ArrayLike, heading: ArrayLike, length: ArrayLike, width: ArrayLike) -> Boxes:
    """Rectangles by their middle (x, y), heading and full sizes; any shapes that broadcast."""
    turn = np.asarray(heading, dtype=np.float64)
    return Boxes(
        np.asarray(x, dtype=np.float64), np.asarray(y, dtype=np.float64), np.asarray(np.cos(turn)), np.asarray(np.sin(turn)),
        np.asarray(length, dtype=np.float64) / 2, np.asarray(width, dtype=np.float64) / 2,
    )  # fmt: skip


def overlap(a: Boxes, b: Boxes) -> Bools:
    """Whether rectangles touch or overlap, broadcast over both (separating axes: the two directions of each)."""
    dx, dy = b.x - a.x, b.y - a.y
    cos, sin = np.abs(a.cos * b.cos + a.sin * b.sin), np.abs(a.cos * b.sin - a.sin * b.cos)
    apart = np.abs(dx * a.cos + dy * a.sin) > a.half_length + b.half_length * cos + b.half_width * sin
    apart |= np.abs(dy * a.cos - dx * a.sin) > a.half_width + b.half_length * sin + b.half_width * cos
    apart |= np.abs(dx * b.cos + dy * b.sin) > b.half_length + a.half_length * cos + a.half_width * sin
    apart |= np.abs(dy * b.cos - dx * b.sin) > b.half_width + a.half_length * sin + a.half_width * cos
    return np.asarray(~apart)


def distance(a: Boxes, b: Boxes) -> Floats:
    """Least distance between any part of one rectangle and any part of the other, broadcast over both; 0 where they overlap.

    Of two convex shapes that are apart, one has a corner at the nearest pair of points: eight corners are enough.
    """
    nearest = np.minimum(_corners_to(a, b), _corners_to(b, a))
    return np.asarray(np.where(overlap(a, b), 0.0, np.sqrt(nearest)))


def _corners_to(corners: Boxes, box: Boxes) -> Floats:
    """Least squared distance from the four corners of one rectangle to the other one, taken as filled."""
    dx, dy = corners.x - box.x, corners.y - box.y
    along, across = dx * box.cos + dy * box.sin, dy * box.cos - dx * box.sin
    cos, sin = corners.cos * box.cos + corners.sin * box.sin, corners.sin * box.cos - corners.cos * box.sin
    ahead = corners.half_length * cos, corners.half_length * sin
    aside = -corners.half_width * sin, corners.half_width * cos
    found: Floats | None = None
    for forward, left in ((1, 1), (1, -1), (-1, 1), (-1, -1)):
        out_along = np.maximum(np.abs(along + forward * ahead[0] + left * aside[0]) - box.half_length, 0.0)
        out_across = np.maximum(np.abs(across + forward * ahead[1] + left * aside[1]) - box.half_width, 0.0)
        squared = out_along * out_along + out_across * out_across
        found = squared if found is None else np.minimum(found, squared)
    assert found is not None
    return found

