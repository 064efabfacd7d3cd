"""A pinhole camera on the vehicle: world points (x, y, z) to pixels, polygons clipped before the image plane."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from regdb_runtime.observation import EgoState
from regdb_runtime.planning.trajectory import Floats

NEAREST = 0.3
"""Metres before the camera at which polygons are cut off."""


@dataclass(frozen=True, slots=True)
class CameraSettings:
    """`width`, `height` pixels; `field_of_view` horizontal, degrees; `forward` of the rear axle and `above` the road, metres; `pitch` degrees,
    down positive. Defaults: a wide front camera behind the windscreen, 1080p as in the paper."""

    width: int = 1920
    height: int = 1080
    field_of_view: float = 70.0
    forward: float = 1.7
    above: float = 1.4
    pitch: float = 1.5


@dataclass(frozen=True)
class Camera:
    """The camera of one frame."""

    settings: CameraSettings
    ego: EgoState

    @cached_property
    def place(self) -> Floats:
        """Where it is, (3,)."""
        ego, forward = self.ego, self.settings.forward
        return np.array([ego.x + forward * math.cos(ego.heading), ego.y + forward * math.sin(ego.heading), self.settings.above])

    @cached_property
    def axes(self) -> Floats:
        """Rows: right, down, ahead, as unit vectors of the world, (3, 3)."""
        heading, pitch = self.ego.heading, math.radians(self.settings.pitch)
        ahead = np.array([math.cos(heading) * math.cos(pitch), math.sin(heading) * math.cos(pitch), -math.sin(pitch)])
        right = np.array([math.sin(heading), -math.cos(heading), 0.0])
        return np.array([right, np.cross(ahead, right), ahead])

    @cached_property
    def focal(self) -> float:
        """Focal length in pixels."""
        return self.settings.width / 2 / math.tan(math.radians(self.settings.field_of_view) / 2)

    @property
    def horizon(self) -> float:
        """The row of the horizon, pixels from the top."""
        return self.settings.height / 2 - self.focal * math.tan(math.radians(self.settings.pitch))

    def seen(self, points: Floats) -> Floats:
        """World points (n, 3) in the camera's frame: right, down, depth, (n, 3)."""
        found: Floats = (points - self.place) @ self.axes.T
        return found

    def pixels(self, seen: Floats) -> Floats:
        """Camera-frame points with positive depth to pixels, (n, 2)."""
        scale = self.focal / seen[:, 2]
        return np.column_stack((self.settings.width / 2 + seen[:, 0] * scale, self.settings.height / 2 + seen[:, 1] * scale))

    def polygon(self, points: Floats) -> Floats | None:
        """A world polygon (n, 3) as pixels (k, 2), what lies behind the camera cut away; None when nothing is left."""
        clipped = _before(self.seen(points))
        return None if len(clipped) < 3 else self.pixels(clipped)

    def depth(self, point: Floats) -> float:
        """How far ahead a world point lies, metres."""
        return float((point - self.place) @ self.axes[2])


def _before(polygon: Floats) -> Floats:
    """The part of a camera-frame polygon beyond the nearest depth (Sutherland and Hodgman's clipping at one plane)."""
    depths = polygon[:, 2] - NEAREST
    if (depths >= 0).all():
        return polygon
    kept = []
    for here, after, d, e in zip(polygon, np.roll(polygon, -1, axis=0), depths, np.roll(depths, -1), strict=True):
        if d >= 0:
            kept.append(here)
        if d * e < 0:
            kept.append(here + (after - here) * (d / (d - e)))
    return np.array(kept).reshape(-1, 3)
