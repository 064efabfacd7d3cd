"""fmt: canonical, idempotent, comments and meaning kept."""

import random
from pathlib import Path

import pytest
from regdb_compiler import documents
from regdb_compiler.fmt import format_text, model_of
from regdb_compiler.parse import to_data
from regdb_compiler.source import parse_text

SECTION = """\
section: "1"
title: T   # a title
location: [A]
topic: t
source: {checked: 2026-01-01, url: u, confidence: seen}
# before the versions
versions:
  - text: |
      (a) First.
        indented # no comment

    effective: 2020-01-01
    regulations:
      - result: must not
        id: a
        legality: false
        condition: {when: 'sign.stop   and(ego.speed>25mph)', text: Some words.}
        tests: []
"""


def test_keys_get_the_schema_s_order_and_conditions_one_spacing() -> None:
    result = format_text(SECTION, documents.Section)
    assert result.problem == ""
    lines = [line.strip() for line in result.text.splitlines()]
    assert lines.index("- effective: 2020-01-01") < lines.index("text: |")
    assert "sign.stop and ego.speed > 25 mph" in result.text
    assert "source: {url: u, checked: 2026-01-01, confidence: seen}" in result.text


def test_comments_stay_and_meaning_stays() -> None:
    result = format_text(SECTION, documents.Section)
    assert "# a title" in result.text
    assert "# before the versions" in result.text
    assert "  indented # no comment" in result.text
    before, after = parse_text(SECTION, "a"), parse_text(result.text, "a")
    assert before.root is not None
    assert after.root is not None
    old, new = to_data(before.root), to_data(after.root)
    assert old["versions"][0]["text"] == new["versions"][0]["text"]
    assert old["versions"][0]["effective"] == new["versions"][0]["effective"]


@pytest.mark.parametrize("scalar", ["22349.10", "7:00", "no", "0500", "2002-01-01", "'1e3'", '"null"', "~"])
def test_scalars_stay_as_typed(scalar: str) -> None:
    text = SECTION.replace("title: T ", f"title: {scalar} ")
    assert f"title: {scalar} " in format_text(text, documents.Section).text


def test_what_cannot_be_read_is_left_alone() -> None:
    result = format_text("a: [1,\n", documents.Section)
    assert result.text == "a: [1,\n"
    assert result.problem == "line 1: no value can begin with this character"


def shuffled(text: str, seed: int) -> str:
    """The same section with the keys of its source mapping and its tests' scenes in another order."""
    chooser = random.Random(seed)
    parts = ["checked: 2026-01-01", "url: u", "confidence: seen", "note: n"]
    chooser.shuffle(parts)
    return text.replace("{checked: 2026-01-01, url: u, confidence: seen}", "{" + ", ".join(parts) + "}")


@pytest.mark.parametrize("seed", range(12))
def test_order_of_keys_does_not_matter_to_the_form(seed: int) -> None:
    assert format_text(shuffled(SECTION, seed), documents.Section).text == format_text(shuffled(SECTION, 99), documents.Section).text


def test_every_shipped_file_is_in_canonical_form_and_stays_there(codes: Path) -> None:
    for path in sorted(codes.rglob("*.yaml")):
        model = model_of(path.relative_to(codes).parts)
        if model is not None:
            text = path.read_text("utf-8")
            result = format_text(text, model)
            assert result.problem == "", path
            assert result.text == text, f"{path}: run `regdb fmt`"
