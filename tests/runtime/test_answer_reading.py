"""Answers in JSON, whole or not, and in prose, become statements with their places; what cannot be trusted is set aside."""

import json
from typing import Any

import pytest
from regdb_runtime.perception.answer_reading import read_answer
from regdb_runtime.perception.answer_schema import AnswerLimits
from regdb_runtime.perception.describer import Description, Frame, Prompt
from regdb_runtime.perception.evidence import Reading, Span, Statement

from regdb.vocabulary import Fact, Vocabulary

VOCABULARY = Vocabulary([
    Fact("sign.stop", "boolean", phrases={"true": ("stop sign",)}),
    Fact("sign.end_road_work", "boolean", phrases={"true": ("end road work",)}),
    Fact("sign.speed_limit", "boolean", phrases={"true": ("speed limit sign",)}),
    Fact("posted.speed", "quantity", unit="mph", phrases={"": ("speed limit {n}",)}),
    Fact("signal.color", "enumeration", values=("none", "red", "yellow", "green"), phrases={"red": ("red light",)}),
    Fact("weather.conditions", "set", values=("rain", "fog"), phrases={"rain": ("rain",), "fog": ("fog",)}),
    Fact("ego.speed", "quantity", unit="mph", source="ego"),
    Fact("plan.passes", "boolean", source="plan"),
])  # fmt: skip
FRAME, PROMPT = Frame("f7", 3.25, b""), Prompt("?", name="lane_following.go_straight")


class Words:
    """A reader of prose that knows one phrase, and notes what it was shown."""

    def __init__(self) -> None:
        self.shown: list[str] = []

    def read(self, text: str, captured: float = 0.0, frame: str = "", prompt: str = "", model: str = "") -> Reading:
        self.shown.append(text)
        found = [
            Statement(fact, value=True, captured=captured, spans=(Span(at, at + len(phrase)),), rule=phrase, frame=frame, prompt=prompt, model=model)
            for phrase, fact in (("stop sign", "sign.stop"), ("end road work", "sign.end_road_work"))
            if (at := text.lower().find(phrase)) >= 0
        ]
        return Reading(text, tuple(found))


def read(text: str, **description: Any) -> Reading:
    return read_answer(Description(text, model="m", **description), Words(), VOCABULARY, FRAME, PROMPT)


def facts(text: str) -> dict[str, Any]:
    return {item.fact: item.value for item in read(text).statements}


def aside(text: str) -> set[str]:
    return {why for _, _, why in read(text).set_aside}


WHOLE = '{"seen": ["signal.color=red", "sign.stop"], "not_seen": ["sign.end_road_work"], "sign_text": [], "speed_limit": 25}'
FOUND = {"signal.color": "red", "sign.stop": True, "sign.end_road_work": False, "posted.speed": pytest.approx(11.176), "sign.speed_limit": True}


def test_a_whole_answer() -> None:
    assert facts(WHOLE) == FOUND
    first = read(WHOLE).statements[0]
    assert first == Statement(
        "signal.color", "red", captured=3.25, spans=(Span(10, 28),), rule="seen", frame="f7", prompt="lane_following.go_straight", model="m"
    )
    assert WHOLE[10:28] == '"signal.color=red"'


@pytest.mark.parametrize(
    "text",
    [
        f"```json\n{WHOLE}\n```", f"```\n{WHOLE}\n```\n", f"Here is the JSON:\n{WHOLE}", f"{WHOLE}\nI hope that helps! A stop sign {{maybe}}.",
        json.dumps(json.loads(WHOLE), indent=2), WHOLE.replace(" ", ""), "  \n" + WHOLE, WHOLE.replace("25", '"25 mph"'), WHOLE.replace("25", '"25"'),
    ],
)  # fmt: skip
def test_what_stands_around_an_answer_changes_nothing(text: str) -> None:
    assert facts(text) == FOUND


def test_words_beside_the_answer_are_set_aside_not_read() -> None:
    matcher = Words()
    found = read_answer(Description('There is a stop sign. {"seen": []}'), matcher, VOCABULARY)
    assert (found.statements, matcher.shown) == ((), [])
    assert found.set_aside == (("There is a stop sign.", Span(0, 22), "beside the answer"),)


def test_an_answer_cut_off_anywhere_says_what_is_whole_in_it_and_no_more() -> None:
    pieces = {"signal.color": '"signal.color=red"', "sign.stop": '"sign.stop"', "sign.end_road_work": '"sign.end_road_work"'}
    whole = {name: WHOLE.index(piece) + len(piece) for name, piece in pieces.items()}
    whole["posted.speed"] = whole["sign.speed_limit"] = len(WHOLE)
    for end in range(len(WHOLE) + 1):
        assert facts(WHOLE[:end]) == {name: FOUND[name] for name, needed in whole.items() if end >= needed}, WHOLE[:end]


def test_a_number_that_may_go_on_is_none() -> None:
    assert facts('{"seen": [], "speed_limit": 2') == {}
    assert facts('{"seen": [], "speed_limit": 25') == {}
    assert facts('{"seen": [], "speed_limit": 25 ')["posted.speed"] == pytest.approx(11.176)


