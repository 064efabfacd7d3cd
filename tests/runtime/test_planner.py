"""The planner in closed loop on plain streets, by the shipped law: the vehicle follows each plan exactly, others drive as scripted."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pytest
from regdb_runtime.drive.decision_text import decision_text
from regdb_runtime.errors import RequestError
from regdb_runtime.geometry import boxes, distance
from regdb_runtime.maps.road_map import RoadMap
from regdb_runtime.maps.route import Route
from regdb_runtime.observation import EgoState, Footprint, Indication, Observation, Track
from regdb_runtime.planner import Planner
from regdb_runtime.strategy.continuation import expected
from strategy_scenes import LENGTH, car, center, crossing, cyclist, ego, law, route, seen, straight

PERIOD = 0.2
FOOTPRINT = Footprint()
LF, IH, OT = "lane_following", "intersection_handling", "overtaking"


@dataclass
class Drive:
    """What was observed and decided, tick by tick."""

    ticks: list[tuple[Observation, Any]]

    @property
    def states(self) -> list[str]:
        """States in the order they were entered."""
        found = [decision.state for _, decision in self.ticks]
        return [state for place, state in enumerate(found) if place == 0 or state != found[place - 1]]

    @property
    def events(self) -> list[str]:
        return [event for _, decision in self.ticks for event in decision.events]

    @property
    def supers(self) -> list[str]:
        names = [state.partition(".")[0] for state in self.states]
        return [name for place, name in enumerate(names) if place == 0 or name != names[place - 1]]

    def speeds(self) -> np.ndarray:
        return np.array([seen.ego.speed for seen, _ in self.ticks])

    def fronts(self) -> np.ndarray:
        return np.array([seen.ego.x + FOOTPRINT.front for seen, _ in self.ticks])

    def clearance(self) -> float:
        """The least distance to anybody."""
        found = [_apart(seen.ego, track) for seen, _ in self.ticks for track in seen.tracks]
        return min(found, default=float("inf"))

    def flags(self) -> set[str]:
        return {decision.flag for _, decision in self.ticks}


def _apart(own: EgoState, track: Track) -> float:
    x, y = own.box_center(FOOTPRINT)
    ours = boxes(np.array([x]), np.array([y]), np.array([own.heading]), FOOTPRINT.length, FOOTPRINT.width)
    theirs = boxes(np.array([track.x]), np.array([track.y]), np.array([track.heading]), track.length, track.width)
    return float(distance(ours, theirs)[0])


def drive(
    road: RoadMap, way: Route, begin: EgoState, seconds: float, tracks: Callable[[float], tuple[Track, ...]] = lambda _: (),
    light: Callable[[float], str] = lambda _: "", planner: Planner | None = None, change: Callable[[Observation], Observation] = lambda it: it,
) -> Drive:  # fmt: skip
    planner = planner or Planner(law(), road, way, FOOTPRINT)
    found, now = Drive([]), begin
    for tick in range(round(seconds / PERIOD)):
        time = round(tick * PERIOD, 3)
        observation = change(seen(now, *tracks(time), time=time, light=light(time), road_map=road))
        decision = planner.step(observation)
        found.ticks.append((observation, decision))
        now = replace(expected(decision.trajectory, PERIOD), turn_signal=decision.turn_signal)
    return found


@pytest.fixture(scope="module")
def road():
    return straight()


@pytest.fixture(scope="module")
def signals():
    return crossing()


LINE = 294.7788694 - LENGTH
"""x of the limit line on the road from the west."""


def test_an_empty_road_is_driven_at_the_limit_and_never_over_it(road):
    found = drive(road, route(road), ego(5.0, 8.0), 12.0)
    assert found.states == [f"{LF}.go_straight"]
    assert found.flags() == {""}
    assert found.speeds().max() <= 35 * 0.44704
    assert found.speeds()[-1] > 35 * 0.44704 - 0.3


def test_a_slower_car_is_followed_without_taking_turns(road):
    found = drive(road, route(road), ego(5.0, 14.0), 40.0, lambda time: (car("lead", 70.0 + 13.0 * time, 13.0),))
    assert len(found.states) <= 3
    assert found.states[-1] == f"{LF}.car_following"
    assert found.speeds()[-20:] == pytest.approx(13.0, abs=0.4)
    assert found.clearance() > 8.0


def test_a_car_that_stops_is_stopped_behind():
    def lead(time):
        speed = max(12.0 - 2.0 * time, 0.0)
        way = 12.0 * min(time, 6.0) - min(time, 6.0) ** 2
        return (replace(car("lead", 60.0 + way, speed, acceleration=-2.0 if speed else 0.0), y=center(1, lanes=1)),)

    road = straight(1)
    found = drive(road, route(road), ego(5.0, 12.0, lanes=1), 16.0, lead)
    assert found.speeds()[-1] < 0.1
    assert found.clearance() > 1.0
    assert "emergency" not in found.events


def test_red_stops_before_the_line_and_green_releases(signals):
    found = drive(signals, route(signals, "straight"), ego(-130.0), 34.0, light=lambda time: "red" if time < 20.0 else "green")
    assert [event for event in found.events if event in ("stopped", "released")] == ["stopped", "released"]
    stood = [(seen, decision) for seen, decision in found.ticks if decision.stop_phase in ("held", "check")]
    fronts = {round(seen.ego.x + FOOTPRINT.front, 2) for seen, decision in stood if seen.ego.speed < 0.05}
    assert all(0.0 <= LINE - front <= 2.0 for front in fronts)
    assert max(fronts) - min(fronts) < 0.1
    assert found.fronts()[-1] > 40.0
    released = next(seen.time for seen, decision in found.ticks if "released" in decision.events)
    assert 20.0 <= released <= 21.0


def test_a_red_that_turns_green_in_time_is_passed_without_a_stop(signals):
    found = drive(signals, route(signals, "straight"), ego(-130.0), 16.0, light=lambda time: "red" if time < 5.0 else "green")
    assert "stopped" not in found.events
    assert found.speeds().min() > 2.0
    assert found.supers == [LF, IH, LF]


def test_green_is_crossed_without_stopping(signals):
    found = drive(signals, route(signals, "straight"), ego(-160.0), 15.0, light=lambda _: "green")
    assert found.states == [f"{LF}.go_straight", f"{IH}.go_straight", f"{LF}.go_straight"]
    assert found.speeds().min() > 14.0


def test_right_on_red_comes_after_a_full_stop_and_a_look(signals):
    found = drive(signals, route(signals, "right"), ego(-110.0), 26.0, light=lambda _: "red")
    phases = list(dict.fromkeys(decision.stop_phase for _, decision in found.ticks if decision.stop_phase))
    assert phases[:2] == ["approach", "held"]
    assert phases[-1] == "released"
    turning = next(seen for seen, decision in found.ticks if decision.state == f"{IH}.turn_right")
    assert turning.ego.speed < 0.1
    assert 0.0 <= LINE - turning.ego.x - FOOTPRINT.front <= 2.0
    assert found.ticks[-1][0].ego.y < -16.0


def _with_sign(seen: Observation) -> Observation:
    return replace(seen, facts={**seen.facts, "sign.no_turn_on_red": True})


def _sign_unseen(seen: Observation) -> Observation:
    facts = {name: value for name, value in seen.facts.items() if name != "sign.no_turn_on_red"}
    return replace(seen, facts=facts, silent=frozenset(("sign.no_turn_on_red",)))


def _red_arrow(seen: Observation) -> Observation:
    return replace(seen, signals={name: (Indication("red", "right_arrow"), Indication("red")) for name in seen.signals})


@pytest.mark.parametrize("change", [_with_sign, _sign_unseen, _red_arrow])
def test_no_right_on_red_against(signals, change):
    found = drive(signals, route(signals, "right"), ego(-80.0, 12.0), 16.0, light=lambda _: "red", change=change)
    assert found.states[-1] == f"{IH}.stop"
    assert found.fronts().max() <= LINE + 0.01


def test_a_stop_sign_is_stopped_at_once_and_then_crossed():
    road = crossing("all_way_stop")
    found = drive(road, route(road, "straight"), ego(-80.0, 12.0), 22.0)
    assert found.events.count("stopped") == 1
    assert found.events.count("released") == 1
    assert found.fronts()[-1] > 20.0


def test_a_cyclist_is_passed_by_the_next_lane(road):
    found = drive(road, route(road), ego(5.0), 22.0, lambda time: (cyclist(140.0 + 4.5 * time),))
    assert found.supers == [LF, OT, LF]
    assert [event for event in found.events if event in ("overtaking_begins", "back_in_lane")] == ["overtaking_begins", "back_in_lane"]
    assert found.clearance() >= 0.9144
    assert found.ticks[-1][0].ego.y == pytest.approx(center(1), abs=0.35)


@pytest.mark.parametrize(("width", "passes"), [(3.5, True), (3.4, False)])
def test_a_single_lane_is_wide_enough_for_three_feet_or_it_is_not(width, passes):
    road = straight(1, width=width, center="double_solid")
    begin = ego(5.0, 12.0, width=width, lanes=1)
    found = drive(road, route(road), begin, 20.0, lambda time: (cyclist(60.0 + 4.5 * time, width=width, lanes=1),))
    behind = found.ticks[-1][0].ego.x < found.ticks[-1][0].tracks[0].x
    assert behind is not passes
    assert found.clearance() >= 0.9144
    if not passes:
        assert OT not in found.supers
        assert found.speeds()[-1] == pytest.approx(4.5, abs=0.5)


def test_the_route_changes_lanes_for_a_left_turn(signals):
    way = route(signals, "left", lane="first.e.2")
    found = drive(signals, way, ego(-280.0, 14.0), 30.0, light=lambda _: "green")
    assert f"{LF}.lane_change_left" in found.states
    assert f"{IH}.turn_left" in found.states
    assert found.ticks[-1][0].ego.y > 16.0


def test_the_same_observations_give_the_same_bits(road):
    def tracks(time):
        return cyclist(90.0 + 4.5 * time), car("other", 20.0 + 14.0 * time, 14.0, lane=2)

    first, second = (drive(road, route(road), ego(5.0), 8.0, tracks) for _ in range(2))
    for (_, one), (_, other) in zip(first.ticks, second.ticks, strict=True):
        assert (one.state, one.steps, one.margin, one.events, one.chosen) == (other.state, other.steps, other.margin, other.events, other.chosen)
        for name in ("x", "y", "speed", "acceleration", "curvature"):
            assert getattr(one.trajectory, name).tobytes() == getattr(other.trajectory, name).tobytes()


def test_strategy_runs_at_two_hertz_and_motion_at_every_tick(road):
    planner = Planner(law(), road, route(road), FOOTPRINT)
    found = drive(road, route(road), ego(5.0), 4.0, planner=planner)
    strategic = [seen.time for seen, decision in found.ticks if decision.strategic]
    assert np.diff(strategic).max() <= 0.6 + 1e-9
    assert all(len(decision.candidates) == 1 for _, decision in found.ticks if not decision.strategic)


def test_warming_compiles_every_transition_and_changes_no_decision(signals):
    begin = seen(ego(-60.0, 10.0), light="red", road_map=signals)
    warm, cold = (Planner(law(), signals, route(signals, "right"), FOOTPRINT) for _ in range(2))
    warm.warm(begin)
    one, other = warm.step(begin), cold.step(begin)
    assert (one.state, one.margin, one.trajectory.speed.tobytes()) == (other.state, other.margin, other.trajectory.speed.tobytes())
    with pytest.raises(RequestError, match="unknown"):
        Planner(law(), replace(signals, jurisdiction="atlantis"), route(signals, "right"), FOOTPRINT).warm(begin)


def test_a_candidate_that_raises_falls_out_alone(road, monkeypatch):
    planner = Planner(law(), road, route(road), FOOTPRINT)
    planner.step(seen(ego(5.0)))
    evaluate = type(planner._mind.evaluator).evaluate

    def fails(self, maneuver, *args):
        if maneuver.next.endswith("car_following"):
            raise RuntimeError("something broke")
        return evaluate(self, maneuver, *args)

    monkeypatch.setattr(type(planner._mind.evaluator), "evaluate", fails)
    decision = planner.step(seen(ego(12.5), cyclist(90.0), time=0.5))
    broken = next(item for item in decision.candidates if item.next == f"{LF}.car_following")
    assert broken.rank == 3
    assert "something broke" in broken.rejections[0].because
    assert decision.flag == ""


def test_when_every_part_raises_the_vehicle_brakes_along_its_plan(road, monkeypatch):
    planner = Planner(law(), road, route(road), FOOTPRINT)
    planner.step(seen(ego(5.0)))
    monkeypatch.setattr(planner._mind, "think", lambda *_: 1 / 0)
    decision = planner.step(seen(ego(6.5), time=0.1))
    assert decision.flag == "no_trajectory"
    assert "ZeroDivisionError" in decision.reason
    assert decision.trajectory.speed[-1] == 0.0


def test_a_decision_can_be_told_in_words(signals):
    found = drive(signals, route(signals, "right"), ego(-60.0, 10.0), 4.0, light=lambda _: "red")
    told = [decision_text(decision) for _, decision in found.ticks if decision.strategic]
    assert any("CVC 21453(a)" in text for text in told)
    assert all("not possible here" in text for text in told)
