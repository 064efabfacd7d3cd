"""Roles of the traffic along the road, each in a small world: who fills them, and when they are empty, or unknown."""

import math

import pytest
from regdb_runtime.observation import Track
from small_worlds import GO, Street, car, road, told

BACK = math.pi


def street(lanes: int = 1, **more: object) -> Street:
    return Street(road(forward=lanes, backward=lanes, **more), ("main.e.1",))


def y(lane: int, lanes: int = 1) -> float:
    """Middle of a forward lane, numbered from the right-hand edge."""
    return -3.5 * (lanes - lane + 0.5)


def roles(found: Street, *tracks: Track, front: float = 100.0, speed: float = 10.0, **maneuver: object) -> dict[str, object]:
    found.see(front, speed, tracks)
    return dict(found.first(**maneuver).roles)  # type: ignore[arg-type]


def test_an_empty_road() -> None:
    facts = roles(street())
    empty = (
        "lead.present", "follower.present", "bicycle.ahead", "obstruction.ahead", "stationary_hazard_vehicle.beside", "oncoming.meeting",
        "pedestrian.on_roadway", "pedestrian.present", "target_lane.hazard", "movement.hazard", "cross_traffic.hazard", "other.may_be_affected",
        "lane.same_direction_available", "emergency_vehicle.approaching", "animal.ahead", "oncoming.hazard", "lead.turning_left",
    )  # fmt: skip
    assert {name: facts[name] for name in empty} == dict.fromkeys(empty, False)
    assert facts["ego.followers_queued"] == 0.0


def test_the_lead_is_the_nearest_ahead_in_the_lane() -> None:
    facts = roles(street(), car("far", 160.0, y(1)), car("near", 130.0, y(1), speed=7.0), car("oncoming", 115.0, 1.75, BACK))
    assert facts["lead.present"] is True
    assert facts["lead.speed"] == pytest.approx(7.0)
    assert facts["lead.distance"] == pytest.approx(130.0 - 2.3 - 100.0)


def test_a_vehicle_in_the_next_lane_is_no_lead() -> None:
    assert roles(street(2), car("beside", 120.0, y(2, 2)))["lead.present"] is False


def test_a_bicycle_is_no_lead_but_a_bicycle_ahead_up_to_beside_the_lane() -> None:
    for side in (y(1), -3.2, -4.2):
        facts = roles(street(), car("rider", 130.0, side, speed=5.0, kind="bicycle"))
        assert facts["lead.present"] is False
        assert facts["bicycle.ahead"] is True
    assert roles(street(), car("rider", 130.0, 1.75, BACK, 5.0, "bicycle"))["bicycle.ahead"] is False
    assert roles(street(), car("rider", 80.0, -3.0, speed=5.0, kind="bicycle"))["bicycle.ahead"] is False


@pytest.mark.parametrize(("signal", "turns"), [("left", True), ("right", False), ("off", False), (None, None)])
def test_whether_the_one_to_be_passed_turns_left(signal: str | None, turns: bool | None) -> None:
    facts = roles(street(), car("lead", 130.0, y(1), turn_signal=signal), passes="lead")
    assert facts.get("lead.turning_left") is turns


def test_followers_and_the_line_they_form() -> None:
    behind = [car(f"f{n}", 100.0 - 4.8 - 10.0 * n, y(1)) for n in (1, 2, 3)]
    facts = roles(street(), *behind, car("late", 10.0, y(1)))
    assert facts["follower.present"] is True
    assert facts["ego.followers_queued"] == 3.0
    assert facts["other.may_be_affected"] is True


def test_slower_than_the_traffic() -> None:
    assert roles(street(2), car("fast", 130.0, y(2, 2), speed=20.0))["ego.left_of_slower_traffic"] is True
    assert roles(street(2), car("same", 130.0, y(2, 2), speed=11.0))["ego.left_of_slower_traffic"] is False


@pytest.mark.parametrize(
    ("x", "speed", "available"),
    # RSS behind: 2 s to respond, acceleration 3.5, then 4 m/s2 of braking, the front one braking at 8
    [(98.0, 10.0, False), (60.0, 20.0, False), (20.0, 12.0, True), (105.0, 10.0, False), (190.0, 10.0, True), (115.0, 0.0, False)],
)
def test_another_lane_is_available_where_it_is_free_behind_alongside_and_ahead(x: float, speed: float, available: bool) -> None:
    assert roles(street(2), car("other", x, y(2, 2), speed=speed))["lane.same_direction_available"] is available


