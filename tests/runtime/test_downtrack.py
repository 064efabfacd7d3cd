"""Downtrack distance: stations along a route's centre line, and what lies on it, against geometry one can do in one's head."""

from __future__ import annotations

import math

import numpy as np
import pytest
from regdb_runtime.drive.downtrack import Downtrack, Span
from regdb_runtime.maps.road_map import Lane, RoadMap, StopLine, Zone


def lane(name: str, points: list[tuple[float, float]], **changes: object) -> Lane:
    center = np.array(points, dtype=float)
    steps = np.diff(center, axis=0)
    across = np.vstack([np.column_stack([-steps[:, 1], steps[:, 0]]), [[-steps[-1, 1], steps[-1, 0]]]])
    across /= np.hypot(*across.T)[:, None]
    return Lane(name, center + 1.75 * across, center - 1.75 * across, center, **changes)  # type: ignore[arg-type]


QUARTER = [(100 + 10 * math.sin(a), -10 + 10 * math.cos(a)) for a in np.linspace(0, math.pi / 2, 200)]


@pytest.fixture
def corner() -> Downtrack:
    """East 100 m, a right turn of 10 m radius, south 50 m; a stop line at 95 m, a zone from 20 m to 60 m of the south leg."""
    line = StopLine("line", (95.0, -1.75), (95.0, 1.75))
    lanes = {
        "a": lane("a", [(0.0, 0.0), (50.0, 0.0), (100.0, 0.0)], stop_line=line),
        "b": lane("b", QUARTER),
        "c": lane("c", [(110.0, -10.0), (110.0, -60.0)]),
    }
    zones = (Zone("z", "school", np.array([(100.0, -30.0), (120.0, -30.0), (120.0, -45.0), (100.0, -45.0)])),)
    return Downtrack(RoadMap(lanes, zones=zones), ("a", "b", "c"))


ARC = 10 * math.pi / 2


def test_stations_run_on_through_the_turn(corner: Downtrack) -> None:
    assert corner.length == pytest.approx(150 + ARC, abs=0.01)
    assert corner.lane_spans()["c"].start == pytest.approx(100 + ARC, abs=0.01)
    assert corner.locate(30.0, 2.0) == pytest.approx((30.0, 2.0))
    assert corner.locate(30.0, -2.0) == pytest.approx((30.0, -2.0))
    middle = 100 + 12 * math.sin(math.pi / 4), -10 + 12 * math.cos(math.pi / 4)
    assert corner.locate(*middle) == pytest.approx((100 + ARC / 2, 2.0), abs=0.01)
    assert corner.locate(111.5, -30.0) == pytest.approx((100 + ARC + 20, 1.5), abs=0.01)


def test_stations_before_and_beyond_the_route(corner: Downtrack) -> None:
    assert corner.locate(-5.0, 1.0)[0] == pytest.approx(-5.0)
    assert corner.locate(110.0, -65.0)[0] == pytest.approx(155 + ARC, abs=0.01)


def test_what_is_looked_for_nearby_is_found_nearby(corner: Downtrack) -> None:
    assert corner.locate(60.0, 0.0, near=58.0) == pytest.approx((60.0, 0.0))
    station, _ = corner.locate(60.0, 0.0, near=150.0)
    assert station >= 100


def test_points_come_back(corner: Downtrack) -> None:
    for station in np.linspace(0, corner.length, 37):
        found, offset = corner.locate(*corner.point(float(station)))
        assert found == pytest.approx(station, abs=1e-6)
        assert offset == pytest.approx(0.0, abs=1e-6)


def test_lines_and_zones_have_stations(corner: Downtrack) -> None:
    assert corner.stop_line("a") == pytest.approx(95.0)
    assert corner.stop_line("b") is None
    zone = Zone("z", "school", np.array([(100.0, -30.0), (120.0, -30.0), (120.0, -45.0), (100.0, -45.0)]))
    (span,) = corner.within(zone)
    assert (span.start, span.end) == pytest.approx((120 + ARC, 135 + ARC), abs=0.01)
    whole = Zone("w", "jurisdiction", np.array([(-10.0, -100.0), (200.0, -100.0), (200.0, 10.0), (-10.0, 10.0)]))
    assert corner.within(whole) == (Span(0.0, corner.length),)
    assert corner.within(Zone("n", "school", np.array([(300.0, 0.0), (310.0, 0.0), (310.0, 10.0)]))) == ()