@pytest.mark.parametrize(
    "text",
    [
        '{"not_seen": ["stop sign', '{"seen": ["stop sign"', '{"traffic_light": "red", "stop sign": false}', '{"seen": stop sign}', "{stop sign}",
        '"not_seen": ["stop sign"]', "{" * 20_000 + "stop sign", '{"seen":' * 5_000 + '"stop sign"', '[{"a": [[[[[[[[["stop sign"]]]]]]]]]}]',
    ],
)  # fmt: skip
def test_json_that_is_broken_or_of_another_form_is_never_read_as_prose(text: str) -> None:
    found = read(text)
    assert found.statements == ()
    assert found.set_aside


def test_prose_is_read_by_the_matcher() -> None:
    text = "I see a stop sign and, behind it, END ROAD WORK."
    assert facts(text) == {"sign.stop": True, "sign.end_road_work": True}
    assert read(text).statements[0].frame == "f7"


def test_the_last_sentence_of_prose_that_was_cut_off_does_not_count() -> None:
    text = "A stop sign. The end road work"
    assert {item.fact for item in read(text, cut=True).statements} == {"sign.stop"}
    assert read(text, cut=True).set_aside == (("…", Span(12, 30), "cut off"),)
    assert {item.fact for item in read(text + ".", cut=True).statements} == {"sign.stop", "sign.end_road_work"}
    assert read("a stop sign", cut=True).statements == ()


def test_a_failure_and_silence_say_nothing() -> None:
    assert read("A stop sign.", failure="deadline") == Reading("A stop sign.")
    assert read(" \n") == Reading(" \n")
    assert read_answer(Description("A stop sign."), None, VOCABULARY) == Reading("A stop sign.")


def test_signs_are_read_as_legends_and_rest_on_their_whole_text() -> None:
    text = '{"seen": [], "sign_text": ["END ROAD WORK", "YARD SALE"]}'
    (found,) = read(text).statements
    assert (found.fact, found.value, found.rule) == ("sign.end_road_work", True, "sign_text: end road work")
    assert text[found.spans[0].start : found.spans[0].end] == "END ROAD WORK"


def test_a_fact_said_in_two_ways_is_not_known() -> None:
    text = '{"seen": ["sign.stop", "signal.color=red", "signal.color=green"], "not_seen": ["sign.stop", "sign.end_road_work"]}'
    assert facts(text) == {"sign.end_road_work": False}
    assert aside(text) == {"said in two ways"}


def test_the_words_of_a_set_belong_together() -> None:
    assert facts('{"seen": ["weather.conditions=rain", "weather.conditions=fog"]}') == {"weather.conditions": frozenset({"rain", "fog"})}


def test_the_same_word_twice_is_one_statement_with_two_places() -> None:
    (found,) = read('{"seen": ["sign.stop", "sign.stop"]}').statements
    assert len(found.spans) == 2


@pytest.mark.parametrize(
    ("name", "why"),
    [
        ("sign.halt", "names no fact that a picture shows"), ("ego.speed", "names no fact that a picture shows"),
        ("plan.passes", "names no fact that a picture shows"), ("signal.color", "names no fact that a picture shows"),
        ("signal.color=blue", "names no fact that a picture shows"), ("sign.stop=false", "names no fact that a picture shows"),
        ("none", "none of them"),
    ],
)  # fmt: skip
def test_names_that_mean_nothing_are_not_guessed_at(name: str, why: str) -> None:
    text = json.dumps({"seen": [name]})
    assert (facts(text), aside(text)) == ({}, {why})


def test_an_absence_is_said_of_booleans_only() -> None:
    assert aside('{"seen": [], "not_seen": ["signal.color=green"]}') == {"a word that is not seen says nothing of the others"}


@pytest.mark.parametrize("number", [0, 3, 90, 250, -25, 2.5e7, "fast", "25 ft", True, [25], "1e99", "9" * 400])
def test_numbers_that_no_sign_shows_are_refused(number: object) -> None:
    text = json.dumps({"seen": [], "speed_limit": number})
    assert (facts(text), aside(text)) == ({}, {"no number of a speed limit"})


@pytest.mark.parametrize("number", ["40 km/h", "40 KM/H"])
def test_a_unit_on_the_sign_counts(number: str) -> None:
    assert facts(json.dumps({"seen": [], "speed_limit": number}))["posted.speed"] == pytest.approx(40 / 3.6)


def test_no_number_is_no_finding() -> None:
    assert (facts('{"seen": [], "speed_limit": null}'), aside('{"seen": [], "speed_limit": null}')) == ({}, set())


def test_loose_forms_are_understood() -> None:
    assert facts('{"seen": "sign.stop"}') == {"sign.stop": True}
    assert facts('{"seen": {"sign.stop": true, "sign.end_road_work": false}}') == {"sign.stop": True}
    assert facts('{"seen": ["sign.stop", 5, null, ["x"]], "not_seen": 7}') == {"sign.stop": True}
    assert aside('{"seen": ["sign.stop"], "mood": "good"}') == {"no key of the schema"}


def test_a_very_long_sign_is_read_as_far_as_a_sign_may_be_long() -> None:
    matcher = Words()
    read_answer(Description(json.dumps({"seen": [], "sign_text": ["x" * 500]})), matcher, VOCABULARY, limits=AnswerLimits(sign_length=10))
    assert matcher.shown == ["x" * 10]
