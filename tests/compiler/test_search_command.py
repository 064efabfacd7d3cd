"""`regdb search` as typed: words in any form, never search syntax; the law of the place and day."""

import json
from pathlib import Path
from typing import Any

import pytest

from regdb.cli import main


@pytest.fixture
def search(small_codes: Path, own_cache: Path, capsys: pytest.CaptureFixture[str]) -> Any:  # noqa: ARG001
    def run(*arguments: str, code: int = 0) -> str:
        with pytest.raises(SystemExit) as caught:
            main(["search", "--codes", str(small_codes), *arguments])
        assert caught.value.code == code
        return capsys.readouterr().out

    return run


def _ids(out: str) -> list[str]:
    return [hit["id"] for hit in json.loads(out)["hits"]]


@pytest.mark.parametrize(
    ("words", "found"),
    [
        (["sounds"], ["cvc-22350-b"]),
        (["driving", "sign"], ["cvc-22350-a"]),
        (["bicycl"], ["cvc-22348-b"]),
        (["22350"], ["cvc-22350-a", "cvc-22350-b"]),
        (['over" AND ('], ["cvc-22348-b"]),
        (['("NEAR" *'], ["la_city-80.14-a"]),
        (["school", "zebra"], ["la_city-80.14-a"]),
    ],
)
def test_words_are_found(search: Any, words: list[str], found: list[str]) -> None:
    assert sorted(_ids(search(*words, "--format", "json"))) == found


def test_the_condition_counts_more_than_the_section_s_text(search: Any) -> None:
    assert _ids(search("siren", "--format", "json")) == ["cvc-22350-b", "cvc-22350-a"]


def test_text_marks_the_words_and_names_the_citation(search: Any) -> None:
    out = search("trucks", "--on", "2026-03-02")
    assert "CVC 22348(b)  Excessive speed  (cvc-22348-b)" in out
    assert "*trucks*" in out
    assert out.endswith("1 found; law as of 2026-03-02\n")
    assert max(map(len, out.splitlines())) <= 80


def test_the_day_the_place_and_the_limit_count(search: Any) -> None:
    assert _ids(search("trucks", "--on", "1990-01-01", "--format", "json", code=1)) == []
    assert _ids(search("school", "--in", "california", "--format", "json", code=1)) == []
    assert _ids(search("speed", "--limit", "1", "--format", "json")) != []
    assert len(_ids(search("speed", "--limit", "1", "--format", "json"))) == 1


@pytest.mark.parametrize("words", ["zebra", "***", '"'])
def test_nothing_found_is_a_finding(search: Any, words: str) -> None:
    assert "nothing found" in search(words, code=1)
