"""Reading SUMO networks: lanes, permissions, links, signals, junctions, and what a wrong file is told."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from regdb_runtime.errors import MapError
from regdb_runtime.maps.road_map import Phase, RoadMap
from regdb_runtime.maps.sumo_net import read_sumo

NET = Path(__file__).parent / "data" / "crossing.net.xml"


@pytest.fixture(scope="module")
def net() -> RoadMap:
    return read_sumo(NET)


def test_a_lane_has_its_shape_and_width(net: RoadMap) -> None:
    lane = net.lanes["W_0"]
    np.testing.assert_allclose(lane.center, [[-100, -1.6], [-10, -1.6]])
    np.testing.assert_allclose(lane.left_line, [[-100, 0], [-10, 0]])
    np.testing.assert_allclose(lane.right_line, [[-100, -3.2], [-10, -3.2]])
    assert net.lanes["S_0"].widths.tolist() == [2.0, 2.0]
    assert (lane.speed_limit, lane.road) == (13.41, "W")


def test_neighbours_and_who_may_change(net: RoadMap) -> None:
    right, left = net.lanes["W_0"], net.lanes["W_1"]
    assert (right.left, right.left_same_direction, left.right, left.right_same_direction) == ("W_1", True, "W_0", True)
    assert right.left_marking == "solid_dashed", "cars may not change from here (buses alone may), but from there"
    assert left.right_marking == "dashed_solid"
    assert net.lanes["E_0"].left_marking == "dashed"
    assert (left.left, left.left_same_direction) == ("-W_0", False), "the edge back lies along the same line"
    assert net.lanes["-W_0"].left == "W_1"
    assert right.right_marking == "unknown"
    assert net.lanes["S_1"].right_marking == "curb"


def test_kinds_and_users(net: RoadMap) -> None:
    assert net.lanes["S_0"].kinds == {"sidewalk"}
    assert net.lanes["S_0"].users == {"pedestrian"}
    assert "car" in net.lanes["W_0"].users
    assert "pedestrian" not in net.lanes["W_0"].users
    assert net.lanes[":J_0_0"].kinds == {"intersection"}


def test_links_run_through_the_junctions_lanes(net: RoadMap) -> None:
    assert net.lanes["S_1"].successors == (":J_2_0", ":J_1_0")
    assert net.lanes[":J_1_0"].successors == ("E_0",)
    assert net.lanes["E_0"].predecessors == (":J_0_0", ":J_1_0")


def test_turns_controls_and_junctions(net: RoadMap) -> None:
    inner = {name: (lane.turn, lane.control) for name, lane in net.lanes.items() if lane.junction is not None}
    assert inner == {":J_0_0": ("straight", "signal"), ":J_3_0": ("straight", "signal"), ":J_1_0": ("right", "signal"), ":J_2_0": ("left", "signal")}
    assert [(part.id, part.lanes) for part in net.junctions["J"].approaches] == [("W", ("W_0", "W_1")), ("S", ("S_0", "S_1"))]
    assert net.lanes[":E_0_0"].junction is None, "where two edges only meet there is no intersection"


def test_signals(net: RoadMap) -> None:
    assert net.lanes["S_1"].lights == ("J/2", "J/3")
    right = net.lights["J/3"]
    assert (right.direction, right.offset, right.position) == ("right", 5.0, (1.6, -10.0))
    assert right.cycle == (Phase("red", 54.0), Phase("red_yellow", 6.0)), "red, and red with a right turn after a stop, are red"
    assert net.lights["J/0"].cycle == (Phase("green", 30.0), Phase("yellow", 4.0), Phase("red", 26.0))
    assert any("'night'" in note for note in net.notes)


def test_crosswalks_and_place(net: RoadMap) -> None:
    (walk,) = net.crosswalks
    np.testing.assert_allclose(walk.polygon, [[-4, -6], [8, -6], [8, -10], [-4, -10]])
    assert net.origin == pytest.approx((-84.38, 33.78 - 0.0011 * 20 / 120 + 0.0), abs=2e-4)
    assert any(":J_w0" in note for note in net.notes)


def test_minor_roads_give_way_and_left_turns_of_the_major_do_not_count(tmp_path: Path) -> None:
    text = NET.read_text()
    for index, state in enumerate(("M", "m", "m", "m")):
        text = text.replace(f'tl="J" linkIndex="{index}" dir="{"sslr"[index]}" state="o"', f'dir="{"sslr"[index]}" state="{state}"')
    file = tmp_path / "priority.net.xml"
    file.write_text(text)
    net = read_sumo(file)
    assert {name: net.lanes[name].control for name in net.junctions["J"].lanes} == {
        ":J_0_0": "none", ":J_3_0": "none", ":J_1_0": "yield", ":J_2_0": "yield"
    }  # fmt: skip
    assert not net.lights


@pytest.mark.parametrize(("state", "control"), [("s", "stop"), ("w", "all_way_stop"), ("=", "none"), ("?", "unknown")])
def test_controls_by_the_connections_state(tmp_path: Path, state: str, control: str) -> None:
    file = tmp_path / "stop.net.xml"
    file.write_text(NET.read_text().replace('tl="J" linkIndex="3" dir="r" state="o"', f'dir="r" state="{state}"'))
    assert read_sumo(file).lanes[":J_1_0"].control == control


WRONG = {
    "lane": ('via=":J_1_0"', 'via=":J_9_0"', "names lane :J_9_0, which the file does not define"),
    "program": ('tl="J" linkIndex="0"', 'tl="K" linkIndex="0"', "tl='K', of which there is no <tlLogic>"),
    "index": ('linkIndex="3"', 'linkIndex="7"', "asks for number 7"),
    "shape": ('shape="-100,-1.6 -10,-1.6"', 'shape="-100,-1.6"', "lane W_0 has a shape of less than two"),
    "point": ('shape="-100,-1.6 -10,-1.6"', 'shape="-100,-1.6 ten"', "lane W_0 has the point 'ten'"),
    "nan": ('shape="-100,-1.6 -10,-1.6"', 'shape="-100,-1.6 nan,0"', "no pair of finite numbers"),
    "speed": ('speed="8.94"', 'speed="fast"', "lane S_1 has speed='fast', which is no number"),
    "width": ('width="2" shape="4.2', 'width="-2" shape="4.2', "lane S_0 has no width"),
    "signal": ('state="GGrr"', 'state="GGxr"', "shows 'x', which is no signal"),
    "root": ("<net ", "<netz ", "not well-formed"),
    "empty edge": ('<lane id="on_0" index="0" speed="11.18" length="50" shape="100,-1.6 150,-1.6"/>', "", "edge on has no <lane>"),
}


@pytest.mark.parametrize(("here", "there", "told"), WRONG.values(), ids=WRONG)
def test_a_wrong_network_is_told_in_one_sentence(tmp_path: Path, here: str, there: str, told: str) -> None:
    text = NET.read_text()
    assert here in text
    file = tmp_path / "wrong.net.xml"
    file.write_text(text.replace(here, there, 1))
    with pytest.raises(MapError) as caught:
        read_sumo(file)
    assert told in str(caught.value)


def test_another_formats_file_is_told() -> None:
    with pytest.raises(MapError, match="the root element is <osm>, a file of this format begins with <net>"):
        read_sumo(NET.with_name("street.osm"))
