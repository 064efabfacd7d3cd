"""Roles at junctions: who crosses, who comes towards the vehicle, who is in the way of a turn, whether the exit is free, who walks there."""

import math

import pytest
from regdb_runtime.observation import Indication, Track
from regdb_runtime.scenes.crossing import Crossings
from regdb_runtime.scenes.settings import SensorRanges
from regdb_runtime.scenes.stretches import Scenes
from regdb_runtime.scenes.tellers import LIGHT_FACTS, TRACK_FACTS, UNTOLD
from small_worlds import APPROACH, LEFT, LIGHT, RIGHT, STOP, Street, car, cross, told, worst

NORTH, SOUTH, WEST = math.pi / 2, -math.pi / 2, math.pi
RED, GREEN = {LIGHT: (Indication("red"),)}, {LIGHT: (Indication("green"),)}
WAYS = {
    "right": ("west.e.1", "x.e.right", "south.s.1"),
    "straight": ("west.e.1", "x.e.straight.1", "east.e.1"),
    "left": ("west.e.1", "x.e.left", "north.n.1"),
}
NEXT = {"right": RIGHT, "straight": APPROACH, "left": LEFT}


def roles(turn: str, *tracks: Track, front: float = 194.0, speed: float = 0.0, control: str = "signal", lights: object = RED) -> dict[str, object]:
    street = Street(cross(control), WAYS[turn])
    street.see(front, speed, tracks, lights=lights)  # type: ignore[arg-type]
    return dict(street.first(STOP, NEXT[turn]).roles)


def test_ways_that_meet_a_right_turn_and_one_straight_on() -> None:
    road_map = Street(cross(), WAYS["right"]).road_map
    right = {(way.lane, way.comes_from) for way in Crossings(road_map, ("x.e.right",)).ways}
    assert right == {("x.s.straight.1", "cross"), ("x.w.left", "oncoming")}
    straight = {(way.lane, way.comes_from) for way in Crossings(road_map, ("x.e.straight.1",)).ways}
    assert straight == {
        ("x.s.straight.1", "cross"), ("x.n.straight.1", "cross"), ("x.n.left", "cross"), ("x.s.left", "cross"), ("x.n.right", "cross"),
        ("x.w.left", "oncoming"),
    }  # fmt: skip


@pytest.mark.parametrize(
    ("y", "speed", "hazard"),
    # a car from the left meets the right turn; RSS: 2 s of response with 3.5 m/s2, then braking at 4 m/s2; at 13 m/s that is 83 m
    [(40.0, 13.0, True), (70.0, 13.0, True), (110.0, 13.0, False), (14.0, 0.0, False), (30.0, 3.0, False), (-30.0, 13.0, False)],
)
def test_cross_traffic(y: float, speed: float, hazard: bool) -> None:
    facts = roles("right", car("crossing", -1.75, y, SOUTH, speed))
    assert facts["cross_traffic.hazard"] is hazard
    assert facts["movement.hazard"] is hazard


def test_traffic_on_the_far_side_does_not_meet_a_right_turn() -> None:
    facts = roles("right", car("northbound", 1.75, -30.0, NORTH, 13.0))
    assert facts["cross_traffic.hazard"] is False
    assert facts["cross_traffic.in_intersection"] is False


def test_who_is_in_the_intersection() -> None:
    facts = roles("straight", car("crossing", 1.75, -3.0, NORTH, 5.0))
    assert facts["cross_traffic.in_intersection"] is True
    assert roles("straight", car("gone", 1.75, 14.0, NORTH, 5.0))["cross_traffic.in_intersection"] is False
    assert roles("straight", car("waits", 1.75, -14.0, NORTH, 0.0))["cross_traffic.in_intersection"] is False


@pytest.mark.parametrize(("x", "speed", "hazard"), [(50.0, 13.0, True), (110.0, 10.0, False), (14.0, 0.0, False)])
def test_oncoming_traffic_and_a_left_turn(x: float, speed: float, hazard: bool) -> None:
    facts = roles("left", car("oncoming", x, 1.75, WEST, speed), lights=GREEN)
    assert facts["oncoming.hazard"] is hazard
    assert roles("straight", car("oncoming", x, 1.75, WEST, speed), lights=GREEN)["cross_traffic.hazard"] is False


