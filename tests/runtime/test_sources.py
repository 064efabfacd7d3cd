"""Map, clock, GNSS and detector as statements; whose law governs where."""

from __future__ import annotations

import datetime
import json
import math
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from regdb_runtime.database import RegulationDatabase
from regdb_runtime.errors import MapError
from regdb_runtime.perception.areas import EARTH, Area, read_areas
from regdb_runtime.perception.evidence import Reading
from regdb_runtime.perception.fusion import Fusion
from regdb_runtime.perception.jurisdiction_at import JurisdictionMap
from regdb_runtime.perception.sources import Box, DetectionReader, DetectorSettings, Fix, ZoneMap, clock_reading, known_facts

from regdb.front import database

FOUND = RegulationDatabase.open(database())
VOCABULARY, TREE = FOUND.vocabulary, FOUND.tree
METRE = 1 / (math.radians(1) * EARTH)
"""Degrees of latitude in a metre."""


def square(west: float, south: float, east: float, north: float, **properties: object) -> Area:
    return Area(properties, ((((west, south), (east, south), (east, north), (west, north)),),))


COUNTY = square(-119.0, 33.7, -117.6, 34.8, jurisdiction="los_angeles_county")
CITY = square(-118.6, 33.9, -118.2, 34.3, jurisdiction="los_angeles")
OTHER = square(-118.2, 34.1, -118.0, 34.2, kind="city", name="another city")


@pytest.fixture(scope="module")
def law() -> JurisdictionMap:
    return JurisdictionMap(TREE, [COUNTY, CITY, OTHER], "california")


@pytest.mark.parametrize(("point", "place", "incorporated"), [
    ((-118.4, 34.1), "los_angeles", True), ((-118.1, 34.5), "los_angeles_county", False),
    ((-118.1, 34.15), "california", True), ((-121.0, 38.0), "california", False),
])  # fmt: skip
def test_city_county_and_state_govern_where_their_territory_is(
    law: JurisdictionMap, point: tuple[float, float], place: str, incorporated: bool
) -> None:
    found = law.at(point)
    assert (found.place, found.also, found.incorporated) == (place, (), incorporated)
    assert FOUND.at(found.place, "2026-11-21")


def test_near_a_border_both_sides_are_named(law: JurisdictionMap) -> None:
    point = (-118.4, 34.3 + 8 * METRE)
    assert law.at(point, accuracy=5.0).also == ()
    found = law.at(point, accuracy=10.0)
    assert (found.place, found.also, found.incorporated) == ("los_angeles_county", ("los_angeles",), None)


@given(st.floats(-118.61, -118.19), st.floats(33.89, 34.31), st.floats(0.1, 500))
def test_who_governs_for_sure_governs_at_every_place_within_reach(x: float, y: float, accuracy: float) -> None:
    law = JurisdictionMap(TREE, [COUNTY, CITY, OTHER], "california")
    found = law.at((x, y), accuracy)
    for turn in range(8):
        dx, dy = 0.99 * accuracy * math.cos(turn * math.pi / 4), 0.99 * accuracy * math.sin(turn * math.pi / 4)
        there = law.at((x + dx * METRE / math.cos(math.radians(y)), y + dy * METRE)).place
        assert there in {found.place, *found.also}


def test_areas_name_what_is_wrong_with_them(tmp_path: Path) -> None:
    with pytest.raises(MapError, match="atlantis"):
        JurisdictionMap(TREE, [square(0, 0, 1, 1, jurisdiction="atlantis")], "california")
    with pytest.raises(MapError, match="govern nothing"):
        JurisdictionMap(TREE, [square(0, 0, 1, 1)], "california")
    with pytest.raises(MapError, match=r"did you mean school\.zone"):
        ZoneMap(VOCABULARY, [square(0, 0, 1, 1, facts={"school.zon": "marked"})])
    for text, reason in [("{", "no GeoJSON"), ("[]", "FeatureCollection"), (_file("Point", [0, 0]), r"features\[0\].*encloses nothing"),
                         (_file("Polygon", [[[34.0, -118.0], [34.0, -118.1], [34.1, -118.0]]]), "longitude, then latitude"),
                         (_file("Polygon", [[[0, 0], [1, 1], [0, 0]]]), "three corners")]:  # fmt: skip
        path = tmp_path / "areas.json"
        path.write_text(text)
        with pytest.raises(MapError, match=reason):
            read_areas(path)


def _file(kind: str, coordinates: object) -> str:
    return json.dumps({"type": "FeatureCollection", "features": [{"type": "Feature", "geometry": {"type": kind, "coordinates": coordinates}}]})


