"""What each state asks: the paper's sentences word for word; then what its rules read, and what would settle a verdict."""

from collections.abc import Iterator

import pytest
from regdb_runtime.database import RegulationDatabase
from regdb_runtime.errors import RequestError
from regdb_runtime.legality import View
from regdb_runtime.perception.answer_schema import can_be_asked
from regdb_runtime.perception.prompts import PromptMaker, PromptSettings
from regdb_runtime.scenes.tellers import eye_facts

from regdb.front import database
from regdb.situation import Plan, Scene, quiet_facts
from regdb.states import StateMachine

LANE_FOLLOWING = "Examine the current driving scenario, look out for intersections or obstacle vehicles."
INTERSECTION = "Examine the current driving scenario, check if the ego vehicle is still facing an intersection."
OVERTAKING = "Examine the current driving scenario, check nearby lane occupation conditions, and look out for intersection."


@pytest.fixture(scope="module")
def law() -> RegulationDatabase:
    return RegulationDatabase.open(database())


@pytest.fixture(scope="module")
def view(law: RegulationDatabase) -> View:
    return law.at("los_angeles", "2026-03-02")


@pytest.fixture(scope="module")
def maker(law: RegulationDatabase, view: View) -> PromptMaker:
    return PromptMaker(law.machine, law.vocabulary, view, asks=eye_facts(law.vocabulary))


def states(machine: StateMachine, super_state: str) -> Iterator[str]:
    return (state.id for state in machine.states.values() if state.super_state == super_state)


def test_lane_following_asks_the_papers_question(law: RegulationDatabase) -> None:
    plain = PromptMaker(law.machine, law.vocabulary)
    assert {plain.prompt(state).text for state in states(law.machine, "lane_following")} == {LANE_FOLLOWING}


def test_intersection_handling_asks_the_papers_question(law: RegulationDatabase) -> None:
    plain = PromptMaker(law.machine, law.vocabulary)
    assert {plain.prompt(state).text for state in states(law.machine, "intersection_handling")} == {INTERSECTION}


def test_overtaking_asks_the_papers_question(law: RegulationDatabase) -> None:
    plain = PromptMaker(law.machine, law.vocabulary)
    assert {plain.prompt(state).text for state in states(law.machine, "overtaking")} == {OVERTAKING}


def test_an_emergency_asks_nothing(law: RegulationDatabase, maker: PromptMaker) -> None:
    for state in states(law.machine, "emergency_stop"):
        assert maker.prompt(state, ("sign.no_turn_on_red",)) is None
        assert PromptMaker(law.machine, law.vocabulary).prompt(state) is None


def test_the_papers_prompt_asks_for_prose(law: RegulationDatabase) -> None:
    prompt = PromptMaker(law.machine, law.vocabulary).prompt("lane_following.go_straight")
    assert prompt is not None
    assert (prompt.schema, prompt.name, prompt.history, prompt.crop) == (None, "lane_following.go_straight", (), None)


def test_with_the_law_the_facts_of_reachable_rules_follow(law: RegulationDatabase, view: View, maker: PromptMaker) -> None:
    for state in law.machine.states.values():
        prompt = maker.prompt(state.id)
        if prompt is None:
            continue
        assert prompt.text.startswith(maker.sentence(state.id) + "\n")
        asked = maker.concerned(state.id)[: PromptSettings().facts]
        assert len(asked) == PromptSettings().facts
        reachable = {name for following in state.next for rule in view.concerned(state.id, following) for name in rule.facts}
        assert set(maker.concerned(state.id)) == reachable & maker.asks
        assert all(f"{law.vocabulary.fact(name).meaning}" in prompt.text for name in asked)


def test_each_state_asks_what_is_its_own_first(maker: PromptMaker) -> None:
    first = {state: maker.concerned(state)[:8] for state in ("intersection_handling.stop", "lane_following.pull_over", "lane_following.go_straight")}
    assert "sign.no_turn_on_red" in first["intersection_handling.stop"]
    assert "sign.no_turn_on_red" not in first["lane_following.go_straight"]
    assert {"sign.no_parking", "sign.no_stopping"} & set(first["lane_following.pull_over"])
    assert not {"sign.no_parking", "sign.no_stopping"} & set(first["intersection_handling.stop"])


def test_what_would_settle_the_verdict_is_looked_for_first(law: RegulationDatabase, view: View, maker: PromptMaker) -> None:
    """The paper's right turn on red: the verdict names the sign, and the next prompt looks for it."""
    facts = quiet_facts(law.vocabulary) | {"signal.present": True, "signal.color": "red", "signal.shape": "circular", "ego.stopped_at_line": True}
    del facts["sign.no_turn_on_red"]
    plan = Plan("intersection_handling.stop", "intersection_handling.turn_right", {"plan.speed": 2.0})
    verdict = view.judge(Scene(facts), plan)
    assert verdict.missing == ("sign.no_turn_on_red",)
    prompt = maker.prompt("intersection_handling.stop", verdict.missing)
    assert prompt is not None
    assert prompt.text.split("\n")[:3] == [
        INTERSECTION, "Look for these first:", "- sign.no_turn_on_red: A sign forbids the planned turn while the signal is red.",
    ]  # fmt: skip
    assert prompt.text.count("sign.no_turn_on_red") == 1
    assert prompt.schema is not None
    assert prompt.schema["properties"]["not_seen"]["items"]["enum"][0] == "sign.no_turn_on_red"