def test_an_oncoming_vehicle_that_turns_across() -> None:
    turning = car("turning", 0.5, -1.0, WEST + 0.6, 4.0)
    assert roles("straight", turning, lights=GREEN)["oncoming.turning_across"] is True
    assert roles("straight", car("straight_on", 0.5, 1.75, WEST, 8.0), lights=GREEN)["oncoming.turning_across"] is False


def test_under_green_who_has_red_before_his_line_is_held() -> None:
    slowing = car("slowing", 1.75, -30.0, NORTH, 8.0)
    assert roles("straight", slowing, lights=GREEN)["movement.hazard"] is False
    assert roles("straight", slowing, lights=RED)["movement.hazard"] is True
    assert roles("straight", car("runs", 1.75, -9.0, NORTH, 8.0), lights=GREEN)["movement.hazard"] is True


def test_who_could_not_stop_any_more_is_not_held() -> None:
    assert roles("straight", car("runs", 1.75, -30.0, NORTH, 14.0), lights=GREEN)["movement.hazard"] is True


def test_a_stop_sign_holds_cross_traffic_too() -> None:
    arms = {"south": {"control": "stop"}, "north": {"control": "stop"}}
    main = Street(cross("none", arms=arms), WAYS["left"])
    main.see(194.0, 3.0, [car("slowing", -1.75, 35.0, SOUTH, 8.0)])
    assert main.first(APPROACH, LEFT).roles["movement.hazard"] is False
    main.see(194.0, 3.0, [car("slowing", -1.75, 14.0, SOUTH, 8.0)])
    assert main.first(APPROACH, LEFT).roles["movement.hazard"] is True


def test_a_green_arrow_protects_the_left_turn() -> None:
    street = Street(cross(arms={"west": {"arrows": ("left",)}}), WAYS["left"])
    arrow = {"x.e.left.light": (Indication("green", "left_arrow"),), LIGHT: (Indication("red"),)}
    street.see(194.0, 3.0, [car("oncoming", 40.0, 1.75, WEST, 8.0)], lights=arrow)
    roles_now = street.first(APPROACH, LEFT).roles
    assert (roles_now["signal.shape"], roles_now["oncoming.hazard"], roles_now["movement.hazard"]) == ("arrow", False, False)
    street.see(194.0, 3.0, [car("oncoming", 20.0, 1.75, WEST, 12.0)], lights=arrow)
    assert street.first(APPROACH, LEFT).roles["oncoming.hazard"] is True


@pytest.mark.parametrize(("x", "speed", "hazard"), [(-17.0, 4.0, True), (-25.0, 6.0, True), (-60.0, 2.0, False), (-12.0, 4.0, False)])
def test_a_bicycle_beside_a_right_turn(x: float, speed: float, hazard: bool) -> None:
    rider = car("rider", x, -4.2, speed=speed, kind="bicycle")
    assert roles("right", rider, lights=GREEN)["movement.hazard"] is hazard
    assert roles("straight", rider, lights=GREEN)["movement.hazard"] is False


def test_a_blocked_exit() -> None:
    queue = car("queue", 14.0, -1.75, speed=0.0)
    assert roles("straight", queue, lights=GREEN)["intersection.exit_blocked"] is True
    assert roles("straight", car("moving", 14.0, -1.75, speed=8.0), lights=GREEN)["intersection.exit_blocked"] is False
    assert roles("straight", car("room", 21.0, -1.75, speed=0.0), lights=GREEN)["intersection.exit_blocked"] is False
    assert roles("right", queue, lights=GREEN)["intersection.exit_blocked"] is False


def test_nobody_is_told_absent_where_he_could_not_be_seen() -> None:
    street = Street(cross("stop"), WAYS["straight"])
    street.scenes = Scenes(street.road_map, street.scenes.database, street.scenes.footprint, ranges=SensorRanges(vehicles=40.0, pedestrians=20.0))
    street.history = street.scenes.history()
    street.see(194.0, 0.0)
    stretch = street.first(STOP, APPROACH)
    assert told(stretch, "cross_traffic.hazard") is None  # a car at the limit needs 100 m
    assert told(stretch, "pedestrian.in_crosswalk") is None  # the far crosswalk is 26 m away
    assert told(stretch, "cross_traffic.in_intersection") is False
    assert stretch.view.judge(stretch.prepared, _plan(stretch.roles)).verdict == "unknown"


