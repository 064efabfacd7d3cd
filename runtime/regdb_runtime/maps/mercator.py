"""Latitude and longitude to metres around a place: transverse Mercator on the WGS 84 ellipsoid, by Krüger's series to the third order."""

from __future__ import annotations

import math

SEMI_MAJOR = 6378137.0
FLATTENING = 1 / 298.257223563
THIRD = FLATTENING / (2 - FLATTENING)
RADIUS = SEMI_MAJOR / (1 + THIRD) * (1 + THIRD**2 / 4 + THIRD**4 / 64)
"""Radius of the circle as long as the meridian, metres."""
SERIES = (
    THIRD / 2 - 2 * THIRD**2 / 3 + 5 * THIRD**3 / 16,
    13 * THIRD**2 / 48 - 3 * THIRD**3 / 5,
    61 * THIRD**3 / 240,
)
"""L. Krüger, Konforme Abbildung des Erdellipsoids in der Ebene, 1912: errors below a millimetre within 1,000 km of the meridian."""


class LocalMercator:
    """Metres east and north of an origin (latitude, longitude in degrees), at scale 1 on the origin's meridian."""

    def __init__(self, latitude: float, longitude: float) -> None:
        self.latitude, self.longitude = latitude, longitude
        self._north = self._grid(latitude, longitude)[1]

    def to_plane(self, latitude: float, longitude: float) -> tuple[float, float]:
        """(x, y) in metres, east and north of the origin."""
        east, north = self._grid(latitude, longitude)
        return east, north - self._north

    def _grid(self, latitude: float, longitude: float) -> tuple[float, float]:
        phi, away = math.radians(latitude), math.radians(longitude - self.longitude)
        squash = 2 * math.sqrt(THIRD) / (1 + THIRD)
        t = math.sinh(math.atanh(math.sin(phi)) - squash * math.atanh(squash * math.sin(phi)))
        xi, eta = math.atan2(t, math.cos(away)), math.atanh(math.sin(away) / math.sqrt(1 + t * t))
        east = eta + sum(a * math.cos(2 * j * xi) * math.sinh(2 * j * eta) for j, a in enumerate(SERIES, 1))
        north = xi + sum(a * math.sin(2 * j * xi) * math.cosh(2 * j * eta) for j, a in enumerate(SERIES, 1))
        return RADIUS * east, RADIUS * north
