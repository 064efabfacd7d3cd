"""Projecting a few points one by one gives the bits that projecting many at once gives, on the path, beside it and beyond its ends."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from regdb_runtime.maps.reference_path import FEW, ReferencePath

PATH = ReferencePath([(0.0, 0.0), (30.0, 0.0), (55.0, 12.0), (70.0, 40.0), (70.0, 80.0), (90.0, 110.0)])


@given(st.lists(st.tuples(st.floats(-30.0, 120.0), st.floats(-30.0, 140.0)), min_size=1, max_size=FEW))
def test_a_few_points_have_the_places_that_they_have_among_many(points: list[tuple[float, float]]) -> None:
    few = PATH.project(np.array(points), extend=True)
    many = PATH.project(np.array(points * (FEW + 1)), extend=True)
    for alone, among in zip(few, many, strict=True):
        assert alone.tobytes() == among[: len(points)].tobytes()


@given(st.floats(0.0, 1.0))
def test_one_station_has_the_direction_and_curvature_that_it_has_among_many(part: float) -> None:
    station = part * PATH.length
    for asked in (PATH.heading, PATH.curvature, PATH.curvature_rate):
        assert float(asked(station)) == asked(np.full(3, station))[1]


@given(st.floats(0.0, 1.0), st.floats(-3.0, 3.0))
def test_what_is_drawn_at_once_is_what_the_plane_and_the_direction_are(part: float, offset: float) -> None:
    stations = np.linspace(part * PATH.length, PATH.length, 4)
    x, y, heading, sharp = PATH.drawn(stations, offset)
    plane = PATH.to_plane(stations, offset)
    assert np.array_equal(plane[:, 0], x)
    assert np.array_equal(plane[:, 1], y)
    assert np.array_equal(PATH.heading(stations), heading)
    assert np.array_equal(1.0 - PATH.curvature(stations) * offset, sharp)