def _plan(roles_of: object) -> object:
    from regdb.situation import Plan

    return Plan(STOP, APPROACH, {**roles_of, "plan.speed": 3.0, "plan.enters_intersection": True})  # type: ignore[dict-item]


WALKS = {"near": (-13.0, 0.0), "south": (-2.0, -13.0), "far": (13.0, 0.0), "north": (2.0, 13.0)}


@pytest.mark.parametrize(("turn", "met"), [("right", {"near", "south"}), ("straight", {"near", "far"}), ("left", {"near", "north"})])
def test_people_in_the_crosswalks_that_the_path_crosses(turn: str, met: set[str]) -> None:
    for name, (x, y) in WALKS.items():
        walker = car("p", x, y, NORTH, 1.2, "pedestrian")
        assert roles(turn, walker, lights=GREEN)["pedestrian.in_crosswalk"] is (name in met), name


def test_somebody_about_to_cross() -> None:
    south = roles("right", car("p", 6.0, -13.0, WEST, 1.2, "pedestrian"), lights=GREEN)
    assert south["pedestrian.in_crosswalk"] is False  # beyond the kerb at 3.5 m by 2.5 m
    near = roles("right", car("p", 4.5, -13.0, WEST, 1.2, "pedestrian"), lights=GREEN)
    assert near["pedestrian.in_crosswalk"] is True
    assert roles("right", car("p", 4.5, -13.0, 0.0, 1.2, "pedestrian"), lights=GREEN)["pedestrian.in_crosswalk"] is False
    assert roles("right", car("p", 4.5, -13.0, WEST, 0.0, "pedestrian"), lights=GREEN)["pedestrian.in_crosswalk"] is False


def test_where_a_plan_is_held_to_enter_the_crosswalk() -> None:
    street = Street(cross(), WAYS["right"])
    street.see(190.0, 2.0, [car("p", -2.0, -13.0, WEST, 1.2, "pedestrian")], lights=GREEN)
    far = street.first(APPROACH, RIGHT).crosswalk
    assert far == pytest.approx(214.6, abs=0.3)
    street.see(190.0, 2.0, [car("p", -13.0, 0.0, NORTH, 1.2, "pedestrian")], lights=GREEN)
    assert street.first(APPROACH, RIGHT).crosswalk == pytest.approx(196.0, abs=0.1)
    street.see(190.0, 2.0, lights=GREEN)
    assert street.first(APPROACH, RIGHT).crosswalk == pytest.approx(196.0, abs=0.1)
    street.see(197.0, 2.0, lights=GREEN)
    assert street.first(APPROACH, RIGHT).crosswalk == pytest.approx(197.1, abs=0.01)


def test_another_vehicle_that_stands_before_the_crosswalk_for_somebody() -> None:
    street = Street(cross(roads={"forward": 2, "backward": 2}), ("west.e.1", "x.e.straight.1", "east.e.1"))
    stands = car("stands", -17.5, -1.75, speed=0.0)
    walker = car("p", -13.0, 0.0, SOUTH, 1.2, "pedestrian")
    street.see(180.0, 8.0, [stands, walker], lights=GREEN)
    assert street.first(APPROACH, APPROACH).roles["vehicle_stopped_at_crosswalk"] is True
    street.see(180.0, 8.0, [stands], lights=GREEN)
    assert street.first(APPROACH, APPROACH).roles["vehicle_stopped_at_crosswalk"] is False


def test_care_before_a_crosswalk_in_use() -> None:
    walker = car("p", -13.0, 0.0, NORTH, 1.2, "pedestrian")
    assert roles("straight", walker, front=180.0, speed=15.0, lights=GREEN)["plan.lacks_due_care"] is True
    assert roles("straight", walker, front=180.0, speed=5.0, lights=GREEN)["plan.lacks_due_care"] is False


