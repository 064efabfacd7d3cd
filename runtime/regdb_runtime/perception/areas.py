"""Areas on the ground, read from GeoJSON: whether a position lies in one, and how far it is from the border."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from regdb_runtime.errors import MapError

EARTH = 6371008.8
"""Mean radius of the Earth, metres (IUGG)."""
Point = tuple[float, float]
"""Longitude and latitude, degrees (WGS 84, as GeoJSON has them)."""


@dataclass(frozen=True)
class Area:
    """Polygons with what is said of them. A polygon is its outer ring, then its holes; rings need not repeat their first point."""

    properties: Mapping[str, Any]
    polygons: tuple[tuple[tuple[Point, ...], ...], ...]
    box: tuple[float, float, float, float] = field(init=False)

    def __post_init__(self) -> None:
        points = [point for polygon in self.polygons for point in polygon[0]]
        west, south = min(point[0] for point in points), min(point[1] for point in points)
        east, north = max(point[0] for point in points), max(point[1] for point in points)
        object.__setattr__(self, "box", (west, south, east, north))

    def contains(self, point: Point) -> bool:
        """Whether the point lies inside a polygon and outside its holes (even-odd rule)."""
        west, south, east, north = self.box
        if not (west <= point[0] <= east and south <= point[1] <= north):
            return False
        return any(sum(_crosses(ring, point) for ring in polygon) % 2 for polygon in self.polygons)

    def border_distance(self, point: Point) -> float:
        """Metres to the nearest border, holes' borders too; good to a part in a thousand within some tens of kilometres."""
        scale = math.radians(1) * EARTH
        east = scale * math.cos(math.radians(point[1]))
        return min(
            _to_segment((ax - point[0]) * east, (ay - point[1]) * scale, (bx - point[0]) * east, (by - point[1]) * scale)
            for polygon in self.polygons
            for ring in polygon
            for (ax, ay), (bx, by) in _edges(ring)
        )

    def may_contain(self, point: Point, accuracy: float) -> bool:
        """Whether a position known to so many metres may be inside."""
        return self.contains(point) or (self._near(point, accuracy) and self.border_distance(point) <= accuracy)

    def surely_contains(self, point: Point, accuracy: float) -> bool:
        """Whether a position known to so many metres is inside wherever it truly is."""
        return self.contains(point) and self.border_distance(point) > accuracy

    def _near(self, point: Point, metres: float) -> bool:
        west, south, east, north = self.box
        up = metres / (math.radians(1) * EARTH)
        across = up / max(math.cos(math.radians(point[1])), 1e-6)
        return west - across <= point[0] <= east + across and south - up <= point[1] <= north + up


def _crosses(ring: Sequence[Point], point: Point) -> int:
    """How often a ray to the east meets the ring."""
    x, y = point
    return sum((ay > y) != (by > y) and x < ax + (y - ay) / (by - ay) * (bx - ax) for (ax, ay), (bx, by) in _edges(ring))


def _edges(ring: Sequence[Point]) -> Iterator[tuple[Point, Point]]:
    return zip(ring, (*ring[1:], ring[0]), strict=True)


def _to_segment(ax: float, ay: float, bx: float, by: float) -> float:
    """Distance of the origin from a segment."""
    dx, dy = bx - ax, by - ay
    length = dx * dx + dy * dy
    share = min(max(-(ax * dx + ay * dy) / length, 0.0), 1.0) if length else 0.0
    return math.hypot(ax + share * dx, ay + share * dy)


def read_areas(path: Path) -> tuple[Area, ...]:
    """The polygons of a GeoJSON file (RFC 7946), in its order. Raises MapError that names the file and the feature."""
    try:
        data = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise MapError(f"{path} is no GeoJSON file: {error}") from None
    features = data.get("features") if isinstance(data, dict) and data.get("type") == "FeatureCollection" else None
    if not isinstance(features, list):
        raise MapError(f"{path} is no GeoJSON FeatureCollection")
    return tuple(_area(feature, f"{path}: features[{index}]") for index, feature in enumerate(features))


def _area(feature: object, place: str) -> Area:
    try:
        if not isinstance(feature, dict):
            raise TypeError("it is no object")
        geometry = feature["geometry"]
        kind, coordinates = geometry["type"], geometry["coordinates"]
        if kind not in ("Polygon", "MultiPolygon"):
            raise TypeError(f"a {kind} encloses nothing; Polygon or MultiPolygon does")
        polygons = [coordinates] if kind == "Polygon" else coordinates
        read = tuple(tuple(_ring(ring) for ring in polygon) for polygon in polygons)
        if not read or not all(read):
            raise ValueError("it has no ring")
        return Area(dict(feature.get("properties") or {}), read)
    except (KeyError, TypeError, ValueError, IndexError) as error:
        raise MapError(f"{place}: {error}") from None


def _ring(points: Sequence[Sequence[float]]) -> tuple[Point, ...]:
    ring = [(float(point[0]), float(point[1])) for point in points]
    if any(not (-180 <= x <= 180 and -90 <= y <= 90) for x, y in ring):
        raise ValueError("a position is longitude, then latitude, in degrees")
    if len(ring) > 1 and ring[0] == ring[-1]:
        ring.pop()
    if len(ring) < 3:
        raise ValueError("a ring has at least three corners")
    return tuple(ring)
