"""Contacts of the ego with others, and who struck whom."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from regdb_runtime.geometry import boxes, overlap
from regdb_runtime.observation import EgoState, Footprint, Track

Part = Literal["front", "side", "rear"]
STANDING = 0.1
"""Speed below which a road user counts as standing, m/s."""


@dataclass(frozen=True, slots=True)
class Contact:
    """The first touch of the ego and another. `part` of the ego and `other_part` that touched; speeds in m/s.

    `by`: who struck: `ego` (its front touched, or it moved against one that stood), `other` (the same the other way round), `both`.
    """

    time: float
    other: str
    kind: str
    part: Part
    other_part: Part
    ego_speed: float
    other_speed: float
    by: Literal["ego", "other", "both"]


def find_contacts(time: float, ego: EgoState, footprint: Footprint, tracks: Sequence[Track]) -> list[Contact]:
    """Every road user whose rectangle touches the ego's now."""
    ego_x, ego_y = ego.box_center(footprint)
    reach = math.hypot(footprint.length, footprint.width) / 2
    near = [track for track in tracks if math.hypot(track.x - ego_x, track.y - ego_y) < reach + math.hypot(track.length, track.width) / 2]
    if not near:
        return []
    own = boxes(ego_x, ego_y, ego.heading, footprint.length, footprint.width)
    others = boxes(*(np.array([getattr(track, name) for track in near]) for name in ("x", "y", "heading", "length", "width")))
    touching = np.atleast_1d(overlap(own, others))
    return [_contact(time, ego, (ego_x, ego_y), footprint, track) for track, touches in zip(near, touching.tolist(), strict=True) if touches]


def _contact(time: float, ego: EgoState, center: tuple[float, float], footprint: Footprint, track: Track) -> Contact:
    own = (center[0], center[1], ego.heading, footprint.length, footprint.width)
    theirs = (track.x, track.y, track.heading, track.length, track.width)
    part, other_part = _part(own, theirs), _part(theirs, own)
    by: Literal["ego", "other", "both"]
    if ego.speed < STANDING:
        by = "other"
    elif track.speed < STANDING or (part == "front" and other_part != "front"):
        by = "ego"
    elif other_part == "front" and part != "front":
        by = "other"
    else:
        by = "both"
    return Contact(time, track.id, track.kind, part, other_part, ego.speed, track.speed, by)


def _part(box: tuple[float, float, float, float, float], other: tuple[float, float, float, float, float]) -> Part:
    """The side of a rectangle that another one presses least deep into: where the touch began."""
    x, y, heading, length, width = box
    cos, sin = math.cos(heading), math.sin(heading)
    dx, dy = other[0] - x, other[1] - y
    along, across = cos * dx + sin * dy, cos * dy - sin * dx
    turn = other[2] - heading
    half_along = (other[3] * abs(math.cos(turn)) + other[4] * abs(math.sin(turn))) / 2
    half_across = (other[3] * abs(math.sin(turn)) + other[4] * abs(math.cos(turn))) / 2
    depth = length / 2 + half_along - abs(along)
    if depth <= width / 2 + half_across - abs(across):
        return "front" if along > 0 else "rear"
    return "side"
