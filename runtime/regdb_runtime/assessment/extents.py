"""Where the vehicle's rectangle lies across and along a path, for many plans at once."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from regdb_runtime.geometry import Boxes
from regdb_runtime.maps.reference_path import ReferencePath
from regdb_runtime.observation import Footprint
from regdb_runtime.trajectory import Candidates, Floats


@dataclass(frozen=True, eq=False)
class Extents:
    """Stations of the front and rear bumper, offsets of the leftmost and rightmost part, all (k, T); `boxes` the rectangles in the plane."""

    front: Floats
    rear: Floats
    left: Floats
    right: Floats
    boxes: Boxes


def extents(candidates: Candidates, rows: NDArray[np.intp], path: ReferencePath, footprint: Footprint) -> Extents:
    """The extents of some plans.

    Corners are placed by the angle to the path and its curvature at the rear axle, to second order: over a car's front overhang of 3.9 m in a
    turn of 10 m radius that leaves less than 0.1 m, on roads of more than 50 m radius less than 4 mm.
    """
    station, offset, heading = candidates.station[rows], candidates.offset[rows], candidates.heading[rows]
    table = path.tabulated
    place = np.minimum(np.maximum(station, path.start), path.end) - table.first
    index = np.rint(place / table.step).astype(np.intp)
    curvature = table.curvature.take(index)
    turned = heading - table.heading.take(index) - (place - index * table.step) * curvature
    bend = curvature * (0.5 * footprint.front**2)
    sine, cosine = np.sin(turned), np.cos(turned)
    ahead, behind = footprint.front * sine - bend, -footprint.rear_overhang * sine
    half = footprint.width / 2 * np.abs(cosine)
    across, along = np.cos(heading), np.sin(heading)
    middle = Boxes(
        candidates.x[rows] + footprint.center * across, candidates.y[rows] + footprint.center * along, across, along,
        np.asarray(footprint.length / 2), np.asarray(footprint.width / 2),
    )  # fmt: skip
    return Extents(
        station + footprint.front, station - footprint.rear_overhang,
        offset + np.maximum(ahead, behind) + half, offset + np.minimum(ahead, behind) - half, middle,
    )  # fmt: skip
