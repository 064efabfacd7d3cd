"""Stretches of a path: where they begin and end, whose law governs on each, at what time, and what they know or leave unknown."""

import datetime
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from regdb_runtime.errors import RequestError
from regdb_runtime.maps.lane_path import Junction
from regdb_runtime.maps.road_map import Hours, RoadMap, Zone
from regdb_runtime.observation import Indication
from regdb_runtime.scenes.settings import EgoFacts, SceneSettings, passenger_car
from regdb_runtime.scenes.stretches import Scenes
from regdb_runtime.worlds.road_spec import SignSpec, ZoneSpec
from small_worlds import APPROACH, CAR, GO, LIGHT, NOON, RIGHT, Street, car, cross, judge, law, road, told, worst

STRAIGHT = ("west.e.1", "x.e.straight.1", "east.e.1")
CORNER = ("west.e.1", "x.e.right", "south.s.1")


def around(start: float, end: float) -> np.ndarray:  # type: ignore[type-arg]
    return np.array([(start, -50.0), (end, -50.0), (end, 50.0), (start, 50.0)])


def with_map(street: Street, **changes: object) -> Street:
    street.road_map = replace(street.road_map, **changes)  # type: ignore[arg-type]
    street.scenes = Scenes(street.road_map, law(), CAR, street.settings, street.interpretation)
    street.history = street.scenes.history()
    return street


def test_plain_driving_on_a_complete_map_under_a_complete_eye_is_lawful() -> None:
    street = Street(road(), ("main.e.1",))
    street.see(50.0, 15.0)
    (stretch,) = street.stretches()
    assert (round(stretch.start, 2), round(stretch.end, 2), stretch.stage, stretch.place) == (50.0, 170.0, "road", "los_angeles")
    verdict = judge(stretch, GO, GO, speed=15.0)
    assert verdict.verdict == "legal"
    assert verdict.combined["max_speed"].bound == pytest.approx(15.6464)
    assert judge(stretch, GO, GO, speed=16.0).verdict == "illegal"


@pytest.mark.parametrize("place", ["california", "los_angeles", "los_angeles_county"])
@pytest.mark.parametrize("state", ["go_straight", "car_following", "prepare_lane_change_left", "lane_change_left"])
def test_plain_driving_is_lawful_in_every_state(place: str, state: str) -> None:
    street = Street(road(forward=2, backward=2, jurisdiction=place), ("main.e.1",))
    street.see(50.0, 12.0, signal="left")
    target = {"target_lane": "main.e.2"} if state == "lane_change_left" else {}
    following = f"lane_following.{state}"
    assert worst(street.stretches(GO, following, **target), GO, following, speed=12.0) == "legal"


def test_stretches_follow_each_other_without_gaps() -> None:
    street = Street(cross(), CORNER)
    for front in (20.0, 120.0, 175.0, 194.0, 199.0, 205.0, 215.0, 230.0, 300.0):
        street.see(front, 8.0, lights={LIGHT: (Indication("green"),)})
        found = street.stretches(APPROACH, RIGHT)
        assert found[0].start == pytest.approx(front, abs=0.02)
        assert all(one.end == two.start for one, two in pairwise(found))
        assert found[-1].end == pytest.approx(min(front + 120.0, street.path.path.length), abs=0.05)


def test_the_stages_of_a_junction() -> None:
    street = Street(cross(), CORNER)
    street.see(120.0, 10.0, lights={LIGHT: (Indication("red"),)})
    found = street.stretches(APPROACH, RIGHT)
    assert [item.stage for item in found] == ["road", "approach", "inside", "inside", "inside", "road"]
    assert [round(item.start, 1) for item in found[:4]] == [120.0, 169.5, 194.8, 200.0]
    assert found[0].line is None
    assert found[1].line == pytest.approx(194.8, abs=0.05)
    assert told(found[0], "intersection.present") is False
    assert told(found[0], "signal.present") is False
    assert told(found[0], "intersection.distance") == pytest.approx(30.5)
    asked = ("intersection.present", "intersection.control", "signal.present", "signal.color", "ego.in_intersection")
    assert [told(found[1], name) for name in asked] == [True, "signal", True, "red", False]
    assert [told(found[2], name) for name in asked] == [True, "signal", False, "none", True]
    assert told(found[2], "plan.enters_intersection") is False
    assert told(found[5], "ego.in_intersection") is False
    assert [told(item, "crosswalk.present") for item in found] == [False, True, True, True, True, False]


