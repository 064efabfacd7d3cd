"""Another route when a change of lane is missed."""

from regdb_runtime.observation import Footprint
from regdb_runtime.planner import Planner
from regdb_runtime.strategy.reroute import reroute
from strategy_scenes import car, crossing, ego, law, route, seen


def test_a_missed_left_turn_goes_straight_on():
    road = crossing()
    way = route(road, "left", lane="first.e.2")
    found = reroute(road, "first.e.1", way)
    assert found.lanes[0] == "first.e.1"
    assert found.lanes[1] in road.lanes["first.e.1"].successors
    assert found.lanes[-1] != way.goal


def test_the_same_goal_is_kept_where_another_way_leads_there():
    road = crossing()
    way = route(road, "straight")
    assert reroute(road, "first.e.2", way).goal == way.goal


def test_the_planner_takes_it_when_the_line_is_near_and_the_other_lane_taken():
    road = crossing()
    planner = Planner(law(), road, route(road, "left", lane="first.e.2"), Footprint())
    beside = tuple(car(f"beside_{number}", -20.0 + 8.0 * number, 6.0, lane=2) for number in range(3))
    decision = planner.step(seen(ego(-25.0, 6.0), *beside, light="green", road_map=road))
    assert "rerouted" in decision.events
    assert decision.flag == ""
    assert decision.state.startswith("intersection_handling.")
