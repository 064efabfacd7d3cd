"""Facts of history by their definitions: full stops, signals without a break, turn lanes, buses, arrivals."""

from dataclasses import replace

import numpy as np
import pytest
from regdb_runtime.maps.road_map import RoadMap, Zone
from regdb_runtime.observation import Indication
from regdb_runtime.scenes.history import History
from regdb_runtime.scenes.stretches import Scenes
from small_worlds import CAR, LIGHT, NOON, Street, car, cross, road

LINE = 194.8
RED = {LIGHT: (Indication("red"),)}


def corner() -> Street:
    return Street(cross(), ("west.e.1", "x.e.right", "south.s.1"))


def at(street: Street, front: float, speed: float, **seen: object) -> dict[str, object]:
    street.see(front, speed, lights=RED, **seen)  # type: ignore[arg-type]
    return dict(street.history.facts())


def test_a_full_stop_at_the_line_counts_until_the_line_is_crossed() -> None:
    street = corner()
    assert at(street, 190.0, 3.0)["ego.stopped_at_line"] is False
    assert at(street, LINE - 0.5, 0.0)["ego.stopped_at_line"] is True
    assert at(street, LINE - 0.2, 0.8)["ego.stopped_at_line"] is True
    assert at(street, LINE + 1.0, 2.0)["ego.stopped_at_line"] is False


@pytest.mark.parametrize(
    ("front", "speed", "counts"), [(LINE - 0.5, 0.2, False), (LINE - 0.5, 0.05, True), (LINE - 2.9, 0.0, True), (LINE - 6.0, 0.0, False)]
)
def test_only_a_stand_near_the_line_is_a_stop_at_it(front: float, speed: float, counts: bool) -> None:
    assert at(corner(), front, speed)["ego.stopped_at_line"] is counts


def test_a_stop_past_the_line_is_none_and_the_light_still_faces_the_vehicle() -> None:
    street = corner()
    at(street, 190.0, 4.0)
    assert at(street, LINE + 1.0, 0.0)["ego.stopped_at_line"] is False
    assert street.history.past.overran
    assert street.first().stage == "approach"
    at(street, LINE + 1.2, 1.0)
    stretch = street.first()
    assert stretch.stage == "approach"
    assert stretch.line == pytest.approx(LINE + 1.3, abs=0.02)
    assert stretch.roles["signal.color"] == "red"
    at(street, 200.5, 2.0)
    assert street.first().stage == "inside"


def test_who_stopped_at_the_line_and_goes_on_is_past_the_light() -> None:
    street = corner()
    at(street, LINE - 0.5, 0.0)
    at(street, LINE + 0.5, 1.0)
    assert street.first().stage == "inside"
    at(street, LINE + 0.8, 0.0)  # waits for somebody in the crosswalk
    assert street.first().stage == "inside"
    assert "signal.color" not in street.first().roles
    assert street.first().scene.facts["signal.present"] is False


def test_the_next_junction_needs_a_stop_of_its_own() -> None:
    street = corner()
    at(street, LINE - 0.5, 0.0)
    assert street.history.past.stopped
    for front in (200.0, 215.0, 225.0, 240.0):
        at(street, front, 8.0)
    assert street.history.past.line is None
    assert street.history.facts()["ego.stopped_at_line"] is False


def test_signalled_distance_and_time_run_without_a_break() -> None:
    street = corner()
    at(street, 100.0, 10.0)
    street.drive(101.0, 131.0, 10.0, signal="right")
    facts = street.history.facts()
    assert facts["ego.signalled_distance"] == pytest.approx(30.0)
    assert facts["ego.signalled_time"] == pytest.approx(3.0)
    street.see(132.0, 10.0, signal="off")
    assert street.history.facts()["ego.signalled_distance"] == 0.0
    street.see(133.0, 10.0, signal="right")
    street.see(134.0, 10.0, signal="left")
    assert street.history.facts()["ego.signalled_distance"] == 0.0
    street.see(135.0, 10.0, signal="hazard")
    street.see(136.0, 10.0, signal="hazard")
    assert street.history.facts()["ego.signalled_distance"] == 0.0


def test_a_plan_that_goes_on_signalling_will_have_signalled_up_to_the_turn() -> None:
    street = corner()
    street.see(150.0, 10.0, signal="right")
    street.drive(151.0, 160.0, 10.0, signal="right")
    roles = street.first(turn_signal="right").roles
    assert roles["ego.signalled_distance"] == pytest.approx(10.0 + 40.0, abs=0.1)
    assert street.first(turn_signal="off").roles["ego.signalled_distance"] == 0.0
    assert street.first(turn_signal="left").roles["ego.signalled_distance"] == pytest.approx(40.0, abs=0.1)


