"""Statements fused over time: what restricts stands at once, what permits waits, everything ages."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import pytest
from regdb_runtime.database import RegulationDatabase
from regdb_runtime.perception.evidence import Reading, Statement
from regdb_runtime.perception.fusion import Fusion, FusionSettings
from regdb_runtime.perception.questions import answer
from regdb_runtime.perception.relevance import relevant_facts
from regdb_runtime.worlds.built_in.build import shipped_vocabulary

from regdb.front import database
from regdb.vocabulary import Value, Vocabulary

FACTS = RegulationDatabase.open(database()).vocabulary


@pytest.fixture(scope="module")
def vocabulary() -> Vocabulary:
    return FACTS


def say(text: str, at: float, **more: object) -> Reading:
    """One statement, as in `posted.speed=45 mph`."""
    fact, _, written = text.partition("=")
    value = FACTS.fact(fact).read(written)
    assert value is not None
    return Reading("", (replace(Statement(fact, value, captured=at, frame=f"{at:.2f}"), **more),))


class Story:
    """Readings one after another, with a speed that turns time into distance."""

    def __init__(self, vocabulary: Vocabulary, speed: float = 0.0, tells: tuple[str, ...] | None = None) -> None:
        self.fusion, self.speed = Fusion(vocabulary, tells=tells), speed

    def say(self, text: str, *times: float, **more: object) -> Story:
        for at in times:
            self.fusion.update(say(text, at, **more), self.speed * at, at)
        return self

    def at(self, time: float, fact: str) -> Value | None:
        return self.fusion.snapshot(time, self.speed * time).facts.get(fact)


def test_a_red_light_stands_from_the_first_look_and_is_forgotten_when_nothing_shows_it(vocabulary: Vocabulary) -> None:
    story = Story(vocabulary).say("signal.color=red", 1.0)
    assert story.at(1.0, "signal.color") == "red"
    assert story.at(2.5, "signal.color") == "red"
    assert story.at(2.6, "signal.color") is None


def test_a_green_light_is_never_believed_of_the_model_alone(vocabulary: Vocabulary) -> None:
    story = Story(vocabulary).say("signal.color=green", *[0.5 * step for step in range(40)])
    assert story.at(19.5, "signal.color") is None


@pytest.mark.parametrize("source", ["detector", "map"])
def test_a_green_light_seen_twice_and_corroborated_is_green_until_it_is_stale(vocabulary: Vocabulary, source: str) -> None:
    story = Story(vocabulary).say("signal.color=green", 1.0)
    story.say("signal.color=green", 1.0, 1.25, source=source)
    if source == "detector":
        assert story.at(1.3, "signal.color") is None, "one look of the model"
    story.say("signal.color=green", 1.5)
    story.say("signal.color=green", 1.5, source=source)
    assert story.at(1.6, "signal.color") == "green"
    assert story.at(3.2, "signal.color") is None


def test_one_red_among_greens_is_red_for_as_long_as_it_holds(vocabulary: Vocabulary) -> None:
    story = Story(vocabulary)
    for step in range(20):
        story.say("signal.color=green", 0.25 * step).say("signal.color=green", 0.25 * step, source="map")
    story.say("signal.color=red", 4.0)
    assert story.at(4.8, "signal.color") == "red"
    assert story.at(5.6, "signal.color") == "green"


def test_a_pedestrian_is_gone_when_two_later_looks_find_nobody(vocabulary: Vocabulary) -> None:
    story = Story(vocabulary).say("pedestrian.in_crosswalk=true", 0.0).say("pedestrian.in_crosswalk=false", 0.5)
    assert story.at(0.5, "pedestrian.in_crosswalk") is True
    story.say("pedestrian.in_crosswalk=false", 1.0)
    assert story.at(1.0, "pedestrian.in_crosswalk") is False
    assert story.at(2.6, "pedestrian.in_crosswalk") is None, "nobody has looked since"


def test_a_forbidding_sign_stands_by_distance_however_often_it_is_missed_afterwards(vocabulary: Vocabulary) -> None:
    story = Story(vocabulary, speed=10.0).say("sign.no_turn_on_red=true", 0.0).say("sign.no_turn_on_red=false", 0.5, 1.0, 1.5)
    assert story.at(8.0, "sign.no_turn_on_red") is True
    assert story.at(8.1, "sign.no_turn_on_red") is None


def test_that_there_is_no_sign_takes_two_looks_and_counts_only_near_them(vocabulary: Vocabulary) -> None:
    story = Story(vocabulary, speed=10.0).say("sign.no_turn_on_red=false", 0.0)
    assert story.at(0.0, "sign.no_turn_on_red") is None
    story.say("sign.no_turn_on_red=false", 0.5)
    assert story.at(1.0, "sign.no_turn_on_red") is False
    assert story.at(3.2, "sign.no_turn_on_red") is None


def test_two_prompts_on_one_frame_are_one_look(vocabulary: Vocabulary) -> None:
    story = Story(vocabulary).say("sign.no_turn_on_red=false", 1.0, prompt="a").say("sign.no_turn_on_red=false", 1.0, prompt="b")
    assert story.at(1.0, "sign.no_turn_on_red") is None


def test_a_hedged_statement_makes_nothing_known_and_keeps_what_permits_unknown(vocabulary: Vocabulary) -> None:
    story = Story(vocabulary).say("pedestrian.in_crosswalk=true", 0.0, 0.5, 1.0, certainty="hedged")
    assert story.at(1.0, "pedestrian.in_crosswalk") is None
    story.say("pedestrian.in_crosswalk=false", 0.5, 1.0)
    assert story.at(1.0, "pedestrian.in_crosswalk") is None
    assert story.at(2.51, "pedestrian.in_crosswalk") is None


def test_a_lower_limit_stands_at_once_a_higher_one_when_confirmed(vocabulary: Vocabulary) -> None:
    mph = 0.44704
    story = Story(vocabulary, speed=10.0).say("posted.speed=45 mph", 0.0, 0.5, 1.0)
    assert story.at(1.0, "posted.speed") == 45 * mph
    story.say("posted.speed=25 mph", 2.0)
    assert story.at(2.0, "posted.speed") == 25 * mph
    story.say("posted.speed=45 mph", 3.0)
    assert story.at(3.0, "posted.speed") == 25 * mph
    story.say("posted.speed=45 mph", 3.5, 4.0)
    assert story.at(4.0, "posted.speed") == 45 * mph


@pytest.mark.parametrize(("number", "reason"), [(3, "less than"), (42, "multiple"), (250, "more than")])
def test_numbers_that_no_sign_bears_are_refused_with_the_reason(vocabulary: Vocabulary, number: float, reason: str) -> None:
    fusion = Fusion(vocabulary)
    refused = fusion.update(say(f"posted.speed={number} mph", 0.0), 0.0, 0.0)
    assert [reason in item.reason for item in refused] == [True]
    assert fusion.snapshot(0.0, 0.0).facts == {}


@pytest.mark.parametrize(("fact", "value", "at", "reason"), [
    ("sign.stopp", True, 0.0, "no fact"), ("ego.speed", 3.0, 0.0, "nobody sees it"), ("signal.color", "blue", 0.0, "no value"),
    ("signal.color", "red", 9.0, "future"), ("sign.stop", "red", 0.0, "no value"), ("lead.distance", float("nan"), 0.0, "no value"),
])  # fmt: skip
def test_what_cannot_be_is_refused(vocabulary: Vocabulary, fact: str, value: Value, at: float, reason: str) -> None:
    assert reason in Fusion(vocabulary).update(Reading("", (Statement(fact, value, captured=at),)), 0.0, 0.0)[0].reason


def test_a_school_zone_ends_by_its_sign_by_the_map_or_with_distance(vocabulary: Vocabulary) -> None:
    story = Story(vocabulary, speed=10.0).say("sign.school=true", 0.0)
    assert story.at(49.0, "sign.school") is True
    assert story.at(50.1, "sign.school") is None
    story = Story(vocabulary, speed=10.0).say("sign.school=true", 0.0)
    story.say("sign.end_school_zone=true", 20.0)
    assert story.at(20.0, "sign.school") is True
    story.say("sign.end_school_zone=true", 20.5)
    assert story.at(20.5, "sign.school") is True, "two looks that may be one mistake: the question has not been asked"
    story.say("sign.end_school_zone=true", 21.0, rule="choice")
    assert story.at(21.0, "sign.school") is None
    assert story.at(40.0, "sign.school") is None, "over is over"
    story.say("sign.school=true", 41.0)
    assert story.at(41.0, "sign.school") is True, "another zone begins"
    story = Story(vocabulary, speed=10.0).say("sign.school=true", 0.0).say("sign.school=false", 20.0, source="map")
    assert story.at(20.0, "sign.school") is False


def test_look_alikes_ask_a_closed_question_and_the_strict_reading_stands_until_it_is_answered(vocabulary: Vocabulary) -> None:
    story = Story(vocabulary).say("sign.stop=true", 0.0)
    question = story.fusion.questions(0.0, 0.0)[0]
    assert question.fact == "sign.stop"
    assert {choice.fact for choice in question.choices} == {"sign.stop", "sign.stop_here_on_red", "sign.stop_ahead"}
    chosen = next(choice.label for choice in question.choices if choice.fact == "sign.stop_here_on_red")
    for at in (0.5, 1.0):
        assert story.at(at, "sign.stop") is True
        story.fusion.update(answer(question, chosen, at), 0.0, at)
        story.say("sign.stop=true", at)
    assert story.at(1.0, "sign.stop") is False, "twice answered, whatever the wide picture is taken for"
    assert story.at(1.0, "sign.stop_here_on_red") is True
    assert "sign.stop" not in {item.fact for item in story.fusion.questions(1.0, 0.0)}
    story.say("sign.stop=true", 1.5, source="detector")
    assert story.at(1.5, "sign.stop") is True, "another eye sees it still"


def test_a_later_answer_for_the_strict_side_counts_at_once(vocabulary: Vocabulary) -> None:
    story = Story(vocabulary).say("sign.stop=true", 0.0, 0.5, 1.0).say("sign.stop=false", 0.25, 0.5, rule="choice")
    assert story.at(1.0, "sign.stop") is False
    story.say("sign.stop=true", 1.25, rule="choice")
    assert story.at(1.25, "sign.stop") is True


def test_an_answer_that_names_nothing_changes_nothing(vocabulary: Vocabulary) -> None:
    story = Story(vocabulary).say("sign.stop=true", 0.0)
    question = story.fusion.questions(0.0, 0.0)[0]
    assert answer(question, "I cannot tell.", 0.5).statements == ()
    none = answer(question, f"({chr(97 + len(question.choices))})", 0.5)
    assert {item.fact: item.value for item in none.statements} == dict.fromkeys((choice.fact for choice in question.choices), False)


def test_what_is_not_known_is_silent_where_it_matters_and_quiet_where_it_does_not(vocabulary: Vocabulary) -> None:
    tells = ("sign.no_turn_on_red", "sign.no_passing")
    fusion = Fusion(vocabulary, tells=tells)
    fusion.update(Reading("nothing of note"), 0.0, 0.0)
    everywhere = fusion.snapshot(0.1, 0.0)
    assert (everywhere.facts, everywhere.silent) == ({}, frozenset(tells))
    here = relevant_facts(vocabulary, {"signal.present": False})
    assert "sign.no_turn_on_red" not in here
    assert "sign.no_passing" in here
    found = fusion.snapshot(0.1, 0.0, here)
    assert found.facts == {"sign.no_turn_on_red": False}
    assert (found.assumed, found.silent) == (frozenset(["sign.no_turn_on_red"]), frozenset(["sign.no_passing"]))
    fusion.update(say("sign.no_turn_on_red=true", 0.2, certainty="hedged"), 0.0, 0.2)
    assert fusion.snapshot(0.2, 0.0, here).facts == {}, "somebody said something of it"
    late = fusion.snapshot(60.0, 0.0, here)
    assert late.facts == {}
    assert "has not said anything for" in late.degraded


def test_a_rail_signal_matters_where_the_map_is_silent(vocabulary: Vocabulary) -> None:
    assert "rail.signal" in relevant_facts(vocabulary, {})
    assert "rail.signal" not in relevant_facts(vocabulary, {"rail.crossing_ahead": False})


def test_evidence_and_age_are_those_of_the_statements_it_rests_on(vocabulary: Vocabulary) -> None:
    story = Story(vocabulary).say("pedestrian.in_crosswalk=true", 0.0, 0.5)
    found = story.fusion.snapshot(1.2, 0.0)
    assert [item.frame for item in found.evidence["pedestrian.in_crosswalk"]] == ["0.00", "0.50"]
    assert found.age["pedestrian.in_crosswalk"] == pytest.approx(0.7)


def test_at_twenty_looks_a_second_two_looks_are_still_apart_and_memory_stays_small(vocabulary: Vocabulary) -> None:
    story = Story(vocabulary)
    for step in range(4000):
        story.say("sign.no_turn_on_red=false", 0.05 * step)
    assert story.at(200.0, "sign.no_turn_on_red") is False
    settings = FusionSettings()
    assert len(story.fusion._held["sign.no_turn_on_red"]) <= 4 + settings.spare


class TestSlips:
    """A sign that the model invents once does not hold a standing vehicle for ever; one that was seen on the way stays."""

    FACT = "sign.no_turn_on_red"

    def fused(self, said: Sequence[tuple[float, float, bool]]) -> object:
        """(time, odometer, seen) of each answer -> what is believed at the end."""
        fusion = Fusion(shipped_vocabulary())
        for time, travelled, seen in said:
            statement = Statement(self.FACT, seen, captured=time, frame=f"f{time}", rule="seen")
            fusion.update(Reading("", (statement,)), travelled, time)
        time, travelled, _ = said[-1]
        return fusion.snapshot(time, travelled).facts.get(self.FACT)

    def test_one_slip_among_denials_from_the_same_place_is_outvoted(self) -> None:
        said = [(k * 0.5, 100.0, k == 3) for k in range(16)]
        assert self.fused(said[:6]) is True
        assert self.fused(said) is False

    def test_a_sign_seen_on_the_way_stays_though_it_has_left_the_view(self) -> None:
        approach = [(k * 0.5, 60.0 + 5.0 * k, True) for k in range(8)]
        standing = [(4.0 + k * 0.5, 100.0, False) for k in range(40)]
        assert self.fused(approach + standing) is True

    def test_a_sign_that_is_affirmed_from_there_half_of_the_time_stays(self) -> None:
        assert self.fused([(k * 0.5, 100.0, k % 2 == 0) for k in range(40)]) is True

    def test_a_moving_vehicle_outvotes_nothing(self) -> None:
        assert self.fused([(k * 0.5, 100.0 + 4.0 * k, k == 3) for k in range(16)]) is True
