"""The matcher's places, relations and context: spans into the text as received, what is set aside and why, what entails what."""

import pytest
from regdb_runtime.database import RegulationDatabase
from regdb_runtime.perception.evidence import Reading
from regdb_runtime.perception.lexicon import PhraseError
from regdb_runtime.perception.matcher import Matcher
from regdb_runtime.perception.normalise import normalise
from regdb_runtime.perception.sentences import sentences

from regdb.front import database
from regdb.vocabulary import Fact, Value, Vocabulary


@pytest.fixture(scope="module")
def matcher() -> Matcher:
    return Matcher(RegulationDatabase.open(database()).vocabulary)


def words(reading: Reading, fact: str) -> list[str]:
    """The words each statement on the fact rests on."""
    return [" ".join(reading.text[span.start : span.end] for span in item.spans) for item in reading.statements if item.fact == fact]


def asserted(reading: Reading) -> dict[str, Value]:
    return {item.fact: item.value for item in reading.statements if item.certainty == "asserted"}


@pytest.mark.parametrize("text", [
    "A “stop sign” stands here.", "A \uff53\uff54\uff4f\uff50 \uff53\uff49\uff47\uff4e stands here.",
    "🚦 ½ mile: a **stop sign**!", "A stop\u2011sign.", "• a stop\u00a0sign", "A STOP SIGN",
])  # fmt: skip
def test_spans_lie_in_the_text_as_received(matcher: Matcher, text: str) -> None:
    (found,) = words(matcher.read(text), "sign.stop")
    assert normalise(found).text.replace("-", " ").strip() == "stop sign"


def test_evidence_carries_where_it_came_from(matcher: Matcher) -> None:
    (item,) = matcher.read("Stop", captured=3.5, frame="f7", prompt="lane_following", model="llava").statements
    assert (item.fact, item.value, item.source, item.captured) == ("sign.stop", True, "model", 3.5)
    assert (item.frame, item.prompt, item.model, item.rule) == ("f7", "lane_following", "llava", "phrase '^stop'")


def test_silence_says_nothing(matcher: Matcher) -> None:
    assert matcher.read("").statements == ()
    assert matcher.read("A picture of something else.\n\n- \n").statements == ()


@pytest.mark.parametrize(("text", "why"), [
    ("If the light turns red, stop.", "conditional"), ("Wait until the light is red.", "until"), ("The light will be red.", "future"),
    ("Is the light red?", "question"), ("The light for the cross street is red.", "other road user"), ("The light is not red.", "denied"),
    ("The red light has disappeared.", "ended"),
])  # fmt: skip
def test_what_is_set_aside_says_why(matcher: Matcher, text: str, why: str) -> None:
    reading = matcher.read(text)
    assert "signal.color" not in asserted(reading)
    assert why in {reason for name, _, reason in reading.set_aside if name == "signal.color"}


def test_a_doubt_is_kept_as_one(matcher: Matcher) -> None:
    (item,) = [item for item in matcher.read("There may be a stop sign.").statements if item.fact == "sign.stop"]
    assert (item.value, item.certainty) == (True, "hedged")


def test_a_fact_entails_others_and_a_denial_none(matcher: Matcher) -> None:
    said = asserted(matcher.read("A person walks in the crosswalk."))
    assert said["pedestrian.in_crosswalk"] is said["pedestrian.present"] is said["crosswalk.present"] is True
    denied = asserted(matcher.read("There are no people in the crosswalk."))
    assert denied["pedestrian.in_crosswalk"] is False
    assert "crosswalk.present" not in denied


def test_the_longest_phrase_wins_and_a_swallowing_one_says_nothing(matcher: Matcher) -> None:
    assert asserted(matcher.read("STOP HERE ON RED")) == {"sign.stop_here_on_red": True}
    assert asserted(matcher.read("Its brake lights are red.")) == {}
    assert asserted(matcher.read("There is no parking lot.")) == {"place.parking_lot": False}


@pytest.mark.parametrize(("text", "colors"), [
    ("red and green lights", ["red", "green"]), ("It turned yellow, then red.", []), ("The light turned yellow, then red.", ["red"]),
    ("There is a traffic light. It is green.", ["green"]), ("The red car waits at the light.", []),
    ("The light is red or yellow.", ["red", "yellow"]),
])  # fmt: skip
def test_colours_belong_to_lights(matcher: Matcher, text: str, colors: list[str]) -> None:
    assert [item.value for item in matcher.read(text).statements if item.fact == "signal.color"] == colors


def test_speeds_are_in_metres_a_second_and_of_their_kind(matcher: Matcher) -> None:
    said = asserted(matcher.read("Speed limit 60 km/h, minimum speed 40 km/h; the advisory speed is 30 mph and we drive 55 km/h."))
    assert said["posted.speed"] == pytest.approx(60 / 3.6)
    assert said["posted.minimum_speed"] == pytest.approx(40 / 3.6)
    assert said["posted.advisory_speed"] == pytest.approx(30 * 0.44704)


def test_number_words_units_and_abbreviations() -> None:
    first, second = sentences(normalise("At 5 p.m. on Main St. the limit is thirty-five miles per hour. Dr. Who waits."))
    assert [(number.value, number.unit) for number in first.numbers.values()] == [(5.0, ""), (35.0, "mph")]
    assert second.words == ["dr", ".", "who", "wait"]


def test_statements_stand_in_the_order_of_the_text(matcher: Matcher) -> None:
    found = [item.spans[0].start for item in matcher.read("A cyclist, a bus stop and a roundabout.").statements]
    assert found == sorted(found)


def test_a_vocabulary_of_ones_own(matcher: Matcher) -> None:
    own = Vocabulary([Fact("cow.ahead", "boolean", phrases={"": ("{cow} ~ road",)})], words={"cow": ("cow", "highland cattle")})
    assert asserted(Matcher(own).read("Highland cattle stand on the road.")) == {"cow.ahead": True}
    with pytest.raises(PhraseError, match="cow"):
        Matcher(Vocabulary([Fact("cow.ahead", "boolean", phrases={"": ("{cow} ~ road",)})]))
    assert matcher.vocabulary.words["swallow"]
