"""Jurisdictions: paths, what governs a place, and trees that are none."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from regdb.jurisdiction import Jurisdiction, JurisdictionError, JurisdictionTree

MODEL = Jurisdiction("model", "Model", "model", status="model", code="uvc")
STATE = Jurisdiction("state", "State", "state", parent="model", code="cvc")
CITY = Jurisdiction("city", "City", "city", parent="state", code="lamc")
COUNTY = Jurisdiction("county", "County", "county", parent="state")
TREE = JurisdictionTree((CITY, COUNTY, STATE, MODEL))


@st.composite
def trees(draw: st.DrawFn) -> JurisdictionTree:
    """A random forest; parents come before children, some are model codes."""
    found: list[Jurisdiction] = []
    for number in range(draw(st.integers(1, 8))):
        parent = draw(st.sampled_from([None, *(item.id for item in found)]))
        found.append(Jurisdiction(f"j{number}", f"J{number}", parent=parent, status=draw(st.sampled_from(("law", "model")))))
    return JurisdictionTree(found)


def test_a_path_goes_from_the_root_down() -> None:
    assert [item.id for item in TREE.path("city")] == ["model", "state", "city"]
    assert [item.id for item in TREE.path("uvc")] == ["model"]


def test_siblings_do_not_stand_above_each_other() -> None:
    assert TREE.is_ancestor("state", "city")
    assert TREE.is_ancestor("cvc", "lamc")
    assert not TREE.is_ancestor("county", "city")
    assert not TREE.is_ancestor("city", "city")


def test_a_model_code_answers_only_where_no_law_is_loaded() -> None:
    everything = frozenset({"model", "state", "city", "county"})
    assert TREE.governing("city", everything) == {"state", "city"}
    assert TREE.governing("model", everything) == {"model"}
    assert TREE.governing("city", frozenset({"model"})) == {"model", "state", "city"}
    assert TREE.governing("county", frozenset({"model", "city"})) == {"model", "state", "county"}


@given(trees(), st.data())
def test_what_governs_lies_on_the_path_and_model_law_never_beside_enacted_law(tree: JurisdictionTree, data: st.DataObject) -> None:
    ids = [item.id for item in tree]
    place = data.draw(st.sampled_from(ids))
    loaded = frozenset(data.draw(st.sets(st.sampled_from(ids))))
    path = {item.id for item in tree.path(place)}
    found = tree.governing(place, loaded)
    assert {item.id for item in tree.path(place) if item.status == "law"} <= found <= path
    models = {name for name in found if tree.get(name).status == "model"}
    assert not models or not any(tree.get(name).status == "law" and name in loaded for name in path)


@given(trees())
def test_ancestors_are_the_path_without_its_end(tree: JurisdictionTree) -> None:
    for item in tree:
        above = {other.id for other in tree if tree.is_ancestor(other.id, item.id)}
        assert above == {other.id for other in tree.path(item.id)} - {item.id}


@pytest.mark.parametrize(
    ("items", "message"),
    [
        ([Jurisdiction("a", "A", parent="b")], "not declared"),
        ([Jurisdiction("a", "A", parent="b"), Jurisdiction("b", "B", parent="a")], "circle"),
        ([Jurisdiction("a", "A", parent="a")], "circle"),
    ],
)
def test_what_is_no_tree_is_refused(items: list[Jurisdiction], message: str) -> None:
    with pytest.raises(JurisdictionError, match=message):
        JurisdictionTree(items)


def test_an_unknown_name_lists_the_known_ones() -> None:
    with pytest.raises(JurisdictionError, match="known: city, county, model, state"):
        TREE.get("narnia")
    assert "narnia" not in TREE
    assert "lamc" in TREE


def test_only_local_law_needs_authority() -> None:
    assert [item.id for item in TREE if item.is_local] == ["city", "county"]
