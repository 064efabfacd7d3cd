"""Phases of stops: approach, held, check, released."""

from dataclasses import replace

import pytest
from regdb_runtime.maps.lane_path import Junction
from regdb_runtime.observation import Indication
from regdb_runtime.strategy.settings import StrategySettings
from regdb_runtime.strategy.stop_line import NO_STOP, StopMemory, chosen, decision_distance, must_stop_on_yellow, observe, stop_point

SETTINGS = StrategySettings()
LINE = Junction("j", stop_station=100.0, entrance=105.0, exit=130.0, turn="right", control="signal", lights=("light",))


def look(memory: StopMemory, front: float, speed: float, time: float) -> StopMemory:
    return observe(memory, LINE, front, speed, time, SETTINGS)


def approaching() -> StopMemory:
    return chosen(look(NO_STOP, 60.0, 10.0, 0.0), LINE, stops=True, enters=False, time=0.0)


def test_choosing_to_stop_begins_an_approach():
    assert approaching().phase == "approach"


@pytest.mark.parametrize(
    ("front", "speed", "phase"),
    [(99.5, 0.0, "held"), (98.0, 0.0, "held"), (98.01, 0.099, "held"), (99.5, 0.1, "approach"), (97.9, 0.0, "approach")],
)
def test_held_is_standing_at_most_two_metres_before_the_line(front, speed, phase):
    assert look(approaching(), front, speed, 5.0).phase == phase


def test_check_follows_when_the_vehicle_has_stood_for_the_check_time():
    held = look(approaching(), 99.5, 0.0, 5.0)
    assert look(held, 99.5, 0.0, 5.9).phase == "held"
    assert look(held, 99.5, 0.0, 6.0).phase == "check"


def test_entering_releases_and_the_line_is_not_stopped_at_again():
    checked = replace(look(approaching(), 99.5, 0.0, 5.0), phase="check")
    released = chosen(checked, LINE, stops=False, enters=True, time=7.0)
    assert released.phase == "released"
    assert look(released, 99.6, 0.0, 7.1).phase == "released"
    assert look(released, 100.5, 2.0, 8.0).phase == "released"


def test_a_red_that_turns_green_releases_without_a_stop():
    assert chosen(look(approaching(), 80.0, 6.0, 2.0), LINE, stops=False, enters=True, time=2.0).phase == "released"


def test_a_stop_chosen_after_a_release_is_a_new_one():
    released = StopMemory("j:right", "released", 3.0)
    assert chosen(released, LINE, stops=True, enters=False, time=4.0) == StopMemory("j:right", "approach", 4.0)


def test_another_line_starts_anew():
    assert observe(StopMemory("other:left", "check", 1.0), LINE, 60.0, 5.0, 2.0, SETTINGS) == StopMemory("j:right", "", 2.0)


def test_a_held_vehicle_does_not_creep():
    point = stop_point(StopMemory("j:right", "held", 1.0), LINE, 98.4, SETTINGS)
    assert point.station == pytest.approx(98.4 + SETTINGS.stop_roll)
    assert stop_point(approaching(), LINE, 60.0, SETTINGS).station == 100.0


def test_decision_distance_is_gentle_braking_after_a_tick():
    assert decision_distance(10.0, SETTINGS) == pytest.approx(5.0 + 100.0 / 2.4 + 3.0)


@pytest.mark.parametrize(
    ("shown", "front", "stops"),
    [
        ((Indication("yellow"),), 60.0, True),  # 40 m left, 10 m/s stops in 16.7 m at 3 m/s2
        ((Indication("yellow"),), 84.0, False),
        ((Indication("yellow", flashing=True),), 60.0, False),
        ((Indication("yellow"), Indication("green", "right_arrow")), 60.0, False),
        ((Indication("green"),), 60.0, False),
        ((), 60.0, False),
    ],
)
def test_yellow_stops_whoever_can(shown, front, stops):
    assert must_stop_on_yellow(LINE, {"light": shown}, front, 10.0, SETTINGS) is stops


def test_a_stop_begun_on_yellow_is_kept_while_hard_braking_reaches_the_line():
    """Half way through braking the prudent bound no longer holds; who goes on then enters on red."""
    yellow = {"light": (Indication("yellow"),)}
    assert not must_stop_on_yellow(LINE, yellow, 88.0, 10.0, SETTINGS)
    assert must_stop_on_yellow(LINE, yellow, 88.0, 10.0, SETTINGS, stopping=True)
    assert not must_stop_on_yellow(LINE, yellow, 93.0, 10.0, SETTINGS, stopping=True)