def test_the_turn_lane() -> None:
    spec = road(facts_of_road={"lane.kind": "two_way_left_turn"})
    street = Street(spec, ("main.e.1",))
    street.drive(20.0, 50.0, 10.0)
    assert street.history.facts()["ego.distance_in_turn_lane"] == pytest.approx(30.0)
    assert street.history.facts()["ego.time_in_turn_lane"] == pytest.approx(3.0)
    plain = Street(road(), ("main.e.1",))
    plain.drive(20.0, 50.0, 10.0)
    assert plain.history.facts()["ego.distance_in_turn_lane"] == 0.0


def test_a_stop_for_the_school_bus_counts_while_its_red_light_flashes() -> None:
    street = Street(road(), ("main.e.1",))
    street.eye |= {"school_bus.ahead": True, "school_bus.red_flashing": True}
    street.see(50.0, 5.0)
    assert street.history.facts()["ego.stopped_for_bus"] is False
    street.see(52.0, 0.0)
    street.see(52.5, 2.0)
    assert street.history.facts()["ego.stopped_for_bus"] is True
    street.eye["school_bus.red_flashing"] = False
    street.see(53.0, 2.0)
    assert street.history.facts()["ego.stopped_for_bus"] is False


def with_rails(street: Street, start: float, end: float) -> Street:
    polygon = np.array([(start, -20.0), (end, -20.0), (end, 20.0), (start, 20.0)])
    road_map: RoadMap = replace(street.road_map, zones=(Zone("rails", "rail", polygon, {"rail.signal_device": True}),))
    street.road_map, street.scenes = road_map, Scenes(road_map, street.scenes.database, CAR)
    street.history = street.scenes.history()
    return street


def test_a_stop_before_the_rails() -> None:
    street = with_rails(Street(road(), ("main.e.1",)), 100.0, 104.0)
    street.see(80.0, 0.0)
    assert street.history.facts()["ego.stopped_at_rails"] is False  # 20 m away is not before the rails
    assert "ego.rail_stop_distance" not in street.history.facts()
    street.see(94.0, 0.0)
    assert street.history.facts()["ego.stopped_at_rails"] is True
    assert street.history.facts()["ego.rail_stop_distance"] == pytest.approx(6.0, abs=0.02)
    street.see(96.0, 2.0)
    assert street.history.facts()["ego.stopped_at_rails"] is True
    street.see(101.0, 3.0)
    assert street.history.facts()["ego.stopped_at_rails"] is False


def test_who_arrived_first() -> None:
    street = Street(cross("all_way_stop"), ("west.e.1", "x.e.straight.1", "east.e.1"))
    away, near = car("other", 1.75, -60.0, np.pi / 2, 8.0), car("other", 1.75, -14.0, np.pi / 2, 0.0)
    street.see(170.0, 8.0, [away])
    street.see(193.0, 2.0, [away])
    assert street.history.facts()["ego.arrived_first"] is True
    street.see(194.5, 0.0, [near], wait=0.5)
    assert street.history.facts()["ego.arrived_first"] is True
    assert street.first().roles["cross_traffic.arrived_together"] is True
    assert street.first().roles["cross_traffic.on_right"] is True
    street.see(194.5, 0.0, [near], wait=5.0)
    assert street.first().roles["cross_traffic.arrived_together"] is True


def test_who_was_there_before() -> None:
    street = Street(cross("all_way_stop"), ("west.e.1", "x.e.straight.1", "east.e.1"))
    near = car("other", -1.75, 14.0, -np.pi / 2, 0.0)
    street.see(160.0, 8.0, [near])
    street.see(193.0, 2.0, [near], wait=4.0)
    assert street.history.facts()["ego.arrived_first"] is False
    assert street.first().roles["cross_traffic.arrived_together"] is False
    street.see(194.5, 0.0, [], wait=4.0)
    assert street.history.facts()["ego.arrived_first"] is True


def test_the_same_observations_give_the_same_past() -> None:
    def driven() -> History:
        street = corner()
        street.drive(150.0, 193.0, 7.0, signal="right")
        street.see(194.0, 0.0, [car("a", 1.75, -30.0, np.pi / 2)])
        return street.history

    assert driven().past == driven().past
    assert NOON.hour == 12
