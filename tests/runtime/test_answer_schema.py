"""The schema of sparse answers: what it lets through is what the reader understands."""

import jsonschema
import pytest
from regdb_runtime.perception.answer_schema import AnswerLimits, answer_schema, can_be_asked, names_of, read_name

from regdb.vocabulary import Fact, Vocabulary

SAID = {"true": ("words",)}
STOP = Fact("sign.stop", "boolean", phrases=SAID)
COLOR = Fact("signal.color", "enumeration", values=("none", "red", "green"), phrases={"red": ("red",)})
WEATHER = Fact("weather.conditions", "set", values=("rain", "fog"), phrases={"rain": ("rain",)})
DISTANCE = Fact("hydrant.distance", "quantity", unit="ft", phrases={"": ("hydrant {n}",)})
UNSPOKEN = Fact("sign.odd", "boolean")
SPEED = Fact("ego.speed", "quantity", unit="mph", source="ego", phrases=SAID)
VOCABULARY = Vocabulary([STOP, COLOR, WEATHER, DISTANCE, UNSPOKEN, SPEED])


def valid(answer: object, *facts: Fact) -> bool:
    schema = answer_schema(facts or tuple(VOCABULARY))
    jsonschema.Draft202012Validator.check_schema(schema)
    return bool(jsonschema.Draft202012Validator(schema).is_valid(answer))


@pytest.mark.parametrize(
    "answer",
    [
        {"seen": []}, {"seen": ["sign.stop", "signal.color=red", "weather.conditions=fog"]}, {"seen": [], "not_seen": ["sign.stop"]},
        {"seen": [], "sign_text": ["STOP"], "speed_limit": 25},
    ],
)  # fmt: skip
def test_sparse_answers_are_valid(answer: object) -> None:
    assert valid(answer)


@pytest.mark.parametrize(
    "answer",
    [
        {}, [], {"seen": ["sign.halt"]}, {"seen": ["signal.color=none"]}, {"seen": ["sign.odd"]}, {"seen": ["ego.speed"]},
        {"seen": ["hydrant.distance"]},
        {"seen": [], "not_seen": ["signal.color=red"]}, {"seen": [], "speed_limit": 250}, {"seen": [], "speed_limit": 25.5},
        {"seen": [], "sign_text": ["x" * 81]}, {"seen": [], "sign_text": ["a"] * 5}, {"seen": [], "mood": "good"}, {"seen": ["sign.stop"] * 13},
    ],
)  # fmt: skip
def test_anything_else_is_not(answer: object) -> None:
    assert not valid(answer)


def test_every_name_of_a_schema_is_read_as_its_fact() -> None:
    for fact in VOCABULARY:
        for name in names_of(fact) if can_be_asked(fact) else ():
            found = read_name(name, VOCABULARY)
            assert found is not None
            assert found[0] is fact
    assert read_name("signal.color=red", VOCABULARY) == (COLOR, "red")
    assert read_name("weather.conditions=rain", VOCABULARY) == (WEATHER, frozenset({"rain"}))
    assert read_name(" sign.stop ", VOCABULARY) == (STOP, True)


def test_nothing_to_ask_leaves_signs_and_the_limit() -> None:
    schema = answer_schema((SPEED,), AnswerLimits(signs=1))
    assert schema["properties"]["seen"]["maxItems"] == 0
    assert "not_seen" not in schema["properties"]
    assert schema["properties"]["sign_text"]["maxItems"] == 1