def test_no_other_lane_no_other_direction_no_bicycle_lane_and_no_double_line() -> None:
    assert roles(street(1))["lane.same_direction_available"] is False
    assert roles(street(1, bicycle_lane=1.5))["lane.same_direction_available"] is False
    assert roles(street(2))["lane.same_direction_available"] is True
    assert roles(street(2, divider="solid"))["lane.same_direction_available"] is True
    assert roles(street(2, divider="double_solid"))["lane.same_direction_available"] is False


def test_whether_a_lane_is_available_is_open_where_nobody_judges() -> None:
    undecided = Street(road(forward=2, backward=2), ("main.e.1",), interpretation="statute_only")
    assert "lane.same_direction_available" not in roles(undecided, car("other", 60.0, y(2, 2)))
    assert roles(undecided)["lane.same_direction_available"] is True


def changing(found: Street, *tracks: Track) -> dict[str, object]:
    return roles(found, *tracks, target_lane="main.e.2", following="lane_following.lane_change_left")


def test_the_target_lane() -> None:
    found = street(2)
    free = changing(found)
    assert (free["target_lane.hazard"], free["movement.hazard"]) == (False, False)
    assert (free["target_lane.kind"], free["lane.crossed_marking"]) == ("general", "broken_white")
    for x, speed in ((97.0, 10.0), (70.0, 20.0)):
        taken = changing(found, car("other", x, y(2, 2), speed=speed))
        assert (taken["target_lane.hazard"], taken["movement.hazard"]) == (True, True)
    assert changing(found, car("other", 97.0, y(1, 2) - 30.0))["target_lane.hazard"] is False
    assert changing(found, car("slow", 60.0, y(2, 2), speed=5.0))["target_lane.hazard"] is False


def test_the_path_of_a_change_of_lane_may_run_along_the_target() -> None:
    found = Street(road(forward=2, backward=2), ("main.e.2",))
    found.see(100.0, 10.0, [car("beside", 98.0, y(2, 2)), car("lead", 130.0, y(1, 2))], offset=-3.5)
    facts = found.first(GO, "lane_following.lane_change_left", lane="main.e.1", target_lane="main.e.2").roles
    assert facts["target_lane.hazard"] is True
    assert facts["lead.distance"] == pytest.approx(130.0 - 2.3 - 100.0, abs=0.01)
    assert facts["lane.crossed_marking"] == "broken_white"


@pytest.mark.parametrize(
    ("x", "side", "lights", "kind", "beside"),
    [(130.0, -5.2, "hazard_lights", "none", True), (130.0, -5.2, "none", "none", False), (130.0, -5.2, "emergency_lights", "emergency", True),
     (80.0, -5.2, "hazard_lights", "none", False), (130.0, -9.0, "hazard_lights", "none", False), (130.0, -1.75, "hazard_lights", "none", False)],
)  # fmt: skip
def test_a_vehicle_that_stands_beside_the_lane_with_lights_on(x: float, side: float, lights: str, kind: str, beside: bool) -> None:
    facts = roles(street(), car("stalled", x, side, speed=0.0, warning_lights=lights, hazard_kind=kind))
    assert facts["stationary_hazard_vehicle.beside"] is beside
    if beside:
        assert facts["stationary_hazard_vehicle.lights"] == lights
        assert facts["stationary_hazard_vehicle.kind"] == ("emergency" if kind == "emergency" else "other_with_hazards")


def test_one_lane_farther_left_it_is_beside_no_more() -> None:
    facts = roles(Street(road(forward=2, backward=2), ("main.e.2",)), car("stalled", 130.0, -8.7, speed=0.0, warning_lights="hazard_lights"))
    assert facts["stationary_hazard_vehicle.beside"] is False


def test_obstructions_are_things_and_vehicles_that_stand_with_their_lights_on() -> None:
    assert roles(street(), car("tree", 130.0, y(1), speed=0.0, kind="obstacle"))["obstruction.ahead"] is True
    assert roles(street(), car("stalled", 130.0, y(1), speed=0.0, warning_lights="hazard_lights"))["obstruction.ahead"] is True
    assert roles(street(), car("queue", 130.0, y(1), speed=0.0))["obstruction.ahead"] is False