@pytest.mark.parametrize(
    ("control", "facts"),
    [
        ("signal", {"intersection.control": "signal", "sign.stop": False, "sign.yield": False, "signal.present": True}),
        ("stop", {"intersection.control": "stop_ego", "sign.stop": True, "sign.all_way": False, "signal.present": False, "stop_line.present": True}),
        ("all_way_stop", {"intersection.control": "stop_all", "sign.stop": True, "sign.all_way": True, "signal.present": False}),
        ("yield", {"intersection.control": "yield_ego", "sign.stop": False, "sign.yield": True, "signal.present": False}),
        ("none", {"intersection.control": "none", "sign.stop": False, "sign.yield": False, "signal.present": False}),
    ],
)
def test_what_controls_the_junction(control: str, facts: dict[str, object]) -> None:
    street = Street(cross(control), STRAIGHT)
    street.see(190.0, 3.0, lights={LIGHT: (Indication("green"),)})
    stretch = street.first(APPROACH, APPROACH)
    assert {name: told(stretch, name) for name in facts} == facts


def test_the_main_road_beside_a_stop() -> None:
    arms = {"south": {"control": "stop"}, "north": {"control": "stop"}, "west": {"control": "none"}, "east": {"control": "none"}}
    street = Street(cross("none", arms=arms), STRAIGHT)
    street.see(190.0, 8.0)
    assert told(street.first(APPROACH, APPROACH), "intersection.control") == "stop_cross"


def test_a_signal_that_is_not_seen_is_unknown_unless_the_eye_tells() -> None:
    street = Street(cross(), STRAIGHT)
    street.see(190.0, 8.0)
    stretch = street.first(APPROACH, APPROACH)
    assert told(stretch, "signal.color") is None
    verdict = judge(stretch, APPROACH, APPROACH, speed=8.0, enters_intersection=True)
    assert verdict.verdict == "unknown"
    assert "signal.color" in verdict.missing
    assert judge(stretch, APPROACH, APPROACH, speed=8.0, enters_intersection=False, enters_crosswalk=False).verdict == "legal"
    street.eye |= {"signal.color": "green", "signal.shape": "circular", "signal.flashing": False}
    street.see(190.0, 8.0)
    assert told(street.first(APPROACH, APPROACH), "signal.color") == "green"
    street.eye["signal.color"] = "none"
    street.see(190.0, 8.0)
    assert told(street.first(APPROACH, APPROACH), "signal.color") is None  # the map has a signal: to see none is not to see it


def test_the_law_of_the_place_of_arrival() -> None:
    street = with_map(Street(road(), ("main.e.1",)), zones=(Zone("county", "jurisdiction", around(100.0, 500.0), jurisdiction="los_angeles_county"),))
    street.see(50.0, 10.0)
    found = street.stretches()
    assert [(item.place, round(item.start)) for item in found] == [("los_angeles", 50), ("los_angeles_county", 100)]
    assert [item.view.place for item in found] == ["los_angeles", "los_angeles_county"]


def test_the_law_of_the_time_of_arrival() -> None:
    hours = (Hours(7 * 3600, 16 * 3600),)
    facts = {"school.zone": "marked"}
    street = with_map(Street(road(), ("main.e.1",)), zones=(Zone("school", "school", around(0.0, 500.0), facts, hours=hours),))
    street.see(50.0, 10.0, clock=datetime.datetime(2026, 3, 2, 15, 59, 55))
    found = street.stretches()
    assert [(told(item, "school.zone"), round(item.start)) for item in found] == [("marked", 50), ("none", 100)]
    assert found[1].clock == pytest.approx(datetime.datetime(2026, 3, 2, 16, 0), abs=datetime.timedelta(seconds=0.01))
    street.see(50.0, 10.0, clock=datetime.datetime(2026, 3, 2, 16, 0, 5))
    assert [told(item, "school.zone") for item in street.stretches()] == ["none"]
    street.see(50.0, 10.0, clock=datetime.datetime(2026, 3, 2, 6, 59, 57))
    assert [(told(item, "school.zone"), round(item.start)) for item in street.stretches()] == [("none", 50), ("marked", 80)]


