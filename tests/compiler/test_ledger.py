"""How sections stand: by their file, by the outline, by both."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest
from regdb_compiler.ledger import Account, CodeLedger, count, ledgers, percent
from regdb_compiler.lint.example import build_example

REST = {"10": "Red", "20": "Speed", "30": "Limits", "40": "Local"}
NO_FACT = {"subdivision": "(b)", "status": "not_expressible", "why": "no fact"}
FOR_NONE = {"status": "not_for_ads", "why": "binds riders"}


def state(folder: Path, example: Mapping[str, Any]) -> CodeLedger:
    build = build_example(example, folder)
    assert [item for item in build.diagnostics if item.level == "error"] == []
    return next(item for item in ledgers(build.corpus) if item.jurisdiction.id == "state")


def account(folder: Path, example: Mapping[str, Any], listed: object = "Children") -> Account:
    outline = [{"chapter": "Chapter 1", "sections": {**REST, "100": listed}}]
    return next(item for item in state(folder, {**example, "outline": outline}).accounts if item.section == "100")


@pytest.mark.parametrize(
    ("example", "status", "why"),
    [
        ({}, "encoded", ""),
        ({"omitted": [NO_FACT]}, "partial", "(b): no fact"),
        ({"omitted": None}, "partial", "(b) is neither cited nor omitted"),
        ({"omitted": [{**NO_FACT, "status": "elsewhere"}]}, "encoded", ""),
        ({"regulations": [], "omitted": None}, "unaccounted", ""),
        ({"regulations": [], "omitted": [FOR_NONE]}, "not_for_ads", "binds riders"),
        ({"regulations": [], "omitted": [{**FOR_NONE, "status": "not_expressible"}]}, "not_expressible", "binds riders"),
        ({"regulations": [], "omitted": [{**FOR_NONE, "status": "elsewhere"}]}, "encoded", ""),
        ({"regulations": [], "omitted": None, "definitions": [{"name": "alley", "when": "children.present"}]}, "partial",
         "(a) is neither cited nor omitted; (b) is neither cited nor omitted"),
    ],
)  # fmt: skip
def test_a_file_shows_how_its_section_stands(example: Mapping[str, Any], status: str, why: str, tmp_path: Path) -> None:
    found = account(tmp_path, example)
    assert (found.status, found.why) == (status, why)


def test_every_version_counts(tmp_path: Path) -> None:
    versions = [{"effective": "2000-01-01", "until": "2010-01-01", "omitted": [NO_FACT]}, {"effective": "2010-01-01"}]
    assert account(tmp_path, {"versions": versions}).status == "partial"


def test_the_outline_can_call_a_section_with_rules_partial_and_nothing_else(tmp_path: Path) -> None:
    partial = account(tmp_path / "a", {}, {"heading": "Children", "status": "partial", "why": "hours"})
    refused = account(tmp_path / "b", {}, {"heading": "Children", "status": "not_for_ads", "why": "binds children"})
    assert (partial.status, partial.why) == ("partial", "hours")
    assert (refused.status, refused.claimed) == ("encoded", "not_for_ads")


def test_the_outline_speaks_for_what_has_no_file(tmp_path: Path) -> None:
    outline = [
        {
            "chapter": "Chapter 1",
            "all": {"status": "not_for_ads", "why": "binds builders"},
            "sections": {**REST, "100": "Children", "110": "Alleys"},
            "articles": [
                {"article": "Article 1", "sections": {"120": "Walls"}},
                {"article": "Article 2", "all": {"status": "not_expressible", "why": "no fact"}, "sections": {"130 to 139": "Doors"}},
            ],
        },
        {"chapter": "Chapter 2", "sections": {"200": {"heading": "Dogs", "status": "not_expressible", "why": "no fact"}, "210": "Cats"}},
    ]
    found = {item.section: item for item in state(tmp_path, {"outline": outline}).accounts}
    assert [(name, found[name].status) for name in ("100", "110", "120", "130 to 139", "200", "210")] == [
        ("100", "encoded"), ("110", "not_for_ads"), ("120", "not_for_ads"), ("130 to 139", "not_expressible"),
        ("200", "not_expressible"), ("210", "unaccounted"),
    ]  # fmt: skip
    assert found["120"].group == ("Chapter 1", "Article 1")
    assert [item.section for item in found.values() if item.is_range] == ["130 to 139"]


def test_what_no_outline_lists_is_told(tmp_path: Path) -> None:
    found = state(tmp_path, {"outline": [{"chapter": "Chapter 1", "sections": REST}]})
    assert [item.section for item in found.accounts if not item.listed] == ["100"]
    assert found.accounts[-1].heading == "Children beside the road"


def test_a_code_without_an_outline_is_all_unlisted(tmp_path: Path) -> None:
    found = state(tmp_path, {})
    assert found.outline is None
    assert {item.listed for item in found.accounts} == {False}


def test_an_outline_may_stand_alone(tmp_path: Path) -> None:
    build = build_example({"outline": [{"chapter": "C", "sections": {**REST, "100": "Children"}}]}, tmp_path)
    names = [item.jurisdiction.code for item in ledgers(build.corpus)]
    assert names == ["st", "ci"]


@pytest.mark.parametrize(
    ("listed", "told"),
    [
        ({"heading": "x", "status": "not_for_ads"}, "a status needs its `why`"),
        ({"heading": "x", "why": "because"}, "a status needs its `why`"),
        ({"heading": "x", "status": "encoded", "why": "because"}, "none of partial, not_for_ads, not_expressible"),
        ({"headings": "x"}, "unknown key `headings`"),
    ],
)
def test_what_an_outline_cannot_say_is_an_error(listed: Mapping[str, str], told: str, tmp_path: Path) -> None:
    build = build_example({"outline": [{"chapter": "C", "sections": {**REST, "100": listed}}]}, tmp_path)
    errors = [item for item in build.diagnostics if item.place.path == "codes/st/outline.yaml"]
    assert any(told in item.message for item in errors)
    assert build.corpus.outlines == ()


def test_counts_and_shares(tmp_path: Path) -> None:
    found = state(tmp_path, {"outline": [{"chapter": "C", "sections": {**REST, "100": "Children", "110": "Alleys"}}]})
    counted = count(found.accounts)
    assert (counted["encoded"], counted["unaccounted"]) == (5, 1)
    assert [percent(2, 3), percent(3, 3), percent(0, 0), percent(199, 200)] == [66, 100, 100, 99]
