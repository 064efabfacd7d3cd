"""Scenes and plans as people write them, and what stands in for what is unknown."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from random_law import ASSUMED, VOCABULARY, known_facts
from regdb_compiler.read_corpus import read_corpus

from regdb.situation import Plan, Scene, SceneError, Situation, quiet_facts, read_plan, read_scene
from regdb.states import StateMachine
from regdb.vocabulary import Value


@pytest.fixture(scope="module")
def machine(codes: Path) -> StateMachine:
    return read_corpus(codes).machine


@given(known_facts())
def test_a_scene_is_read_back_from_how_it_is_shown(facts: dict[str, Value]) -> None:
    raw = {name: VOCABULARY.fact(name).show(value) for name, value in facts.items()}
    assert read_scene(raw, VOCABULARY) == Scene(facts)


def test_quiet_is_a_start_that_the_scene_changes() -> None:
    quiet = read_scene({"like": "quiet"}, VOCABULARY)
    assert quiet.facts == quiet_facts(VOCABULARY)
    assert quiet.facts["red"] is False
    assert quiet.facts["signal.color"] == "none"
    assert "ego.speed" not in quiet.facts
    scene = read_scene({"like": "quiet", "red": "true", "stopped": "unknown"}, VOCABULARY)
    assert scene.facts["red"] is True
    assert "stopped" not in scene.facts


def test_every_problem_of_a_scene_is_told() -> None:
    with pytest.raises(SceneError) as told:
        read_scene({"like": "loud", "rad": True, "signal.color": "gren", "ego.speed": "30"}, VOCABULARY)
    assert len(told.value.problems) == 4
    assert [part in str(told.value) for part in ("loud", "did you mean red", "did you mean green", "unit of speed")] == [True] * 4


STOP, RIGHT = "intersection_handling.stop", "intersection_handling.turn_right"


@pytest.mark.parametrize(
    ("raw", "plan"),
    [
        ({"current": "stop", "next": "turn_right", "speed": "10 m/s"}, Plan(STOP, RIGHT, {"plan.speed": 10.0})),
        ({"current": "stop", "next": "stop", "plan.speed": "10 m/s"}, Plan(STOP, STOP, {"plan.speed": 10.0})),
        ({}, Plan("lane_following.go_straight", "lane_following.go_straight")),
        ({"next": "turn_left"}, Plan("intersection_handling.turn_left", "intersection_handling.turn_left")),
        ({"current": "overtaking", "next": "overtaking"}, Plan("overtaking.go_straight", "overtaking.go_straight")),
    ],
)
def test_a_plan_names_states_and_its_own_quantities(raw: dict[str, Any], plan: Plan, machine: StateMachine) -> None:
    assert read_plan(raw, VOCABULARY, machine) == plan


def test_every_problem_of_a_plan_is_told(machine: StateMachine) -> None:
    with pytest.raises(SceneError) as told:
        read_plan({"current": "stopp", "sped": "3 mph", "clearance": "3 mph"}, VOCABULARY, machine)
    assert len(told.value.problems) == 3


def test_what_is_seen_beats_what_is_assumed() -> None:
    plan = Plan("a", "b")
    unseen, seen = Situation(VOCABULARY, Scene(), plan), Situation(VOCABULARY, Scene({ASSUMED: True}), plan)
    assert unseen.value(ASSUMED) is False
    assert unseen.observed(ASSUMED) is None
    assert seen.value(ASSUMED) is True
    assert unseen.value("red") is None
    assert unseen.value("no.such.fact") is None


@pytest.mark.parametrize("silent", ["perception", ["perception"], [ASSUMED]])
def test_nothing_is_assumed_of_what_reports_nothing(silent: Any) -> None:
    situation = Situation(VOCABULARY, read_scene({"silent": silent}, VOCABULARY), Plan("a", "b"))
    assert situation.value(ASSUMED) is None


def test_the_plan_speaks_before_the_scene() -> None:
    situation = Situation(VOCABULARY, Scene({"plan.speed": 5.0, "red": True}), Plan("a", "b", {"plan.speed": 3.0}))
    assert situation.value("plan.speed") == 3.0
    assert situation.value("red") is True
