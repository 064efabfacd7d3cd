"""The road across a path: lanes, edges and halves at their places, and nothing within junctions."""

from __future__ import annotations

import numpy as np
import pytest
from assessment_scene import LEFT, RIGHT, WIDTH, along, law, road
from regdb_runtime.assessment.alike import Distinguished
from regdb_runtime.assessment.cross_section import Roads
from regdb_runtime.assessment.route_facts import outermost
from regdb_runtime.maps.lane_path import lane_path
from regdb_runtime.worlds.road_builder import build_road_map
from regdb_runtime.worlds.road_spec import Arm, JunctionSpec, Piece, Pose, RoadSpec, StreetsSpec


def test_lines_lie_where_the_lanes_end() -> None:
    sections = Roads(road()).sections(along(RIGHT))
    index = sections.columns(np.array([[100.3]]))
    right, divider, center, left = sections.at(sections.across, index)[:, 0, 0]
    assert (right, divider, center, left) == pytest.approx((-WIDTH / 2, WIDTH / 2, 1.5 * WIDTH, 2.5 * WIDTH), abs=1e-6)
    assert sections.has_opposing


def test_the_same_road_seen_from_the_next_lane() -> None:
    sections = Roads(road()).sections(along(LEFT))
    index = sections.columns(np.array([[100.3]]))
    found = sections.at(sections.across, index)[:, 0, 0]
    assert found == pytest.approx((-1.5 * WIDTH, -WIDTH / 2, WIDTH / 2, 1.5 * WIDTH), abs=1e-6)


def test_bicycle_lanes_are_known_by_their_kind() -> None:
    main = RoadSpec("main", (Piece(300),), forward=1, backward=1, bicycle_lane=1.6)
    found = build_road_map(StreetsSpec((main,)), law().vocabulary)
    lane = next(name for name, lane in found.lanes.items() if name.startswith("main.e") and "bicycle_lane" not in lane.kinds)
    sections = Roads(found).sections(lane_path(found, None, lane, 250.0, 0.0))
    near, far = sections.at(sections.kinds["bicycle_lane"], sections.columns(np.array([50.0])))[:, 0]
    assert far - near == pytest.approx(1.6, abs=0.01)


def test_there_are_no_lines_within_junctions() -> None:
    roads = (
        RoadSpec("west", (Piece(100),)), RoadSpec("east", (Piece(100),), Pose(130.0)),
        RoadSpec("south", (Piece(100),), Pose(115.0, -115.0, 90.0)),
    )  # fmt: skip
    arms = (Arm("west", "end"), Arm("east", "start"), Arm("south", "end"))
    found = build_road_map(StreetsSpec(roads, (JunctionSpec("middle", arms),)), law().vocabulary)
    lane = next(name for name in found.lanes if name.startswith("west.e"))
    way = lane_path(found, None, lane, 200.0, 0.0)
    inside = next(span for span in way.spans if found.lanes[span.lane].junction is not None)
    sections = Roads(found).sections(way)
    within = sections.at(sections.across, sections.columns(np.array([(inside.start + inside.end) / 2])))
    before = sections.at(sections.across, sections.columns(np.array([inside.start - 20.0])))
    assert np.isnan(within).all()
    assert np.isfinite(before[[0, -2, -1]]).all()


def test_the_outermost_lane_is_the_one_the_turn_asks_for() -> None:
    roads = Roads(road())
    right, left = road().lanes[RIGHT], road().lanes[LEFT]
    assert (outermost(right, roads.strips(right), to_right=True), outermost(left, roads.strips(left), to_right=True)) == ("rightmost", "leftmost")
    single = Roads(road(forward=1))
    only = road(forward=1).lanes[RIGHT]
    assert outermost(only, single.strips(only), to_right=True) == "rightmost"
    assert outermost(only, single.strips(only), to_right=False) == "leftmost"


def test_rules_are_read_once_and_together() -> None:
    """What a set of rules distinguishes is the union of what each does."""
    view = law().at("los_angeles", "2026-03-02")
    rules = view.concerned("lane_following.go_straight", "lane_following.go_straight")
    known = Distinguished()
    together = known.of(rules)
    assert together is known.of(rules)
    assert together.facts == frozenset(fact for rule in rules for fact in rule.facts)
    limits = {bound.constant for bound in together.compared["plan.speed"] if not bound.terms}
    assert {25 * 0.44704, 65 * 0.44704} <= {round(limit, 6) for limit in limits}