def test_without_the_law_only_what_is_missing_is_added(law: RegulationDatabase) -> None:
    prompt = PromptMaker(law.machine, law.vocabulary).prompt("intersection_handling.stop", ("sign.no_turn_on_red", "sign.no_turn_on_red"))
    assert prompt is not None
    assert "Then for these" not in prompt.text
    assert prompt.schema is not None
    assert prompt.schema["properties"]["seen"]["items"]["enum"] == ["sign.no_turn_on_red"]


def test_what_no_picture_shows_is_never_asked(law: RegulationDatabase, maker: PromptMaker) -> None:
    missing = ("plan.speed", "ego.speed", "clock.time", "hydrant.distance", "no.such.fact")
    assert maker.prompt("lane_following.go_straight", missing) == maker.prompt("lane_following.go_straight")
    assert all(can_be_asked(law.vocabulary.fact(name)) for name in maker.asks)
    assert "hydrant.distance" not in maker.asks, "nobody reads a distance off a picture"


def test_prompts_stay_short(law: RegulationDatabase, view: View) -> None:
    settings = PromptSettings(facts=5, look_for=2)
    short = PromptMaker(law.machine, law.vocabulary, view, settings, eye_facts(law.vocabulary))
    missing = ("sign.school", "sign.no_turn_on_red", "school.children_going")
    prompt = short.prompt("intersection_handling.stop", missing)
    assert prompt is not None
    assert prompt.text.count("\n- ") == 7
    assert "school.children_going" not in prompt.text.split("Then for these")[0]
    default = PromptMaker(law.machine, law.vocabulary, view, asks=eye_facts(law.vocabulary))
    assert all(len(found.text) < 2400 for state in law.machine.states if (found := default.prompt(state)) is not None)


def test_what_does_not_matter_here_is_not_asked(maker: PromptMaker) -> None:
    prompt = maker.prompt("lane_following.go_straight", ("sign.school",), relevant=frozenset({"director.present"}))
    assert prompt is not None
    assert [line.split(":")[0] for line in prompt.text.split("\n") if line.startswith("- ")] == ["- sign.school", "- director.present"]


def test_every_fact_has_its_turn(maker: PromptMaker) -> None:
    state = "intersection_handling.stop"
    concerned = maker.concerned(state)
    asked = [[line[2:].split(":")[0].split("=")[0] for line in prompt.text.split("\n") if line.startswith("- ")]
             for turn in range(12) if (prompt := maker.prompt(state, turn=turn)) is not None]  # fmt: skip
    assert {name for names in asked for name in names} == set(concerned)
    assert all(names[:4] == list(concerned[:4]) and len(set(names)) == 8 for names in asked)


def test_words_of_an_enumeration_are_named_one_by_one(law: RegulationDatabase) -> None:
    prompt = PromptMaker(law.machine, law.vocabulary).prompt("lane_following.go_straight", ("signal.color",))
    assert prompt is not None
    assert "- signal.color=red or signal.color=yellow or signal.color=green: Colour of the indication" in prompt.text
    assert prompt.schema is not None
    assert prompt.schema["properties"]["seen"]["items"]["enum"] == ["signal.color=red", "signal.color=yellow", "signal.color=green"]
    assert "not_seen" not in prompt.schema["properties"]


def test_earlier_turns_go_along_only_when_asked_for(law: RegulationDatabase) -> None:
    turns = tuple((f"question {index}", f"answer {index}") for index in range(5))
    none = PromptMaker(law.machine, law.vocabulary).prompt("lane_following.go_straight", (), turns)
    two = PromptMaker(law.machine, law.vocabulary, settings=PromptSettings(shots=2)).prompt("lane_following.go_straight", (), turns)
    assert none is not None
    assert two is not None
    assert (none.history, two.history) == ((), turns[-2:])


def test_another_place_gives_another_maker_only_if_its_rules_differ(law: RegulationDatabase, view: View, maker: PromptMaker) -> None:
    assert maker.under(view) is maker
    assert maker.under(law.at("los_angeles", "2026-03-03")) is maker
    elsewhere = maker.under(law.at("model", "2026-03-02") if "model" in {item.id for item in law.tree} else law.at("uvc", "2026-03-02"))
    assert elsewhere is not maker
    assert elsewhere.asks == maker.asks


def test_a_state_that_is_not_there_is_refused(maker: PromptMaker) -> None:
    with pytest.raises(RequestError, match=r"unknown state 'go_straight'; a prompt is asked for by a state's id, such as 'lane_"):
        maker.prompt("go_straight")
