"""Every fact of the vocabulary has one teller; nobody's facts are listed with the reason."""

from collections import Counter
from dataclasses import replace

from regdb_runtime.scenes import tellers as module
from regdb_runtime.scenes.tellers import UNTOLD, eye_facts, surveyed_facts, tellers
from small_worlds import law, quiet_eye

from regdb.situation import quiet_facts
from regdb.vocabulary import Fact, Vocabulary

SETS = {name: value for name, value in vars(module).items() if name.endswith("_FACTS") and isinstance(value, frozenset)}


def test_no_fact_is_claimed_twice() -> None:
    claims = Counter(fact for facts in [*SETS.values(), frozenset(UNTOLD)] for fact in facts)
    assert [fact for fact, count in claims.items() if count > 1] == []


def test_every_claimed_fact_is_in_the_vocabulary() -> None:
    names = set(law().vocabulary.facts)
    for claimed, facts in SETS.items():
        assert facts <= names, claimed
    assert set(UNTOLD) <= names


def test_every_fact_has_a_teller_and_those_of_nobody_are_listed_with_a_reason() -> None:
    found = tellers(law().vocabulary)
    assert set(found) == set(law().vocabulary.facts)
    assert {fact for fact, teller in found.items() if teller == "nobody"} == set(UNTOLD)
    assert all(len(reason) > 20 for reason in UNTOLD.values())


def test_perception_is_told_by_lights_map_tracks_judgement_or_the_eye() -> None:
    found = tellers(law().vocabulary)
    perceived = {found[fact.name] for fact in law().vocabulary if fact.source == "perception" and fact.name not in UNTOLD}
    assert perceived == {"light", "posted", "track", "judged", "eye"}
    assert eye_facts(law().vocabulary) == {fact for fact, teller in found.items() if teller == "eye"}


def test_a_fact_new_to_the_vocabulary_is_told_by_its_source() -> None:
    vocabulary = Vocabulary([Fact("goat.ahead", "boolean", source="perception"), Fact("hill.steep", "boolean", source="map")])
    assert dict(tellers(vocabulary)) == {"goat.ahead": "eye", "hill.steep": "map"}


def test_a_surveyed_map_tells_quiet_values_of_what_maps_tell_alone() -> None:
    surveyed = surveyed_facts(law().vocabulary)
    quiet = quiet_facts(law().vocabulary)
    assert surveyed["rail.crossing_ahead"] is False
    assert surveyed["sign.speed_limit"] is False
    assert all(quiet[name] == value for name, value in surveyed.items())
    assert not set(surveyed) & set(quiet_eye())
    assert "posted.speed" not in surveyed
    assert "lane.width" not in surveyed


def test_a_vocabulary_is_asked_once() -> None:
    vocabulary = law().vocabulary
    assert tellers(vocabulary) is tellers(vocabulary)
    fact = vocabulary.fact("lead.present")
    assert tellers(Vocabulary([replace(fact, name="lead.purple")]))["lead.purple"] == "eye"
