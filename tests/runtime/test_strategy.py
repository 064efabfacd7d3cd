"""What the strategist offers and refuses, and with which goal."""

from dataclasses import replace

import pytest
from regdb_runtime.observation import EgoState, Indication
from regdb_runtime.strategy.machine import Step
from regdb_runtime.strategy.memory import Memory, Pass
from regdb_runtime.strategy.paths import OffRoad
from regdb_runtime.strategy.stop_line import StopMemory
from strategy_scenes import CLOCK, WEST, car, center, crossing, cyclist, ego, offers, route, seen, straight, strategist

LF, IH, OT = "lane_following", "intersection_handling", "overtaking"
STRAIGHT = f"{LF}.go_straight"


@pytest.fixture(scope="module")
def signals():
    return crossing()


@pytest.fixture(scope="module")
def road():
    return straight()


def offered(plans, observation, state=STRAIGHT, **memory):
    return {name for name, refused in offers(plans, observation, state, **memory).items() if not refused}


def build(plans, observation, following, state=STRAIGHT, current=None, **memory):
    picture = plans.picture(observation, Memory(state, **memory), 15.6464)
    return plans.build(picture, Step(current or state, following))


class TestLaneFollowing:
    def test_an_empty_road_leaves_going_straight(self, road):
        assert offered(strategist(road), seen(ego(50.0))) == {STRAIGHT}

    def test_a_slower_car_near_ahead_is_followed(self, road):
        plans = strategist(road)
        found = offers(plans, seen(ego(50.0), car("slow", 90.0, 13.0)))
        assert found[STRAIGHT] == "lead:slow"
        assert found[f"{LF}.car_following"] == ""
        goal = build(plans, seen(ego(50.0), car("slow", 90.0, 13.0)), f"{LF}.car_following").goal
        assert goal.follow.track == "slow"
        assert goal.follow.rear_station == pytest.approx(90.0 - 2.3, abs=0.01)

    def test_a_car_far_ahead_or_in_the_next_lane_is_not(self, road):
        plans = strategist(road)
        assert offers(plans, seen(ego(50.0), car("far", 250.0, 14.0)))[STRAIGHT] == ""
        assert offers(plans, seen(ego(50.0), car("beside", 80.0, 10.0, lane=2)))[STRAIGHT] == ""

    def test_what_is_followed_is_followed_a_little_farther(self, road):
        plans = strategist(road)
        there = seen(ego(50.0), car("lead", 150.0, 15.0))
        assert offers(plans, there)[STRAIGHT] == ""
        assert offers(plans, there, f"{LF}.car_following", followed="lead")[STRAIGHT] == "lead:lead"

    def test_a_cyclist_who_would_be_passed_too_near_is_in_the_way(self, road):
        assert offers(strategist(road), seen(ego(50.0), cyclist(100.0)))[STRAIGHT] == "lead:cyclist"

    def test_a_vehicle_on_no_lane_of_its_route_is_off_road(self, road):
        with pytest.raises(OffRoad, match="on no lane of its route"):
            strategist(road).picture(seen(ego(50.0, y=60.0)), Memory(STRAIGHT), 15.0)


