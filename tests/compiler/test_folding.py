"""Contradictions among literals: found where the fact has no value left, and never where the evaluator finds one."""

from collections.abc import Sequence

import pytest
from hypothesis import given
from hypothesis import strategies as st
from regdb_compiler.lint.folding import contradiction, negations
from regdb_compiler.parse_condition import parse_condition

from regdb.condition import And, Compare, Is, Linear, Node, Not, OneOf, Or, evaluate
from regdb.vocabulary import Fact, Value, Vocabulary

VOCABULARY = Vocabulary(
    [
        Fact("b", "boolean"),
        Fact("e", "enumeration", values=("x", "y", "z")),
        Fact("q", "quantity", unit="ft"),
        Fact("c", "count"),
    ]
)


def parts(text: str) -> Sequence[Node]:
    node = parse_condition(text, VOCABULARY).node
    assert isinstance(node, (And, Or))
    return node.parts


@pytest.mark.parametrize(
    ("text", "fact"),
    [
        ("b and not b", "b"),
        ("e == x and e == y", "e"),
        ("e == x and e != x", "e"),
        ("e != x and e != y and e != z", "e"),
        ("q < 3 ft and q > 3 ft", "q"),
        ("3 ft < q and 3 ft >= q", "q"),
        ("c == 2 and not c >= 2", "c"),
    ],
)
def test_contradictions(text: str, fact: str) -> None:
    assert contradiction(parts(text), VOCABULARY) == fact


@pytest.mark.parametrize("text", ["b and e == x", "q <= 3 ft and q >= 3 ft", "e != x and e != y", "q < c * 2 ft and q > 1 ft", "known(b) and not b"])
def test_what_can_be_true(text: str) -> None:
    node = parse_condition(text, VOCABULARY).node
    assert contradiction(node.parts if isinstance(node, And) else (), VOCABULARY) is None


def test_what_is_always_true() -> None:
    assert contradiction(negations(parts("b or not b")), VOCABULARY) == "b"
    assert contradiction(negations(parts("e != x or e != y")), VOCABULARY) == "e"
    assert contradiction(negations(parts("q < 3 ft or q >= 2 ft")), VOCABULARY) == "q"
    assert contradiction(negations(parts("q < 2 ft or q > 3 ft")), VOCABULARY) is None


class Scene:
    """Values of the three facts."""

    def __init__(self, **values: Value) -> None:
        self.values = values

    def value(self, fact: str) -> Value | None:
        return self.values[fact]

    observed = value


literal = st.one_of(
    st.just(Is("b")),
    st.lists(st.sampled_from("xyz"), min_size=1, unique=True).map(lambda words: OneOf("e", tuple(sorted(words)))),
    st.tuples(st.sampled_from(["<", "<=", ">", ">=", "==", "!="]), st.integers(0, 2)).map(
        lambda told: Compare(told[0], Linear(0.0, ((1.0, "q"),)), Linear(float(told[1])))
    ),
)


@given(st.lists(st.tuples(literal, st.booleans()).map(lambda told: Not(told[0]) if told[1] else told[0]), max_size=5))
def test_a_contradiction_has_no_scene(nodes: list[Node]) -> None:
    scenes = [Scene(b=b, e=e, q=q / 2) for b in (True, False) for e in "xyz" for q in range(-1, 6)]
    if contradiction(nodes, VOCABULARY):
        assert not any(evaluate(And(tuple(nodes)), scene) for scene in scenes)
