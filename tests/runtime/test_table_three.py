"""Table III of the paper: what its nine recorded responses say, and what the signs' own legends would have said."""

import pytest
from regdb_runtime.database import RegulationDatabase
from regdb_runtime.perception.matcher import Matcher

from regdb.front import database
from regdb.vocabulary import Value

MPH_20 = 20 * 0.44704

SCENARIOS: tuple[tuple[str, str, str, dict[str, Value]], ...] = (
    ("nearby intersection", "Ego vehicle is approaching an intersection…", "Intersection ahead", {"intersection.present": True}),
    (
        "yield for pedestrian",
        "The intersection appears to have pedestrian crossing, the ego vehicle should stay alert and yield to pedestrians.",
        "Pedestrian crossing",
        {"crosswalk.present": True},
    ),
    ("road work warning sign", "There is a visible warning sign: Road Work Ahead.", "ROAD WORK AHEAD", {"sign.road_work": True}),
    ("speed limit sign", "The speed limit sign indicates 20 mph maximum speed.", "SPEED LIMIT 20", {"posted.speed": MPH_20}),
    ("red light", "There is a visible red traffic light in sight.", "red light", {"signal.color": "red"}),
    ("green light", "There is a visible green traffic light in sight.", "green light", {"signal.color": "green"}),
    ("bicycle lane", "There is a visible bicycle lane.", "BIKE LANE", {"bicycle_lane.present": True}),
    ("end road work warning sign", "There is a visible warning sign: Road Work Ahead.", "END ROAD WORK", {"sign.end_road_work": True}),
    ("stop here on red sign", "There is a visible stop sign.", "STOP HERE ON RED", {"sign.stop_here_on_red": True}),
)
"""Scenario, the response as the table quotes it, the sign's own words, and the facts of the scene."""

MISREAD = {"end road work warning sign": "sign.road_work", "stop here on red sign": "sign.stop"}
"""The two the model took for another sign, and for which."""


@pytest.fixture(scope="module")
def matcher() -> Matcher:
    return Matcher(RegulationDatabase.open(database()).vocabulary)


def facts(matcher: Matcher, text: str) -> dict[str, Value]:
    return {item.fact: item.value for item in matcher.read(text).statements if item.certainty == "asserted"}


def holds(found: dict[str, Value], scene: dict[str, Value]) -> bool:
    return all(name in found and (found[name] == value or value == pytest.approx(found[name])) for name, value in scene.items())


def test_seven_of_nine_responses_give_the_scene(matcher: Matcher) -> None:
    right = [name for name, response, _, scene in SCENARIOS if holds(facts(matcher, response), scene)]
    assert right == [name for name, *_ in SCENARIOS if name not in MISREAD]


@pytest.mark.parametrize("scenario", [row for row in SCENARIOS if row[0] in MISREAD], ids=lambda row: row[0])
def test_a_misread_sign_comes_out_as_misread(matcher: Matcher, scenario: tuple[str, str, str, dict[str, Value]]) -> None:
    name, response, _, scene = scenario
    found = facts(matcher, response)
    assert found[MISREAD[name]] is True
    assert not set(scene) & set(found)


@pytest.mark.parametrize("scenario", SCENARIOS, ids=lambda row: row[0])
def test_the_legend_of_the_sign_gives_every_scene(matcher: Matcher, scenario: tuple[str, str, str, dict[str, Value]]) -> None:
    _, _, legend, scene = scenario
    found = facts(matcher, legend)
    assert holds(found, scene)
    assert not {"sign.stop", "sign.road_work"} & set(found) - set(scene)


def test_pedestrians_to_yield_to_are_none_that_were_seen(matcher: Matcher) -> None:
    found = facts(matcher, SCENARIOS[1][1])
    assert "pedestrian.present" not in found
    assert "pedestrian.in_crosswalk" not in found
    assert found["intersection.present"] is True


def test_every_scene_is_about_a_fact_of_the_vocabulary(matcher: Matcher) -> None:
    assert {name for *_, scene in SCENARIOS for name in scene} <= set(matcher.vocabulary.facts)
