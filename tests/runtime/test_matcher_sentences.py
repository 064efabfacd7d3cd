"""Sentences written for every key of a driving scene: plain, denied, hedged, conditional, about something else, ended."""

from collections.abc import Iterator
from pathlib import Path

import pytest
import yaml
from regdb_runtime.database import RegulationDatabase
from regdb_runtime.perception.matcher import Matcher

from regdb.front import database
from regdb.vocabulary import Value

DATA = yaml.safe_load((Path(__file__).parent / "data" / "matcher_sentences.yaml").read_text())
WAYS = ("plain", "negated", "hedged", "conditional", "other", "ended")


@pytest.fixture(scope="module")
def matcher() -> Matcher:
    return Matcher(RegulationDatabase.open(database()).vocabulary)


def sentences() -> Iterator[tuple[str, str, str]]:
    for key, ways in DATA.items():
        for way, texts in ways.items():
            yield from ((key, way, text) for text in texts)


def asserted(matcher: Matcher, key: str, text: str) -> set[bool]:
    """{True} where the text asserts the key, {False} where it denies it, both or neither as it may be."""
    name, _, word = key.partition("=")
    fact = matcher.vocabulary.fact(name)
    found = set()
    for item in matcher.read(text).statements:
        if item.fact == name and item.certainty == "asserted":
            found.add(holds(item.value, fact.read([word] if fact.kind == "set" else word)) if word else item.value is not False)
    return found


def holds(value: Value, wanted: Value | None) -> bool:
    if isinstance(value, float) and isinstance(wanted, float):
        return abs(value - wanted) < 1e-6
    return value == wanted


@pytest.mark.parametrize(("key", "way", "text"), tuple(sentences()))
def test_sentence(matcher: Matcher, key: str, way: str, text: str) -> None:
    found = asserted(matcher, key, text)
    if way == "plain":
        assert True in found
    elif way == "negated" and "=" not in key and key not in VALUELESS:
        assert found == {False}
    else:
        assert True not in found


VALUELESS = ("signal.flashing", "lane.ends", "signal.inoperative")
"""Denying these states nothing worth keeping; the sentences only must not assert them."""


def test_every_key_has_six_sentences() -> None:
    for key, ways in DATA.items():
        assert set(ways) == set(WAYS), key
        assert sum(len(texts) for texts in ways.values()) >= 6, key
        assert ways["plain"], key
