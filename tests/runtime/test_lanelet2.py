"""Reading Lanelet2 maps: sides whichever way they are drawn, links, neighbours, rules, projection, and what a wrong file is told."""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np
import pytest
from regdb_runtime.errors import MapError
from regdb_runtime.maps.lanelet2 import read_lanelet2
from regdb_runtime.maps.lanelet2_rules import speed_of
from regdb_runtime.maps.mercator import FLATTENING, SEMI_MAJOR, LocalMercator
from regdb_runtime.maps.road_map import RoadMap

STREET = Path(__file__).parent / "data" / "street.osm"


@pytest.fixture(scope="module")
def street() -> RoadMap:
    return read_lanelet2(STREET)


def test_left_lies_on_the_left_whichever_way_the_ways_are_drawn(street: RoadMap) -> None:
    assert street.lanes["1001"].center.tolist() == [[0, 1.75], [50, 1.75]]
    assert street.lanes["1003"].center[0].tolist() == [50, 8.75], "the lane back shares the centre line, drawn the other way"
    assert street.lanes["1003"].center[-1].tolist() == [0, 8.75]
    assert street.lanes["1004"].left_line.tolist() == [[50, 3.5], [90, 3.5]]


def test_sides_of_unequal_points_are_paired(street: RoadMap) -> None:
    lane = street.lanes["1002"]
    assert lane.left_line.tolist() == [[0, 7], [25, 7], [50, 7]]
    assert lane.right_line.tolist() == [[0, 3.5], [25, 3.5], [50, 3.5]]


def test_links_and_neighbours(street: RoadMap) -> None:
    lanes = street.lanes
    assert (lanes["1001"].successors, lanes["1004"].predecessors) == (("1004",), ("1001",))
    assert (lanes["1001"].left, lanes["1001"].left_same_direction, lanes["1001"].right) == ("1002", True, None)
    assert (lanes["1002"].right, lanes["1002"].right_same_direction) == ("1001", True)
    assert (lanes["1002"].left, lanes["1002"].left_same_direction) == ("1003", False)
    assert (lanes["1003"].left, lanes["1003"].left_same_direction) == ("1002", False)


def test_markings_own_side_first(street: RoadMap) -> None:
    lanes = street.lanes
    assert (lanes["1001"].left_marking, lanes["1001"].right_marking) == ("dashed", "curb")
    assert (lanes["1002"].left_marking, lanes["1003"].left_marking) == ("double_solid", "double_solid")
    assert lanes["1004"].left_marking == "solid_dashed", "the way runs west, its left half is this lane's own"


def test_a_double_line_drawn_the_other_way_is_turned(tmp_path: Path) -> None:
    file = tmp_path / "turned.osm"
    file.write_text(STREET.read_text().replace('<nd ref="10"/><nd ref="4"/>', '<nd ref="4"/><nd ref="10"/>'))
    assert read_lanelet2(file).lanes["1004"].left_marking == "dashed_solid"


def test_kinds_users_limits(street: RoadMap) -> None:
    lanes = street.lanes
    assert lanes["1001"].kinds == {"urban"}
    assert lanes["1001"].users == {"vehicle", "bicycle"}
    assert lanes["1004"].users == {"car"}
    assert lanes["1001"].speed_limit == pytest.approx(30 * 0.44704)
    assert lanes["1003"].speed_limit == pytest.approx(50 / 3.6)
    assert lanes["1004"].speed_limit == pytest.approx(25 * 0.44704), "the sign R2-1 prints miles per hour"
    assert (lanes["1005"].kinds, lanes["1005"].users_both_ways) == ({"crosswalk"}, {"pedestrian"})
    assert [walk.id for walk in street.crosswalks] == ["1005"]