def test_emergency_vehicles_ahead_behind_and_towards() -> None:
    call = {"hazard_kind": "emergency", "warning_lights": "emergency_lights"}
    ahead = roles(street(), car("engine", 150.0, y(1), speed=15.0, **call))
    assert (ahead["emergency_vehicle.ahead_responding"], ahead["emergency_vehicle.approaching"]) == (True, False)
    assert ahead["emergency_vehicle.distance"] == pytest.approx(47.7)
    assert roles(street(), car("engine", 50.0, y(1), speed=25.0, **call))["emergency_vehicle.approaching"] is True
    assert roles(street(), car("engine", 50.0, y(1), speed=5.0, **call))["emergency_vehicle.approaching"] is False
    assert roles(street(), car("engine", 180.0, 1.75, BACK, 20.0, **call))["emergency_vehicle.approaching"] is True
    patrol = roles(street(), car("patrol", 150.0, y(1), hazard_kind="emergency"))
    assert (patrol["emergency_vehicle.present"], patrol["emergency_vehicle.ahead_responding"]) == (True, False)


def test_oncoming_traffic_and_room_to_pass_on_the_left() -> None:
    rider = car("rider", 125.0, -3.0, speed=4.0, kind="bicycle")
    passing = {"passes": "rider", "passing_side": "left"}
    far = roles(street(), rider, car("oncoming", 160.0, 1.75, BACK, 15.0), speed=12.0, **passing)
    assert far["oncoming.meeting"] is True
    assert far["oncoming.distance"] == pytest.approx(160.0 - 2.3 - 100.0)
    assert far["oncoming.clear_for_passing"] is False
    assert far["oncoming.within_100_ft"] is True
    alone = roles(street(), rider, speed=12.0, **passing)
    assert "oncoming.clear_for_passing" not in alone  # 200 m of sight do not show that nobody comes while it lasts
    assert "oncoming.clear_for_passing" not in roles(street(), rider)


def test_people_on_the_roadway() -> None:
    assert roles(street(), car("p", 130.0, -1.0, 0.0, 0.0, "pedestrian"))["pedestrian.on_roadway"] is True
    assert roles(street(), car("p", 130.0, -5.5, math.pi / 2, 1.5, "pedestrian"))["pedestrian.on_roadway"] is True
    standing = roles(street(), car("p", 130.0, -5.5, math.pi / 2, 0.0, "pedestrian"))
    assert (standing["pedestrian.on_roadway"], standing["pedestrian.near_roadway"]) == (False, True)
    assert roles(street(), car("p", 130.0, -5.5, -math.pi / 2, 1.5, "pedestrian"))["pedestrian.on_roadway"] is False
    assert roles(street(), car("p", 80.0, -1.0, 0.0, 0.0, "pedestrian"))["pedestrian.on_roadway"] is False


def test_animals_and_what_is_there_at_all() -> None:
    facts = roles(street(), car("horse", 130.0, -1.0, 0.0, 1.0, "animal"), car("bike", 50.0, 1.0, BACK, 5.0, "motorcycle"))
    assert (facts["animal.ahead"], facts["motorcycle.present"], facts["bicycle.present"]) == (True, True, False)


def test_care_is_owed_to_who_is_in_the_way() -> None:
    found = street()
    free = roles(found)
    assert free["plan.lacks_due_care"] is False
    assert found.first().measures["plan.lacks_due_care"] == {"sight_distance": 120.0}
    near = roles(found, car("p", 108.0, -1.0, 0.0, 0.0, "pedestrian"))
    assert near["plan.lacks_due_care"] is True
    assert found.first().measures["plan.lacks_due_care"]["sight_distance"] == pytest.approx(7.75)
    assert roles(found, car("p", 108.0, -1.0, 0.0, 0.0, "pedestrian"), speed=3.0)["plan.lacks_due_care"] is False
    undecided = Street(road(), ("main.e.1",), interpretation="rss")
    assert "plan.lacks_due_care" not in roles(undecided)


def test_without_a_list_of_road_users_the_eye_s_word_on_them_stands_alone() -> None:
    found = street()
    found.eye |= {"lead.present": True, "pedestrian.on_roadway": False}
    found.see(100.0, silent=frozenset(("tracks",)))
    stretch = found.first()
    assert told(stretch, "lead.present") is True
    assert told(stretch, "pedestrian.on_roadway") is False
    assert told(stretch, "bicycle.ahead") is None


def test_what_the_eye_reports_besides_the_list_binds_too() -> None:
    found = street()
    found.eye["pedestrian.on_roadway"] = True
    assert roles(found)["pedestrian.on_roadway"] is True
    found.eye["pedestrian.on_roadway"] = False
    assert roles(found, car("p", 130.0, -1.0, 0.0, 0.0, "pedestrian"))["pedestrian.on_roadway"] is True