class TestLaneChangesForTheRoute:
    def test_a_left_turn_needs_the_left_lane(self, signals):
        plans = strategist(signals, "left", lane="first.e.2")
        found = offers(plans, seen(ego(-180.0)))
        assert found[f"{LF}.prepare_lane_change_left"] == ""
        assert found[f"{LF}.prepare_lane_change_right"] == "route"
        prepared = build(plans, seen(ego(-180.0)), f"{LF}.prepare_lane_change_left")
        assert prepared.turn_signal == "left"
        assert dict(prepared.biases)["lane_needed"] < 0

    def test_the_need_grows_towards_the_junction(self, signals):
        plans = strategist(signals, "left", lane="first.e.2")
        needs = [dict(build(plans, seen(ego(x)), f"{LF}.prepare_lane_change_left").biases)["lane_needed"] for x in (-240.0, -180.0, -120.0)]
        assert needs == sorted(needs, reverse=True)

    def test_the_change_runs_along_the_target_lane(self, signals):
        plans = strategist(signals, "left", lane="first.e.2")
        change = build(plans, seen(ego(-180.0)), f"{LF}.lane_change_left", f"{LF}.prepare_lane_change_left")
        assert (change.lane, change.target_lane, change.turn_signal) == (WEST, "first.e.2", "left")
        assert change.lane_path.path.project([(-180.0, center(1))])[1][0] == pytest.approx(-3.5, abs=0.01)

    def test_nobody_changes_into_somebody(self, signals):
        plans = strategist(signals, "left", lane="first.e.2")
        beside = seen(ego(-180.0), car("beside", -178.0, 15.0, lane=2))
        change = build(plans, beside, f"{LF}.lane_change_left", f"{LF}.prepare_lane_change_left")
        assert change.refused == "gap:beside"

    def test_a_change_under_way_goes_on_until_the_lane_is_reached(self, signals):
        plans = strategist(signals, "left", lane="first.e.2")
        state = f"{LF}.lane_change_left"
        half = seen(ego(-180.0, y=center(1) + 1.0))
        assert offers(plans, half, state, target_lane="first.e.2")[state] == ""
        there = seen(ego(-150.0, y=center(2) - 0.2))
        assert offers(plans, there, state, target_lane="first.e.2")[state] == "route"
        assert STRAIGHT in offered(plans, there, state, target_lane="first.e.2")

    def test_giving_up_costs(self, signals):
        plans = strategist(signals, "left", lane="first.e.2")
        picture = plans.picture(seen(ego(-180.0, y=center(1) + 1.0)), Memory(f"{LF}.lane_change_left", target_lane="first.e.2"), 15.0)
        biases = {item.next: dict(item.biases) for item in plans.maneuvers(picture) if not item.refused}
        assert "abandon" in biases[STRAIGHT]
        assert "abandon" not in biases[f"{LF}.lane_change_left"]


class TestIntersections:
    def test_handling_begins_near_the_junction_and_ends_lane_following(self, signals):
        plans = strategist(signals, "straight")
        assert offers(plans, seen(ego(-200.0)))[f"{IH}.go_straight"] == "no_junction"
        near = offers(plans, seen(ego(-60.0, 10.0)))
        assert near[f"{IH}.go_straight"] == ""
        assert near[STRAIGHT] == "junction"

    def test_handling_does_not_flicker_at_its_border(self, signals):
        plans = strategist(signals, "straight")
        at = seen(ego(-95.0, 10.0))
        assert offers(plans, at)[f"{IH}.go_straight"] == "no_junction"
        assert offers(plans, at, f"{IH}.go_straight", handling=True)[f"{IH}.go_straight"] == ""

    def test_only_the_routes_turn_is_offered_and_only_near_the_line(self, signals):
        plans = strategist(signals, "right")
        assert offers(plans, seen(ego(-58.0, 8.0)))[f"{IH}.turn_right"] == "far"
        near = offers(plans, seen(ego(-30.0, 8.0)))
        assert near[f"{IH}.turn_right"] == ""
        assert near[f"{IH}.turn_left"] == "route"
        assert near[f"{IH}.go_straight"] == "route"

    def test_crossing_commits_only_where_stopping_must_be_decided(self, signals):
        plans = strategist(signals, "straight")
        assert not build(plans, seen(ego(-60.0, 8.0)), f"{IH}.go_straight").commits
        assert build(plans, seen(ego(-30.0, 8.0)), f"{IH}.go_straight").commits

    def test_turning_signals_and_commits(self, signals):
        turn = build(strategist(signals, "right"), seen(ego(-30.0, 8.0)), f"{IH}.turn_right")
        assert (turn.turn_signal, turn.commits, turn.goal.stop) == ("right", True, None)

    def test_stopping_has_its_point_at_the_line(self, signals):
        stop = build(strategist(signals, "straight"), seen(ego(-40.0, 8.0)), f"{IH}.stop")
        assert stop.goal.stop.station == stop.junction.stop_station
        assert not stop.commits

    def test_within_the_junction_a_stop_is_as_soon_as_is_gentle(self, signals):
        plans = strategist(signals, "right")
        inside = build(plans, seen(ego(2.0, 4.0)), f"{IH}.stop", f"{IH}.turn_right", handling=True)
        assert not inside.refused
        assert 2.0 < inside.goal.stop.station - (302.0 + 3.85) < 5.0
        assert offers(plans, seen(ego(2.0, 4.0)), f"{IH}.turn_right", handling=True)[f"{IH}.turn_right"] == ""

    def test_between_line_and_entrance_the_stop_is_at_the_entrance(self, signals):
        stop = build(strategist(signals, "right"), seen(ego(-8.0, 0.5)), f"{IH}.stop", f"{IH}.turn_right", handling=True)
        assert stop.goal.stop.station == stop.junction.entrance

    def test_a_car_that_stands_before_the_line_is_waited_behind(self, signals):
        plans = strategist(signals, "right")
        queue = seen(ego(-28.0, 6.0), car("first", -12.0, 0.0))
        found = offers(plans, queue)
        assert found[f"{IH}.stop"] == "lead:first"
        assert found[f"{IH}.turn_right"] == "lead:first"
        assert found[f"{IH}.car_following"] == ""
        assert not build(plans, queue, f"{IH}.car_following").commits

    def test_a_car_that_goes_on_does_not_take_the_decision_away(self, signals):
        plans = strategist(signals, "straight")
        moving = seen(ego(-30.0, 8.0), car("first", -10.0, 8.0))
        assert build(plans, moving, f"{IH}.car_following").commits
        assert offers(plans, moving)[f"{IH}.stop"] == ""

    def test_a_held_vehicle_first_checks(self, signals):
        plans = strategist(signals, "right")
        standing = seen(ego(-10.0, 0.0), time=5.0)
        held = StopMemory("crossing:right", "held", 4.9)
        assert offers(plans, standing, f"{IH}.stop", stop=held, handling=True)[f"{IH}.turn_right"] == "check"
        checked = replace(held, phase="check")
        assert offers(plans, standing, f"{IH}.stop", stop=checked, handling=True)[f"{IH}.turn_right"] == ""

    def test_yellow_stops_whoever_can_and_lets_go_on_who_cannot(self, signals):
        plans = strategist(signals, "straight")
        far = seen(ego(-45.0, 10.0), light="yellow", road_map=signals)
        assert offers(plans, far)[f"{IH}.go_straight"] == "yellow"
        near = seen(ego(-16.0, 10.0), light="yellow", road_map=signals)
        assert offers(plans, near)[f"{IH}.go_straight"] == ""

    def test_the_queued_car_gets_there_by_micro_steps(self, signals):
        plans = strategist(signals, "straight")
        picture = plans.picture(seen(ego(-40.0, 6.0), car("first", -12.0, 0.0)), Memory(f"{LF}.car_following"), 15.0)
        found = next(item for item in plans.maneuvers(picture) if item.next == f"{IH}.car_following")
        assert (*found.via, found.next) == (STRAIGHT, f"{IH}.go_straight", f"{IH}.car_following")
        assert found.current == f"{IH}.go_straight"

    def test_cleared_junctions_are_left_for_lane_following(self, signals):
        plans = strategist(signals, "straight")
        state = f"{IH}.go_straight"
        beyond = seen(EgoState(40.0, center(1), 0.0, 12.0))
        assert offered(plans, beyond, state, handling=True) == {STRAIGHT}

    def test_curves_are_taken_slowly(self, signals):
        caps = build(strategist(signals, "right"), seen(ego(-100.0)), STRAIGHT).goal.caps
        assert {cap.rule for cap in caps} == {"limit:curve"}
        assert 3.0 < min(cap.speed for cap in caps) < 6.0


