"""JSON as models write it: whatever the text, nothing is raised, and what is read stands whole in it."""

import json
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from regdb_runtime.perception.partial_json import DEPTH, Piece, first_object

SCALARS = st.none() | st.booleans() | st.integers(-1000, 1000) | st.floats(-1e6, 1e6) | st.text(max_size=8)
VALUES = st.recursive(SCALARS, lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=4), inner, max_size=3), max_leaves=6)
OBJECTS = st.dictionaries(st.text(min_size=1, max_size=5), VALUES, min_size=1, max_size=4)


def plain(piece: Piece) -> Any:
    """A piece as json would have read it."""
    if isinstance(piece.value, dict):
        return {name: plain(item) for name, item in piece.members().items()}
    return [plain(item) for item in piece.items()] if isinstance(piece.value, list) else piece.value


def depth(value: Any) -> int:
    inner = value.values() if isinstance(value, dict) else value if isinstance(value, list) else ()
    return 1 + max(map(depth, inner), default=0) if isinstance(value, (dict, list)) else 0


@settings(max_examples=200, deadline=None)
@given(OBJECTS.filter(lambda value: depth(value) < DEPTH), st.sampled_from([None, 1]), st.booleans())
def test_whole_json_is_read_as_json_reads_it(value: dict[str, Any], indent: int | None, ascii_only: bool) -> None:
    text = json.dumps(value, indent=indent, ensure_ascii=ascii_only)
    found = first_object("Sure!\n```json\n" + text + "\n```")
    assert found is not None
    assert (plain(found), found.cut) == (value, False)


def whole_parts(part: Any, value: Any) -> bool:
    """Whether a part has nothing that the whole has not, in its place."""
    if isinstance(part, dict):
        return isinstance(value, dict) and all(name in value and whole_parts(item, value[name]) for name, item in part.items())
    if isinstance(part, list):
        return isinstance(value, list) and len(part) <= len(value) and all(map(whole_parts, part, value))
    return bool(part == value)


@settings(max_examples=200, deadline=None)
@given(OBJECTS.filter(lambda value: depth(value) < DEPTH), st.data())
def test_of_json_cut_off_only_whole_parts_are_read(value: dict[str, Any], data: st.DataObject) -> None:
    text = json.dumps(value)
    end = data.draw(st.integers(1, len(text) - 1))
    found = first_object(text[:end])
    if found is not None and found.start == 0:
        assert found.cut
        assert whole_parts(plain(found), value)


@settings(max_examples=300, deadline=None)
@given(st.text(alphabet='{}[]":,\\ \n0123456789.eE+-truefalsn', max_size=60) | st.text(max_size=40))
def test_no_text_raises(text: str) -> None:
    found = first_object(text)
    if found is not None:
        assert text[found.start] == "{"
        assert found.start < found.end <= len(text)


@pytest.mark.parametrize(
    "text",
    ['{"a":' * 3000 + "1" + "}" * 3000, "[" * 100_000, "{" * 100_000, '{"' * 50_000, '{"a": "' + "\\" * 99_999, '{"a": ' + "9" * 100_000 + "}"],
)
def test_garbage_is_done_with_quickly_and_without_a_deep_stack(text: str) -> None:
    found = first_object(text)
    assert found is None or text[found.start] == "{"
    assert found is None or found.start < found.end <= len(text)


def test_places_are_those_of_the_text() -> None:
    text = 'so: {"seen": ["a", "b\\"c"], "n": 25}'
    found = first_object(text)
    assert found is not None
    items = found.members()["seen"].items()
    assert [text[item.start : item.end] for item in items] == ['"a"', '"b\\"c"']
    assert text[found.members()["n"].start : found.members()["n"].end] == "25"
    assert text[found.start : found.end] == text[4:]


@pytest.mark.parametrize("text", ["", "no object", "[1, 2]", '{"a"', '{"a":', '{"a": tru', "{a: 1}", "{'a': 1}", '{"a": 1'])
def test_nothing_whole_is_nothing(text: str) -> None:
    found = first_object(text)
    assert found is None or found.members() == {}


def test_an_empty_object_is_one() -> None:
    found = first_object("{}")
    assert found is not None
    assert (found.members(), found.cut) == ({}, False)


def test_the_first_object_with_members_counts() -> None:
    found = first_object('{maybe} {} {"seen": []} {"seen": ["x"]}')
    assert found is not None
    assert (found.start, plain(found)) == (11, {"seen": []})
