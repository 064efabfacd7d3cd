"""Lanes cut where zones, signs, distances and hours change the law; crosswalks and rails along them."""

import datetime

import numpy as np
import pytest
from regdb_runtime.maps.road_map import Crosswalk, Hours, RoadMap, Sign, Zone
from regdb_runtime.scenes.pieces import LanePieces, Piece, areas_along, bounds_by_fact, runs
from regdb_runtime.scenes.sign_facts import sign_codes, sign_facts
from regdb_runtime.worlds.road_builder import build_road_map
from regdb_runtime.worlds.road_spec import SignSpec, ZoneSpec
from small_worlds import law, road

MONDAY = datetime.datetime(2026, 3, 2, 12, 0)
FT = 0.3048


def box(start: float, end: float) -> np.ndarray:  # type: ignore[type-arg]
    return np.array([(start, -10.0), (end, -10.0), (end, 10.0), (start, 10.0)])


def pieces(road_map: RoadMap) -> LanePieces:
    return LanePieces(road_map, bounds_by_fact(law().regulations), sign_codes(law().vocabulary))


def street(*zones: Zone, signs: tuple[SignSpec, ...] = ()) -> RoadMap:
    from dataclasses import replace

    return replace(build_road_map(road(signs=signs), law().vocabulary), zones=zones)


def spans(found: tuple[Piece, ...]) -> list[tuple[float, float]]:
    return [(round(item.start, 1), round(item.end, 1)) for item in found]


def test_a_lane_without_zones_is_one_piece() -> None:
    found = pieces(street()).at("main.e.1", MONDAY)
    assert spans(found) == [(0.0, 400.0)]


def test_zones_cut_and_the_later_one_wins() -> None:
    found = pieces(street(
        Zone("a", "work", box(100, 300), {"road.grade": 0.01, "work_zone.present": True}), Zone("b", "hill", box(200, 350), {"road.grade": 0.05}),
    )).at("main.e.1", MONDAY)  # fmt: skip
    assert spans(found) == [(0.0, 100.0), (100.0, 200.0), (200.0, 300.0), (300.0, 350.0), (350.0, 400.0)]
    assert [item.facts["road.grade"] for item in found] == [0.0, 0.01, 0.05, 0.05, 0.0]
    assert [item.facts.get("work_zone.present") for item in found] == [None, True, True, None, None]


def test_the_jurisdiction_changes_at_the_border() -> None:
    found = pieces(street(Zone("county", "jurisdiction", box(150, 500), jurisdiction="los_angeles_county"))).at("main.e.1", MONDAY)
    assert [(item.jurisdiction, round(item.start, 2)) for item in found] == [(None, 0.0), ("los_angeles_county", pytest.approx(150.0, abs=0.01))]


def test_a_distance_is_cut_where_the_law_compares_it_and_lies_on_one_side_of_each_number() -> None:
    bounds = bounds_by_fact(law().regulations)["school.distance"]
    assert bounds == pytest.approx((500 * FT, 1000 * FT))
    zone = Zone("school", "school", box(0, 400), {"school.present": True}, distance_fact="school.distance", landmark=(400.0, -1.75))
    found = pieces(street(zone)).at("main.e.1", MONDAY)
    assert [round(item.start, 1) for item in found] == [0.0, round(400 - 1000 * FT, 1), round(400 - 500 * FT, 1)]
    near = [item.facts["school.distance"] for item in found]
    assert near[0] > bounds[1] > near[1] > bounds[0] > near[2]  # type: ignore[operator]


def test_a_zone_with_hours_is_one_only_then() -> None:
    hours = Hours(7 * 3600, 16 * 3600, frozenset(range(5)))
    found = pieces(street(Zone("school", "school", box(100, 200), {"school.zone": "marked"}, hours=(hours,))))
    assert len(found.at("main.e.1", MONDAY)) == 3
    assert len(found.at("main.e.1", MONDAY.replace(hour=16))) == 1
    assert len(found.at("main.e.1", MONDAY + datetime.timedelta(days=5))) == 1
    assert found.next_change(MONDAY.replace(hour=15, minute=59, second=50), 30.0) == pytest.approx(10.0)
    assert found.next_change(MONDAY, 30.0) is None


@pytest.mark.parametrize(
    ("day", "hour", "expected"), [(0, 23, True), (1, 1, True), (1, 2, False), (1, 23, False), (0, 1, False)]
)
def test_hours_over_midnight_belong_to_the_day_on_which_they_begin(day: int, hour: int, expected: bool) -> None:
    zone = Zone("night", "parking", box(0, 1), hours=(Hours(22 * 3600, 2 * 3600, frozenset((0,))),))
    assert runs(zone, MONDAY.replace(hour=hour) + datetime.timedelta(days=day)) is expected


def test_signs_speak_from_their_place_on_and_those_of_the_junction_everywhere() -> None:
    limit = SignSpec("limit", "R2-1", "main", 250.0, speed=11.176)
    signs = (SignSpec("school", "S1-1", "main", 120.0), SignSpec("no_turn", "R10-11", "main", 300.0), limit)
    found = pieces(street(signs=signs)).at("main.e.1", MONDAY)
    assert [round(item.start) for item in found] == [0, 120, 250]
    assert [item.facts.get("sign.school") for item in found] == [None, True, True]
    assert [item.facts.get("sign.no_turn_on_red") for item in found] == [True, True, True]
    assert [item.facts["posted.speed"] for item in found] == [15.6464, 15.6464, 11.176]


def test_signs_by_their_codes() -> None:
    codes = sign_codes(law().vocabulary)
    assert sign_facts(Sign("a", "R10-11a"), codes) == {"sign.no_turn_on_red": True}
    assert sign_facts(Sign("a", "R2-1", speed=10.0), codes) == {"sign.speed_limit": True, "posted.speed": 10.0}
    assert sign_facts(Sign("a", "R2-1"), codes) == {}
    assert sign_facts(Sign("a", "274"), codes) == {}
    assert sign_facts(Sign("a", "S5-1"), codes) == {"sign.school_limit": True}


def test_crosswalks_and_rails_along_a_lane() -> None:
    from dataclasses import replace

    rails = Zone("rails", "rail", box(200, 206), {"rail.signal_device": True})
    road_map = replace(street(rails), crosswalks=(Crosswalk("walk", box(100, 103)), Crosswalk("old", box(50, 53), marked=False)))
    found = pieces(road_map)
    assert [(band.id, round(band.start, 1), round(band.end, 1), band.marked) for band in found.crosswalks("main.e.1")] == [
        ("old", 50.0, 53.0, False), ("walk", 100.0, 103.0, True),
    ]  # fmt: skip
    assert [(band.id, round(band.start, 1)) for band in found.rails("main.e.1")] == [("rails", 200.0)]
    assert spans(found.at("main.e.1", MONDAY)) == [(0.0, 400.0)]


def test_an_area_met_twice() -> None:
    lane = build_road_map(road(), law().vocabulary).lanes["main.e.1"]
    comb = np.array([(10, -5), (20, -5), (20, 1), (30, 1), (30, -5), (40, -5), (40, 5), (10, 5)], float)
    assert [(round(a), round(b)) for a, b in areas_along(lane, comb, 1.0)] == [(10, 20), (30, 40)]


def test_zones_of_a_scene() -> None:
    spec = road(zones=(ZoneSpec("z", "school", "main", 100.0, 200.0, facts={"school.zone": "marked"}),))
    found = pieces(build_road_map(spec, law().vocabulary)).at("main.e.1", MONDAY)
    assert [item.facts["school.zone"] for item in found] == ["none", "marked", "none"]