def test_rules(street: RoadMap) -> None:
    lane = street.lanes["1001"]
    assert lane.lights == ("111",)
    assert street.lights["111"].position == (91.0, -1.5)
    assert lane.stop_line is not None
    assert (lane.stop_line.start, lane.stop_line.end, lane.stop_line.marked, lane.stop_line.lights) == ((49, 0), (49, 3.5), True, ("111",))
    assert (street.signs["114"].code, street.signs["114"].values) == ("R2-1", ("25",))
    assert street.lanes["1003"].stop_line is not None, "who gives way has the line"
    assert street.lanes["1003"].stop_line.id == "113"


SPEEDS = {"30 mph": 13.4112, "50": 50 / 3.6, "50 km/h": 50 / 3.6, "10 m/s": 10.0, "de:urban": None, "": None}


@pytest.mark.parametrize(("text", "speed"), SPEEDS.items())
def test_speeds(text: str, speed: float | None) -> None:
    assert speed_of(text) == (None if speed is None else pytest.approx(speed))


def test_degrees_are_projected_about_the_origin(tmp_path: Path) -> None:
    file = tmp_path / "degrees.osm"
    file.write_text(re.sub(r'<tag k="local_[xy]" v="[^"]*"/>', "", STREET.read_text()))
    about = read_lanelet2(file, origin=(-84.38, 33.78))
    assert about.origin == (-84.38, 33.78)
    np.testing.assert_allclose(about.lanes["1001"].center, [[0, 1.75], [50, 1.75]], atol=0.02)
    middle = read_lanelet2(file)
    assert middle.lanes["1001"].length == pytest.approx(50, abs=0.02)
    assert middle.origin is not None


def test_the_projection_keeps_lengths_near_the_origin_and_the_meridian_far_off() -> None:
    squared = FLATTENING * (2 - FLATTENING)
    sine = math.sin(math.radians(33.78))
    across = SEMI_MAJOR / math.sqrt(1 - squared * sine**2)
    along = SEMI_MAJOR * (1 - squared) / (1 - squared * sine**2) ** 1.5
    plane, small = LocalMercator(33.78, -84.38), 1e-5
    east, north = plane.to_plane(33.78, -84.38 + small), plane.to_plane(33.78 + small, -84.38)
    assert east == pytest.approx((across * math.cos(math.radians(33.78)) * math.radians(small), 0), abs=1e-6)
    assert north == pytest.approx((0, along * math.radians(small)), abs=1e-6)
    assert LocalMercator(0, 0).to_plane(45, 0)[1] == pytest.approx(4984944.378, abs=0.001), "half a quarter of the meridian"


WRONG = {
    "node": ('<nd ref="2"/>', '<nd ref="99"/>', "way 101 names node 99"),
    "member": ('ref="102" role="left"', 'ref="999" role="left"', "relation 1001 names way 999"),
    "side": ('ref="102" role="left"', 'ref="102" role="middle"', "lanelet 1001 has 0 ways as its left side"),
    "number": ('<tag k="local_x" v="50"/>', '<tag k="local_x" v="far"/>', "no number"),
    "no lanelet": ('v="lanelet"', 'v="area"', "holds no relation of type lanelet"),
    "one point": ('<nd ref="1"/>', "", "way 101, the right side of lanelet 1001, has less than two different points"),
}


@pytest.mark.parametrize(("here", "there", "told"), WRONG.values(), ids=WRONG)
def test_a_wrong_map_is_told_in_one_sentence(tmp_path: Path, here: str, there: str, told: str) -> None:
    text = STREET.read_text()
    assert here in text
    file = tmp_path / "wrong.osm"
    file.write_text(text.replace(here, there))
    with pytest.raises(MapError, match=told):
        read_lanelet2(file)


def test_a_place_that_is_none_is_told(tmp_path: Path) -> None:
    file = tmp_path / "nowhere.osm"
    file.write_text(re.sub(r'<tag k="local_[xy]" v="[^"]*"/>', "", STREET.read_text()).replace('lat="33.78', 'lat="133.78'))
    with pytest.raises(MapError, match="which is nowhere"):
        read_lanelet2(file)