def test_holes_are_outside_and_borders_are_measured_in_metres(tmp_path: Path) -> None:
    outer = [[-118.4, 34.0], [-118.3, 34.0], [-118.3, 34.1], [-118.4, 34.1], [-118.4, 34.0]]
    hole = [[-118.36, 34.04], [-118.34, 34.04], [-118.34, 34.06], [-118.36, 34.06], [-118.36, 34.04]]
    (tmp_path / "a.json").write_text(_file("Polygon", [outer, hole]))
    (area,) = read_areas(tmp_path / "a.json")
    assert area.contains((-118.38, 34.05))
    assert not area.contains((-118.35, 34.05))
    assert area.border_distance((-118.35, 34.04 - 100 * METRE)) == pytest.approx(100, rel=1e-3)
    assert area.border_distance((-118.4 - 100 * METRE / math.cos(math.radians(34.05)), 34.05)) == pytest.approx(100, rel=1e-3)


def test_a_zone_holds_where_the_vehicle_may_be_inside_and_is_over_where_it_surely_is_not() -> None:
    zones = ZoneMap(VOCABULARY, [square(-118.4, 34.0, -118.39, 34.01, facts={"school.zone": "marked"})])

    def said(metres_south: float) -> dict[str, object]:
        fix = Fix((-118.395, 34.0 - metres_south * METRE), 5.0, 1.0)
        return {item.fact: item.value for item in zones.reading(fix).statements}

    assert said(-50.0) == said(-3.0) == said(3.0) == {"school.zone": "marked"}
    assert said(8.0) == {"school.zone": "none"}
    fusion = Fusion(VOCABULARY)
    fusion.update(zones.reading(Fix((-118.395, 34.005), 5.0, 0.0)), 0.0, 0.0)
    assert fusion.snapshot(0.0, 0.0).facts["school.zone"] == "marked"
    fusion.update(zones.reading(Fix((-118.395, 33.99), 5.0, 60.0)), 900.0, 60.0)
    found = fusion.snapshot(60.0, 900.0)
    assert found.facts["school.zone"] == "none"
    assert found.evidence["school.zone"][0].rule == "gnss in outside every area"


def test_the_clock_tells_day_and_time() -> None:
    fusion = Fusion(VOCABULARY)
    fusion.update(clock_reading(datetime.datetime(2026, 11, 23, 7, 30), 5.0), 0.0, 5.0)
    found = fusion.snapshot(5.0, 0.0)
    assert found.facts["clock.weekday"] == "monday"
    assert found.facts["clock.time"] == 27000
    assert found.evidence["clock.time"][0].source == "clock"
    assert "clock.time" not in fusion.snapshot(60.0, 0.0).facts, "a clock that has stopped tells no time"


def test_what_the_map_knows_is_known_at_once() -> None:
    fusion = Fusion(VOCABULARY)
    fusion.update(known_facts({"crosswalk.present": False, "signal.present": True}, 0.0), 0.0, 0.0)
    found = fusion.snapshot(0.0, 0.0)
    assert (found.facts["crosswalk.present"], found.facts["signal.present"]) == (False, True)


def test_detections_are_statements_by_confidence_and_code() -> None:
    reader = DetectionReader(VOCABULARY, DetectorSettings(covers=frozenset(["person", "R10-11"])))
    boxes = [Box("R1-1", (10, 20, 30, 40), 0.9, "7"), Box("person", (1, 2, 3, 4), 0.4), Box("R1-1", (50, 20, 70, 40), 0.8),
             Box("kite", (0, 0, 1, 1), 1.0), Box("traffic light: red", (5, 5, 9, 15), 0.2)]  # fmt: skip
    found = {(item.fact, item.value): item for item in reader.read(boxes, 3.0, "f3").statements}
    assert set(found) == {("sign.stop", True), ("pedestrian.present", True), ("sign.no_turn_on_red", False)}
    assert found["sign.stop", True].rule == "R1-1 0.90 at 10,20,30,40 track 7"
    assert found["pedestrian.present", True].certainty == "hedged"
    assert found["sign.no_turn_on_red", False].certainty == "asserted"
    assert {item.source for item in found.values()} == {"detector"}


def test_detections_do_not_depend_on_their_order() -> None:
    reader = DetectionReader(VOCABULARY)
    boxes = [Box("person", (1, 2, 3, 4), 0.7), Box("person", (9, 2, 12, 4), 0.7), Box("stop sign", (0, 0, 1, 1), 0.65)]
    assert reader.read(boxes, 0.0) == reader.read(boxes[::-1], 0.0)
    assert reader.read([], 0.0) == Reading("")