class TestOvertaking:
    def test_a_cyclist_is_passed_within_the_lane_or_by_the_next_one(self, road):
        found = offers(strategist(road), seen(ego(50.0), cyclist(100.0)))
        assert found[f"{OT}.go_straight"] == ""
        assert found[f"{OT}.prepare_lane_change_left"] == ""

    def test_offsets_leave_the_clearances_aimed_at(self, road):
        plans = strategist(road)
        goal = build(plans, seen(ego(50.0), cyclist(100.0)), f"{OT}.go_straight").goal
        left = -1.75 + 0.1 + 0.6
        assert goal.offsets == pytest.approx(sorted([*(left + 0.9 + wanted + 0.05 for wanted in plans.settings.pass_clearances), 1.75 - 0.9 - 0.02]))
        assert goal.follow is None

    def test_a_single_lane_leaves_no_lane_to_change_to(self):
        plans = strategist(straight(1))
        here = ego(50.0, lanes=1)
        found = offers(plans, seen(here, cyclist(100.0, lanes=1)))
        assert found[f"{OT}.prepare_lane_change_left"] == "no_lane"
        assert found[f"{OT}.go_straight"] == ""

    def test_nobody_passes_what_moves_on_the_half_of_oncoming_traffic(self):
        plans = strategist(straight(1))
        slow = replace(car("slow", 100.0, 5.0), y=center(1, lanes=1))
        assert offers(plans, seen(ego(50.0, lanes=1), slow))[f"{OT}.go_straight"] == "no_room_beside"
        rider = build(plans, seen(ego(50.0, lanes=1), cyclist(100.0, lanes=1)), f"{OT}.go_straight").goal
        assert max(rider.offsets) == pytest.approx(1.75 - 0.9 - 0.02)
        standing = replace(slow, speed=0.0)
        assert max(build(plans, seen(ego(50.0, lanes=1), standing), f"{OT}.go_straight").goal.offsets) > 2.0

    def test_nobody_overtakes_what_is_about_as_fast(self, road):
        assert offers(strategist(road), seen(ego(50.0), car("lead", 90.0, 13.0)))[f"{OT}.go_straight"] == "nothing_slow"

    def test_nobody_overtakes_before_a_junction_that_comes_too_soon(self, signals):
        plans = strategist(signals, "straight")
        assert offers(plans, seen(ego(-140.0), cyclist(-70.0)))[f"{OT}.go_straight"] == "no_room"
        assert offers(plans, seen(ego(-290.0), cyclist(-240.0)))[f"{OT}.go_straight"] == ""

    def test_overtaking_begins_from_lane_following_alone(self, road):
        assert offers(strategist(road), seen(ego(50.0), cyclist(100.0)), f"{IH}.go_straight")[f"{OT}.go_straight"] == "not_from_here"

    def test_alongside_there_is_no_way_back_behind(self, road):
        beside = seen(ego(98.0, y=center(1) + 0.8), cyclist(100.0))
        found = offers(strategist(road), beside, f"{OT}.go_straight", passing=Pass("cyclist", "left", "in_lane", WEST))
        assert found[STRAIGHT] == "alongside"
        assert found[f"{OT}.go_straight"] == ""

    def test_a_finished_pass_goes_back_to_lane_following(self, road):
        past = seen(ego(125.0, y=center(1) + 0.8), cyclist(100.0))
        found = offers(strategist(road), past, f"{OT}.go_straight", passing=Pass("cyclist", "left", "in_lane", WEST))
        assert found[f"{OT}.go_straight"] == "passed"
        assert found[STRAIGHT] == ""

    def test_a_pass_by_the_next_lane_returns_when_it_is_done(self, road):
        plans = strategist(road)
        way = {"passing": Pass("cyclist", "left", "by_lane", WEST)}
        beside = offers(plans, seen(ego(98.0, lane=2), cyclist(100.0)), f"{OT}.go_straight", **way)
        assert beside[f"{OT}.go_straight"] == ""
        assert beside[f"{OT}.prepare_lane_change_right"] == "alongside"
        done = offers(plans, seen(ego(125.0, lane=2), cyclist(100.0)), f"{OT}.go_straight", **way)
        assert done[f"{OT}.prepare_lane_change_right"] == ""

    def test_passing_beside_says_what_is_passed_on_which_side(self, road):
        passing = build(
            strategist(road), seen(ego(98.0, lane=2), cyclist(100.0)), f"{OT}.go_straight", f"{OT}.go_straight",
            passing=Pass("cyclist", "left", "by_lane", WEST),
        )  # fmt: skip
        assert (passing.passes, passing.passing_side) == ("cyclist", "left")