def test_a_right_turn_on_red_from_stop_to_release() -> None:
    street = Street(cross(), WAYS["right"])
    street.drive(140.0, 193.0, 8.0, lights=RED, signal="right")
    enters = {"speed": 3.0, "enters_intersection": True, "enters_crosswalk": True, "turn_purpose": "intersection"}
    assert worst(street.stretches(APPROACH, RIGHT), APPROACH, RIGHT, **enters) == "illegal"  # no stop yet
    street.see(194.2, 0.0, [car("crossing", -1.75, 40.0, SOUTH, 13.0)], lights=RED, signal="right")
    assert worst(street.stretches(STOP, RIGHT), STOP, RIGHT, **enters) == "illegal"  # cross traffic
    street.see(194.2, 0.0, [car("p", -2.0, -13.0, WEST, 1.2, "pedestrian")], lights=RED, signal="right")
    assert worst(street.stretches(STOP, RIGHT), STOP, RIGHT, **enters) == "illegal"  # somebody in the far crosswalk
    street.see(194.2, 0.0, lights=RED, signal="right")
    assert worst(street.stretches(STOP, RIGHT), STOP, RIGHT, **enters) == "legal"
    waiting = {"speed": 0.0, "enters_intersection": False, "enters_crosswalk": False}
    assert worst(street.stretches(STOP, STOP)[:1], STOP, STOP, **waiting) == "legal"


def test_every_role_is_told_somewhere() -> None:
    """What is claimed for tracked road users is really filled, in one small world or another."""
    street = Street(cross(), WAYS["right"])
    street.see(190.0, 2.0, [car("lead", -4.0, -1.75, turn_signal="off"), car("rider", -17.0, -4.2, kind="bicycle")], lights=RED)
    found = set(street.first(APPROACH, RIGHT).roles)
    street.see(100.0, 12.0, [car("rider", -80.0, -3.0, speed=4.0, kind="bicycle"), car("b", -20.0, 1.75, WEST, 5.0)])
    found |= set(street.first(passes="rider", passing_side="left").roles)
    call = {"hazard_kind": "emergency", "warning_lights": "emergency_lights"}
    street.see(100.0, 12.0, [car("engine", -60.0, -1.75, **call)])
    found |= set(street.first().roles)
    assert found >= TRACK_FACTS - {"oncoming.clear_for_passing"}
    assert found >= LIGHT_FACTS
    assert not found & UNTOLD.keys()


@pytest.mark.parametrize(
    ("reach", "front", "expected"),
    # the room beyond the exit ends at 226 m; to stop from 15.6 m/s before the line at 195 m takes 69 m
    [(60.0, 80.0, None), (120.0, 80.0, False), (60.0, 150.0, None), (120.0, 100.0, False), (60.0, 185.0, False)],
)
def test_what_will_be_seen_in_time_to_stop_need_not_be_seen_yet(reach: float, front: float, expected: bool | None) -> None:
    street = Street(cross(roads={"limit": 15.6464}), WAYS["straight"])
    street.scenes = Scenes(street.road_map, street.scenes.database, street.scenes.footprint, ranges=SensorRanges(reach, reach, reach))
    street.history = street.scenes.history()
    street.see(front, 12.0, lights=GREEN)
    stretch = next(item for item in street.stretches(APPROACH, APPROACH) if item.stage == "approach")
    assert told(stretch, "intersection.exit_blocked") is expected
    assert told(stretch, "pedestrian.in_crosswalk") is expected


def test_who_has_entered_is_let_out_again() -> None:
    street = Street(cross(), WAYS["right"])
    behind = [car("crossing", -1.75, 40.0, SOUTH, 10.0)]
    street.see(194.0, 0.0, behind, lights=RED)
    assert street.first(STOP, RIGHT).roles["movement.hazard"] is True
    street.see(206.0, 4.0, behind, lights=RED)
    assert street.first(RIGHT, RIGHT).roles["movement.hazard"] is False
    street.see(206.0, 4.0, [car("crossing", -1.75, 16.0, SOUTH, 12.0)], lights=RED)
    assert street.first(RIGHT, RIGHT).roles["movement.hazard"] is True
