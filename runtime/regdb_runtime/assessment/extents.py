"""Where the vehicle's rectangle lies across and along a path, for many plans at once."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from regdb_runtime.geometry import Boxes
from regdb_runtime.maps.reference_path import ReferencePath
from regdb_runtime.observation import Footprint
from regdb_runtime.trajectory import Candidates, Floats

SMALL = 0.6
"""Radians to the path within which sine and cosine are taken from their series; the last terms left out are below 7e-5 there."""


@dataclass(frozen=True, eq=False)
class Extents:
    """Stations of the front and rear bumper, offsets of the leftmost and rightmost part, rear axle and heading in the plane, all (k, T)."""

    front: Floats
    rear: Floats
    left: Floats
    right: Floats
    x: Floats
    y: Floats
    heading: Floats
    footprint: Footprint

    def boxes(self, rows: NDArray[np.intp], instants: NDArray[np.intp]) -> Boxes:
        """The rectangles of some plans at some instants, pair by pair."""
        heading = self.heading[rows, instants]
        cos, sin = np.cos(heading), np.sin(heading)
        return Boxes(
            self.x[rows, instants] + self.footprint.center * cos, self.y[rows, instants] + self.footprint.center * sin, cos, sin,
            np.asarray(self.footprint.length / 2), np.asarray(self.footprint.width / 2),
        )  # fmt: skip


def extents(candidates: Candidates, rows: NDArray[np.intp], path: ReferencePath, footprint: Footprint) -> Extents:
    """The extents of some plans.

    Corners are placed by the angle to the path and its curvature at the rear axle, to second order: over a car's front overhang of 3.9 m in a
    turn of 10 m radius that leaves less than 0.1 m, on roads of more than 50 m radius less than 4 mm.
    """
    station, offset, heading = (part.take(rows, axis=0) for part in (candidates.station, candidates.offset, candidates.heading))
    table = path.tabulated
    place = np.minimum(np.maximum(station, path.start), path.end) - table.first
    index = np.rint(place / table.step).astype(np.intp)
    curvature = table.curvature.take(index)
    turned = heading - table.heading.take(index) - (place - index * table.step) * curvature
    curvature *= 0.5 * footprint.front**2
    sine, cosine = _sine_cosine(turned)
    cosine *= footprint.width / 2
    behind = sine * -footprint.rear_overhang
    sine *= footprint.front
    sine -= curvature
    return Extents(
        station + footprint.front, station - footprint.rear_overhang,
        offset + np.maximum(sine, behind) + cosine, offset + np.minimum(sine, behind) - cosine,
        candidates.x.take(rows, axis=0), candidates.y.take(rows, axis=0), heading, footprint,
    )  # fmt: skip


def _sine_cosine(angle: Floats) -> tuple[Floats, Floats]:
    """Sine and (positive) cosine; each element by itself, whatever stands beside it."""
    square = angle * angle
    sine, cosine = angle * (1.0 - square / 6.0 * (1.0 - square / 20.0)), 1.0 - square / 2.0 * (1.0 - square / 12.0)
    large = square > SMALL * SMALL
    if large.any():
        sine[large], cosine[large] = np.sin(angle[large]), np.abs(np.cos(angle[large]))
    return sine, cosine
