"""Facts: reading what people write, showing it again, refusing what cannot be."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from random_law import VOCABULARY, known_facts

from regdb.vocabulary import Fact, FactError, Value, Vocabulary, read_date, read_time

RED = Fact("signal.color", "enumeration", values=("red", "green", "none"))
SPEED = Fact("ego.speed", "quantity", unit="mph")


@given(known_facts())
def test_what_is_shown_is_read_back(facts: dict[str, Value]) -> None:
    for name, value in facts.items():
        fact = VOCABULARY.fact(name)
        assert fact.read(fact.show(value)) == value


@pytest.mark.parametrize("fact", list(VOCABULARY), ids=lambda fact: fact.name)
def test_unknown_reads_as_unknown_whatever_the_type(fact: Fact) -> None:
    assert fact.read("unknown") is None
    assert fact.read(None) is None
    assert fact.show(None) == "unknown"


@pytest.mark.parametrize(
    ("fact", "text", "message"),
    [
        (RED, "gren", "did you mean green"), (RED, "blue", "one of: red, green, none"),
        (SPEED, "30", "unit of speed"), (SPEED, "30 ft", "unit of speed"),
        (SPEED, "fast", "not a number"), (SPEED, True, "not true"), (Fact("sign.stop", "boolean"), "yes", "true, false or unknown"),
        (Fact("sign.stop", "boolean"), 1, "true, false or unknown"), (Fact("lanes", "count"), "3 mph", "a bare number"),
        (Fact("t", "time"), "7.30", "write it as 07:30"), (Fact("t", "time"), "24:01", "no time"), (Fact("t", "time"), "12:60", "no time"),
        (Fact("d", "date"), "2026-2-3", "no date"), (Fact("d", "date"), "2026-02-30", "no date"),
        (Fact("s", "set", values=("a", "b")), ["a", "c"], "cannot be 'c'"),
    ],
)  # fmt: skip
def test_a_value_it_cannot_have_is_refused_with_what_would_be_right(fact: Fact, text: Any, message: str) -> None:
    with pytest.raises(FactError, match=message):
        fact.read(text)


@pytest.mark.parametrize(
    ("fact", "text", "value"),
    [
        (RED, "red", "red"), (SPEED, "25 mph", 11.176), (SPEED, "36 km/h", 10.0),
        (Fact("b", "boolean"), "true", True), (Fact("b", "boolean"), False, False),
        (Fact("s", "set", values=("a", "b")), "{a, b}", frozenset("ab")), (Fact("s", "set", values=("a", "b")), [], frozenset()),
        (Fact("t", "time"), "7:00", 25200), (Fact("t", "time"), "24:00", 86400), (Fact("d", "date"), "0001-01-02", 2), (Fact("n", "count"), "3", 3.0),
    ],
)  # fmt: skip
def test_a_value_is_read_by_the_facts_type(fact: Fact, text: Any, value: Value) -> None:
    assert fact.read(text) == value


@given(st.integers(0, 86399))
def test_times_go_both_ways(second: int) -> None:
    assert read_time(Fact("t", "time").show(second)) == second


@given(st.dates())
def test_dates_go_both_ways(date: Any) -> None:
    assert read_date(date.isoformat()) == date.toordinal()
    assert Fact("d", "date").show(date.toordinal()) == date.isoformat()


@pytest.mark.parametrize(
    ("fact", "dimension"),
    [(SPEED, "speed"), (Fact("n", "count"), "number"), (Fact("t", "time"), "time"),
     (Fact("d", "date"), "date"), (RED, ""), (Fact("b", "boolean"), "")],
    ids=lambda value: getattr(value, "kind", value),
)
def test_dimensions(fact: Fact, dimension: str) -> None:
    assert fact.dimension == dimension
    assert fact.is_numeric == bool(dimension)


def test_an_unknown_fact_names_the_nearest() -> None:
    words = Vocabulary([RED, SPEED])
    with pytest.raises(FactError, match=r"did you mean ego\.speed"):
        words.fact("ego.sped")
    assert words.nearest("vehicle.color") == "signal.color"
    assert words.hint("zzz") == ""
    assert "ego.speed" in words
    assert len(words) == 2
    assert [fact.name for fact in words] == ["signal.color", "ego.speed"]
