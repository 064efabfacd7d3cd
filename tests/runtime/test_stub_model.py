"""The stub model: with no errors it tells the truth, its errors come at their rates, and a drive repeats to the bit."""

from __future__ import annotations

import json
from collections.abc import Mapping

import pytest
from regdb_runtime.perception.answer_schema import answer_schema
from regdb_runtime.perception.describer import Frame, Prompt
from regdb_runtime.perception.matcher import Matcher
from regdb_runtime.perception.stub_model import ErrorRates, StubModel
from regdb_runtime.worlds.built_in.build import shipped_vocabulary

from regdb.vocabulary import Value, Vocabulary

TRUTH: Mapping[str, Value] = {"sign.no_turn_on_red": True, "sign.school": False, "school.children_going": True, "weather.conditions": "rain"}
ASKED = ("sign.no_turn_on_red", "sign.school", "school.children_going", "sign.no_right_turn")


@pytest.fixture(scope="module")
def vocabulary() -> Vocabulary:
    return shipped_vocabulary()


def frame(number: int) -> Frame:
    return Frame(f"frame-{number}", number / 2, b"")


def model(vocabulary: Vocabulary, errors: ErrorRates | None = None, seed: int = 0) -> StubModel:
    return StubModel(vocabulary, lambda _: TRUTH, errors, seed)


def schema_prompt(vocabulary: Vocabulary) -> Prompt:
    return Prompt("Look.", answer_schema([vocabulary.facts[name] for name in ASKED]))


def test_asked_by_a_schema_it_answers_in_json_about_what_is_asked(vocabulary: Vocabulary) -> None:
    answer = json.loads(model(vocabulary).describe(frame(0), schema_prompt(vocabulary), 2.0).text)
    assert answer == {"seen": ["school.children_going", "sign.no_turn_on_red"], "not_seen": ["sign.school"]}


def test_asked_freely_it_says_what_the_matcher_reads_back(vocabulary: Vocabulary) -> None:
    text = model(vocabulary).describe(frame(0), Prompt("Examine."), 2.0).text
    found = {item.fact: item.value for item in Matcher(vocabulary).read(text).statements}
    assert found["sign.no_turn_on_red"] is True
    assert found["school.children_going"] is True
    assert "sign.school" not in found


def test_an_answer_that_would_come_too_late_is_none(vocabulary: Vocabulary) -> None:
    late = StubModel(vocabulary, lambda _: TRUTH, takes=3.0).describe(frame(0), Prompt("Examine."), 2.0)
    assert (late.failure, late.text) == ("deadline", "")


@pytest.mark.parametrize(
    ("errors", "wrong"),
    [
        (ErrorRates(miss=0.2), lambda answer: "sign.no_turn_on_red" not in answer["seen"]),
        (ErrorRates(invent=0.2), lambda answer: "sign.school" in answer["seen"]),
    ],
)
def test_errors_come_at_their_rates(vocabulary: Vocabulary, errors: ErrorRates, wrong: object) -> None:
    stub, prompt = model(vocabulary, errors), schema_prompt(vocabulary)
    answers = [json.loads(stub.describe(frame(k), prompt, 2.0).text) for k in range(1000)]
    share = sum(wrong(answer) for answer in answers) / len(answers)  # type: ignore[operator]
    assert share == pytest.approx(0.2, abs=0.05)


def test_a_confused_sign_becomes_one_of_its_look_alikes(vocabulary: Vocabulary) -> None:
    stub, prompt = model(vocabulary, ErrorRates(confuse=1.0)), schema_prompt(vocabulary)
    answer = json.loads(stub.describe(frame(1), prompt, 2.0).text)
    alike = {name.partition("=")[0] for name in vocabulary.facts["sign.no_turn_on_red"].confusables}
    assert "sign.no_turn_on_red" not in answer["seen"]
    assert set(answer["seen"]) & alike


def test_failures_come_at_their_rate_and_everything_repeats(vocabulary: Vocabulary) -> None:
    stub = model(vocabulary, ErrorRates(fail=0.3))
    first = [stub.describe(frame(k), Prompt("Examine."), 2.0) for k in range(400)]
    assert first == [model(vocabulary, ErrorRates(fail=0.3)).describe(frame(k), Prompt("Examine."), 2.0) for k in range(400)]
    assert sum(bool(item.failure) for item in first) / 400 == pytest.approx(0.3, abs=0.07)
    assert first != [model(vocabulary, ErrorRates(fail=0.3), seed=1).describe(frame(k), Prompt("Examine."), 2.0) for k in range(400)]
