"""Which lane a place lies in, on fixtures and on every recorded map; neighbours; speed of the index."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from regdb_runtime.maps.commonroad import read_commonroad
from regdb_runtime.maps.lane_graph import LaneGraph, is_driven
from regdb_runtime.maps.lanelet2 import read_lanelet2
from regdb_runtime.maps.lines import at_stations, crossing, inside, offset, paired, project, stations, turned
from regdb_runtime.maps.road_map import RoadMap
from regdb_runtime.maps.sumo_net import read_sumo

DATA = Path(__file__).parent / "data"
RECORDED = sorted((Path(__file__).resolve().parents[3] / "shared" / "scenarios").glob("*.xml"))
MAPS = {"2020a": (read_commonroad, "junction_2020a.xml"), "2018b": (read_commonroad, "crossing_2018b.xml"), "sumo": (read_sumo, "crossing.net.xml"),
        "lanelet2": (read_lanelet2, "street.osm")}  # fmt: skip


def own_centres_lie_in_their_lanes(road_map: RoadMap) -> None:
    graph = LaneGraph(road_map)
    for name, lane in road_map.lanes.items():
        for station in np.linspace(0.02, 0.98, 9) * lane.length:
            x, y = at_stations(lane.center, np.array([station]))[0]
            found = graph.lane_at(x, y, graph.heading(name, station), among=[name])
            assert found is not None, (name, station)
            assert found[0] == name
            assert found[1] == pytest.approx(station, abs=1e-6)
            assert found[2] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize(("reader", "file"), MAPS.values(), ids=MAPS)
def test_a_lanes_own_centre_lies_in_it(reader, file: str) -> None:  # type: ignore[no-untyped-def]
    own_centres_lie_in_their_lanes(reader(DATA / file))


@pytest.mark.skipif(not RECORDED, reason="the recorded scenarios are not there")
@pytest.mark.parametrize("file", RECORDED, ids=[file.stem for file in RECORDED])
def test_on_recorded_maps_too_and_with_many_points_at_once(file: Path) -> None:
    road_map = read_commonroad(file)
    own_centres_lie_in_their_lanes(road_map)
    graph = LaneGraph(road_map)
    dice = np.random.default_rng(7)
    low, high = (np.min([lane.center.min(axis=0) for lane in road_map.lanes.values()], axis=0),
                 np.max([lane.center.max(axis=0) for lane in road_map.lanes.values()], axis=0))  # fmt: skip
    points = dice.uniform(low, high, (200, 2))
    headings = dice.uniform(-math.pi, math.pi, 200)
    singly = [graph.lane_at(x, y, heading) for (x, y), heading in zip(points.tolist(), headings.tolist(), strict=True)]
    assert graph.lanes_at(points, headings) == singly
    assert any(found is not None for found in singly)


def test_where_lanes_overlap_the_course_decides() -> None:
    graph = LaneGraph(read_commonroad(DATA / "junction_2020a.xml"))
    across, north = graph.lane_at(1.75, -1.75, 0.0), graph.lane_at(1.75, -1.75, math.pi / 2)
    assert across is not None
    assert north is not None
    assert (across[0], north[0]) == ("22", "21")
    assert across[1:] == pytest.approx((11.75, 0.0))


def test_offsets_are_positive_to_the_left() -> None:
    graph = LaneGraph(read_commonroad(DATA / "junction_2020a.xml"))
    found = graph.lane_at(1.0, -30.0)
    assert found is not None
    assert found == ("10", pytest.approx(20.0), pytest.approx(0.75))


def test_outside_all_lanes_there_is_none_and_the_nearest_is_named_within_reach() -> None:
    graph = LaneGraph(read_commonroad(DATA / "junction_2020a.xml"))
    assert graph.lane_at(20.0, -40.0) is None
    assert graph.nearest(6.0, -40.0, reach=5.0) == ("10", pytest.approx(10.0), pytest.approx(-4.25))
    assert graph.nearest(6.0, -40.0, reach=4.0) is None


def test_the_line_between_two_lanes_belongs_to_one_of_them() -> None:
    graph = LaneGraph(read_commonroad(DATA / "junction_2020a.xml"))
    for y in (-50.0, -30.0, -10.0):
        found = graph.lane_at(0.0, y)
        assert found is not None
        assert found[0] in ("10", "13", "20", "21", "23")


def test_crosswalks_are_named_when_asked_among() -> None:
    graph = LaneGraph(read_commonroad(DATA / "junction_2020a.xml"))
    here = graph.lane_at(1.75, -16.0)
    assert here is not None
    assert here[0] == "10"
    walk = graph.lane_at(1.75, -16.0, among=["60"])
    assert walk is not None
    assert walk[0] == "60"


def test_the_ways_on_from_a_lane() -> None:
    road_map = read_commonroad(DATA / "junction_2020a.xml")
    graph = LaneGraph(road_map)
    assert graph.successors("10") == ("20", "21")
    assert graph.predecessors("30") == ("20", "22")
    assert (graph.neighbors("10"), graph.left("10"), graph.right("13"), graph.right("10")) == (("13",), "13", "10", None)
    assert graph.oncoming("10") == "11"
    assert graph.junction_of("21") == "70"
    assert graph.along(["10", "20", "30"])
    assert not graph.along(["10", "30"])
    assert [name for name, lane in road_map.lanes.items() if not is_driven(lane)] == ["60"]


def test_lines() -> None:
    line = np.array([[0.0, 0.0], [3.0, 4.0], [3.0, 10.0]])
    assert stations(line).tolist() == [0, 5, 11]
    assert at_stations(line, np.array([2.5, 8.0])).tolist() == [[1.5, 2.0], [3.0, 7.0]]
    assert turned(line) == pytest.approx(math.pi / 2 - math.atan2(4, 3))
    assert crossing(line, np.array([[0.0, 8.0], [6.0, 8.0]])) == pytest.approx((9.0, 3.0))
    assert crossing(line, np.array([[5.0, 0.0], [6.0, 8.0]])) is None
    square = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]])
    assert inside(np.array([[1.0, 1.0], [3.0, 1.0], [-0.1, 0.5]]), square).tolist() == [True, False, False]


def test_a_moved_line_keeps_its_distance() -> None:
    angles = np.linspace(0, math.pi, 40)
    circle = 20 * np.column_stack((np.cos(angles), np.sin(angles)))
    for distance in (1.6, -1.6):
        moved = offset(circle, distance)
        off = project(moved, circle)[1]
        np.testing.assert_allclose(off, distance, atol=0.01)


def test_pairing_keeps_every_vertex_of_both_sides() -> None:
    left, right = np.array([[0.0, 1.0], [3.0, 1.0], [10.0, 1.0]]), np.array([[0.0, 0.0], [6.0, 0.0], [8.0, 0.0], [10.0, 0.0]])
    first, second = paired(left, right)
    assert first[:, 0].tolist() == second[:, 0].tolist() == [0, 3, 6, 8, 10]