class TestEmergencyExit:
    def test_the_vehicle_eases_out_before_it_follows_the_lane(self, road):
        plans = strategist(road)
        easing = seen(ego(50.0, 6.0), time=3.5)
        assert offered(plans, easing, "emergency_stop.slow_down", entered=3.0) == {"emergency_stop.slow_down"}
        assert build(plans, easing, "emergency_stop.slow_down", "emergency_stop.slow_down", entered=3.0).goal.cruise_speed == 6.0
        over = seen(ego(50.0, 6.0), time=4.0)
        assert offered(plans, over, "emergency_stop.slow_down", entered=3.0) == {STRAIGHT}


def test_the_picture_is_the_same_for_the_same_observation(road):
    plans = strategist(road)
    observation = seen(ego(50.0), cyclist(100.0), car("b", 120.0, 9.0, lane=2))
    pictures = [plans.picture(observation, Memory(STRAIGHT), 15.0) for _ in range(2)]
    first, second = ([(item.next, item.refused, item.goal, item.biases, item.via) for item in plans.maneuvers(picture)] for picture in pictures)
    assert first == second


def test_lights_are_read_from_the_observation_alone(signals):
    plans = strategist(signals, "straight")
    shown = replace(seen(ego(-45.0, 10.0)), signals={name: (Indication("yellow"),) for name in signals.lights}, clock=CLOCK)
    assert offers(plans, shown)[f"{IH}.go_straight"] == "yellow"
    assert route(signals, "straight").goal.startswith("ahead")
