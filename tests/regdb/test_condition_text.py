"""Conditions as text and as JSON: both lead back to the same tree."""

from __future__ import annotations

import json
from typing import Any

import pytest
from hypothesis import given
from random_law import VOCABULARY, literals, trees
from regdb_compiler.parse_condition import parse_condition

from regdb.condition import Compare, Is, Linear, Node, Not, OneOf, Within
from regdb.condition_text import from_data, from_json, linear_from_data, linear_to_data, show, show_linear, to_data, to_json


@given(trees(literals, 12))
def test_parsing_what_is_shown_gives_the_same_tree(node: Node) -> None:
    parsed = parse_condition(show(node), VOCABULARY)
    assert parsed.problems == ()
    assert parsed.node == node


@given(trees(literals, 12))
def test_showing_what_is_parsed_gives_the_same_text(node: Node) -> None:
    text = show(node)
    again = parse_condition(text, VOCABULARY).node
    assert again is not None
    assert show(again) == text


@given(trees(literals, 12))
def test_json_leads_back_to_the_same_tree(node: Node) -> None:
    text = to_json(node)
    assert "\n" not in text
    assert from_json(text) == node
    assert from_data(json.loads(json.dumps(to_data(node)))) == node


@pytest.mark.parametrize(
    "text",
    [
        "red", "not red", "signal.color != red", "signal.color in {green, red}", "ramp in road.types", "known(red)", "ego.speed <= 25 mph",
        "ego.speed <= posted.speed - 5 mph", "ego.speed < 2 * posted.speed", "-ego.speed + posted.speed > 10 km/h", "clock.time within 22:00..05:00",
        "clock.date within 2026-01-01..2026-07-01", "lanes >= 3", "red and (stopped or officer) and not (red and stopped)", "not not red",
        "true", "false", "clock.time >= 07:30:15", "gap < 2.5 ft",
    ],
)  # fmt: skip
def test_canonical_text_is_shown_as_written(text: str) -> None:
    node = parse_condition(text, VOCABULARY).node
    assert node is not None
    assert show(node) == text


@pytest.mark.parametrize(
    "data",
    [[], ["xor", ["is", "a"]], ["not"], ["is", 1], ["const", 1], ["in", "a", "b"],
     ["cmp", "=", [0, []], [0, []], "", ""], ["within", "a", "b", 2, "time"],
     "is", None, ["cmp", "<", [0], [0, []], "", ""], ["and", 3]],
)  # fmt: skip
def test_what_is_no_tree_is_refused(data: Any) -> None:
    with pytest.raises(ValueError, match=r"not a condition tree|not enough values"):
        from_data(data)


def test_linear_expressions_go_both_ways() -> None:
    expression = Linear(-2.2352, ((1.0, "posted.speed"), (-0.5, "ego.speed")))
    assert linear_from_data(linear_to_data(expression)) == expression
    assert show_linear(expression, "quantity", "mph") == "posted.speed - 0.5 * ego.speed - 5 mph"


def test_parentheses_stand_only_where_they_are_needed() -> None:
    assert show(Not(OneOf("signal.color", ("green", "red")))) == "not signal.color in {green, red}"
    assert show(Not(Not(Is("red")))) == "not not red"
    assert show(Compare("<", Linear(0.0, ((1.0, "clock.time"),)), Linear(27000.0), "time", "")) == "clock.time < 07:30"
    assert show(Within("clock.time", 79200, 18000)) == "clock.time within 22:00..05:00"