def test_after_midnight_the_law_is_another_day_s() -> None:
    street = Street(road(), ("main.e.1",))
    street.see(50.0, 10.0, clock=datetime.datetime(2022, 12, 31, 23, 59, 55))
    found = street.stretches()
    assert [(item.view.date, round(item.start)) for item in found] == [("2022-12-31", 50), ("2023-01-01", 100)]


def test_a_lower_limit_ahead() -> None:
    street = Street(road(signs=(SignSpec("r", "R2-1", "main", 100.0, speed=11.176),)), ("main.e.1",))
    street.see(50.0, 10.0)
    found = street.stretches()
    assert [(round(item.start), told(item, "posted.speed")) for item in found] == [(50, 15.6464), (100, 11.176)]
    assert [judge(item, GO, GO, speed=12.0).verdict for item in found] == ["legal", "illegal"]


def test_a_school_zone_ahead_binds_from_its_border_on() -> None:
    facts = {"school.present": True, "school.zone": "marked", "zone.posted_outside": "35 mph"}
    spec = road(zones=(ZoneSpec("s", "school", "main", 100.0, 300.0, facts=facts, distance_fact="school.distance", landmark=(200.0, -20.0)),))
    street = Street(spec, ("main.e.1",))
    street.eye |= {"sign.school": True, "school.children_going": True}
    street.see(50.0, 15.0)
    found = street.stretches()
    assert [round(item.start) for item in found] == [50, 100]
    assert [judge(item, GO, GO, speed=15.0).verdict for item in found] == ["legal", "illegal"]
    assert judge(found[1], GO, GO, speed=11.0).combined["max_speed"].bound == pytest.approx(11.176)


def test_rails_ahead() -> None:
    rails = Zone("rails", "rail", around(150.0, 154.0), {"rail.signal_device": True, "rail.view_obstructed": True})
    street = with_map(Street(road(), ("main.e.1",)), zones=(rails,))
    street.see(60.0, 10.0)
    found = street.stretches()
    assert [(round(item.start, 1), told(item, "rail.crossing_ahead"), item.rail) for item in found] == [
        (60.0, False, None), (119.5, True, pytest.approx(150.0, abs=0.02)), (154.0, False, None),
    ]  # fmt: skip
    street.eye |= {"rail.signal": True}
    street.see(140.0, 5.0)
    entering = {"speed": 5.0, "enters_rail_crossing": True}
    assert judge(street.first(), GO, GO, **entering).verdict == "illegal"
    assert judge(street.first(), GO, GO, **{**entering, "enters_rail_crossing": False}).verdict == "legal"


def test_the_map_and_the_eye_agree_or_restrict() -> None:
    street = Street(road(signs=(SignSpec("s", "S1-1", "main", 0.0),)), ("main.e.1",))
    street.see(50.0, 10.0)
    assert told(street.first(), "sign.school") is True  # on the map, not seen
    street.eye |= {"sign.no_passing": True, "posted.speed": 8.0, "district.residence": True}
    street.see(50.0, 10.0)
    stretch = street.first()
    assert told(stretch, "sign.no_passing") is True
    assert told(stretch, "posted.speed") == 8.0
    assert told(stretch, "district.residence") is True
    street.eye["posted.speed"] = 30.0
    street.see(50.0, 10.0)
    assert told(street.first(), "posted.speed") == 15.6464


def test_a_map_with_holes_is_honestly_unknown() -> None:
    street = Street(road(), ("main.e.1",))
    lanes = street.road_map.lanes
    bare = {name: replace(lane, facts={}, kinds=frozenset(), speed_limit=None, left_marking="unknown") for name, lane in lanes.items()}
    with_map(street, lanes=bare, facts={})
    street.see(50.0, 10.0)
    verdict = judge(street.first(), GO, GO, speed=10.0)
    assert verdict.verdict == "unknown"
    assert {"road.types", "school.zone"} & set(verdict.missing)
    assert told(street.first(), "lead.present") is False


def test_an_eye_that_reports_nothing_leaves_unknown_what_only_it_tells() -> None:
    street = Street(road(), ("main.e.1",))
    street.eye = {}
    street.see(50.0, 10.0, silent=frozenset(("perception",)))
    verdict = judge(street.first(), GO, GO, speed=10.0)
    assert verdict.verdict == "unknown"
    assert "road.surface_hazard" not in verdict.assumed
    assert told(street.first(), "sign.no_turn_on_red") is None


def test_manoeuvres_along_one_path_share_scenes_and_another_observation_keeps_them() -> None:
    street = Street(cross(), STRAIGHT)
    street.see(190.0, 8.0, lights={LIGHT: (Indication("green"),)})
    one, other = street.stretches(APPROACH, APPROACH), street.stretches(GO, GO, turn_signal="right")
    assert [a.prepared is b.prepared for a, b in zip(one, other, strict=True)] == [True] * len(one)
    assert (one[0].roles["ego.turn_signal"], other[0].roles["ego.turn_signal"]) == ("off", "right")
    street.see(190.5, 8.0, lights={LIGHT: (Indication("red"),)})
    later = street.stretches(APPROACH, APPROACH)
    assert later[0].prepared is one[0].prepared
    assert (one[0].roles["signal.color"], later[0].roles["signal.color"]) == ("green", "red")
    street.eye["sign.no_right_turn"] = True
    street.see(190.5, 8.0)
    assert told(street.first(APPROACH, APPROACH), "sign.no_right_turn") is True


def test_the_vehicle_s_own_make() -> None:
    street = Street(road(), ("main.e.1",))
    street.see(50.0, 10.0)
    assert told(street.first(), "ego.length") == CAR.length
    assert told(street.first(), "ego.vehicle_class") == "passenger_vehicle"
    truck = passenger_car(law().vocabulary, CAR, ego__axles=3.0, ego__vehicle_class="motortruck")
    street.scenes = Scenes(street.road_map, law(), CAR, ego=truck)
    assert told(street.scenes.stretches(street.observation, street.maneuver(), street.history)[0], "ego.axles") == 3.0  # type: ignore[arg-type]
    street.scenes = Scenes(street.road_map, law(), CAR, ego=EgoFacts())
    assert told(street.scenes.stretches(street.observation, street.maneuver(), street.history)[0], "ego.axles") is None  # type: ignore[arg-type]


def test_nobody_governs_or_nobody_interprets() -> None:
    road_map = RoadMap({})
    with pytest.raises(RequestError, match="which jurisdiction"):
        Scenes(road_map, law(), CAR)
    with pytest.raises(RequestError, match="no interpretation 'gut'"):
        Scenes(road_map, law(), CAR, SceneSettings(place="california"), "gut")
    assert Scenes(road_map, law(), CAR, SceneSettings(place="california")).profile.name == "rss"


def test_the_path_may_end() -> None:
    street = Street(road(), ("main.e.1",))
    street.see(399.99, 1.0)
    assert len(street.stretches()) == 1
    street.see(402.0, 1.0)
    assert len(street.stretches()) == 1


def test_a_junction_without_lanes_on_the_path_is_told_by_its_control() -> None:
    street = Street(road(), ("main.e.1",))
    street.see(80.0, 5.0)
    midblock = Junction("walk", 100.0, 101.0, 105.0, "straight", "signal")
    stretch = street.first(junction=midblock)
    assert (stretch.stage, stretch.line) == ("approach", 100.0)
    assert told(stretch, "signal.present") is True
    assert told(stretch, "signal.place") == "midblock"


def test_time_in_roles_is_now() -> None:
    street = Street(road(), ("main.e.1",))
    street.see(50.0, 7.0, [car("a", 90.0, -1.75)], clock=NOON)
    roles = street.first().roles
    assert (roles["clock.time"], roles["clock.darkness"], roles["ego.speed"]) == (12 * 3600, False, 7.0)


def test_room_beyond_the_rails() -> None:
    rails = Zone("rails", "rail", around(150.0, 154.0), {"rail.signal_device": True})
    street = with_map(Street(road(), ("main.e.1",)), zones=(rails,))
    street.see(60.0, 10.0)
    assert told(street.first(), "rail.exit_blocked") is False
    street.see(140.0, 5.0, [car("queue", 158.0, -1.75, speed=0.0)])
    assert told(street.first(), "rail.exit_blocked") is True
    assert judge(street.first(), GO, GO, speed=5.0, enters_rail_crossing=True).verdict == "illegal"
    street.see(140.0, 5.0, [car("queue", 166.0, -1.75, speed=0.0)])
    assert told(street.first(), "rail.exit_blocked") is False
