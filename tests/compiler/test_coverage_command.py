"""`regdb coverage` from its arguments to its exit code."""

import json
from pathlib import Path
from typing import Any

import pytest
from regdb_compiler.lint.example import write_example

from regdb.cli import main

REST: dict[str, Any] = {"10": "Red", "20": "Speed", "30": "Limits", "40": "Local"}
ALLEYS = {"heading": "Alleys", "status": "not_expressible", "why": "no fact of the small world tells an alley from a street"}


def run(capsys: pytest.CaptureFixture[str], *arguments: str) -> tuple[int, str, str]:
    with pytest.raises(SystemExit) as caught:
        main(["coverage", *arguments])
    return int(caught.value.code or 0), *capsys.readouterr()


def write(folder: Path, sections: dict[str, Any]) -> str:
    outline = [{"chapter": "Chapter 1", "articles": [{"article": "Article 1. A heading that is far too long for its column", "sections": sections}]}]
    write_example({"outline": outline}, folder)
    (folder / "codes" / "ci" / "outline.yaml").write_text(
        "listing: recalled\noutline: [{chapter: City, sections: {'70': City speed, all of Division B: {heading: Devices, status: not_for_ads,"
        " why: binds those who place them}}}]\n",
        "utf-8",
    )
    return str(folder / "codes")


@pytest.fixture
def whole(tmp_path: Path) -> str:
    """Codes in which everything is accounted for."""
    return write(tmp_path, {**REST, "100": "Children", "110": ALLEYS})


@pytest.fixture
def lacking(tmp_path: Path) -> str:
    """Codes with a listed section that nothing accounts for, and a file that nothing lists."""
    return write(tmp_path, {**REST, "110": "Alleys"})


def test_the_table_fits_and_adds_up(whole: str, capsys: pytest.CaptureFixture[str]) -> None:
    code, out, err = run(capsys, "--codes", whole)
    assert (code, err) == (0, "")
    assert max(map(len, out.splitlines())) <= 80
    assert out.isascii()
    lines = [line.split() for line in out.splitlines()]
    assert ["in", "all", "5", "-", "-", "1", "-", "6"] in lines
    assert ["all", "codes", "6", "-", "1", "1", "-", "8"] in lines
    assert out.count("100% accounted for") == 3
    assert "1 entries stand for sections that are not listed one by one" in " ".join(out.split())


def test_what_is_missing_is_a_finding(lacking: str, capsys: pytest.CaptureFixture[str]) -> None:
    code, out, _ = run(capsys, "--codes", lacking)
    assert code == 1
    assert "1 files are listed in no outline" in " ".join(out.split())
    code, out, _ = run(capsys, "--codes", lacking, "--missing")
    told = " ".join(out.split())
    assert code == 1
    assert "ST 110 (Alleys): neither a file nor a reason" in told
    assert "ST 100 (Children beside the road): has a file, but no outline lists it" in told
    assert out.rstrip().endswith("2 missing")


def test_nothing_missing_is_said(whole: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(capsys, "--codes", whole, "--missing") == (0, "every section is accounted for\n", "")


@pytest.mark.parametrize("name", ["110", "ST 110"])
def test_one_section_with_its_reason(whole: str, name: str, capsys: pytest.CaptureFixture[str]) -> None:
    code, out, _ = run(capsys, "--codes", whole, "--section", name)
    assert code == 0
    assert out.startswith("ST 110: Alleys\n")
    assert "not expressible" in out
    assert "tells an alley" in " ".join(out.split())
    assert max(map(len, out.splitlines())) <= 80


def test_one_section_as_json(whole: str, capsys: pytest.CaptureFixture[str]) -> None:
    _, out, _ = run(capsys, "--codes", whole, "--section", "100", "--format", "json")
    assert json.loads(out) == {
        "schema": "urn:regdb:coverage:1.0",
        "sections": [
            {
                "section": "100", "citation": "ST 100", "heading": "Children", "status": "encoded", "why": "", "listed": True,
                "file": "codes/st/100.yaml",
            }
        ],
    }  # fmt: skip


def test_all_as_json(lacking: str, capsys: pytest.CaptureFixture[str]) -> None:
    code, out, _ = run(capsys, "--codes", lacking, "--format", "json")
    data = json.loads(out)
    assert code == 1
    assert data["total"] == {
        "encoded": 6, "partial": 0, "not_for_ads": 1, "not_expressible": 0, "unaccounted": 1, "unlisted": 1, "ranges": 1, "all": 8,
        "percent_accounted": 87,
    }  # fmt: skip
    assert [item["code"] for item in data["codes"]] == ["st", "ci"]
    assert data["codes"][0]["listing"]["confidence"] == "seen"
    assert sum(group["counts"]["all"] for item in data["codes"] for group in item["groups"]) == 8


def test_only_what_governs_a_place(whole: str, capsys: pytest.CaptureFixture[str]) -> None:
    _, out, _ = run(capsys, "--codes", whole, "--in", "state")
    assert "ST: State" in out
    assert "CI: City" not in out
    _, out, _ = run(capsys, "--codes", whole, "--in", "city")
    assert "CI: City" in out


@pytest.mark.parametrize(
    ("arguments", "told"),
    [(["--section", "999"], "no outline lists '999'"), (["--in", "nowhere"], "unknown jurisdiction 'nowhere'")],
)
def test_a_mistake_is_told_in_a_sentence(whole: str, arguments: list[str], told: str, capsys: pytest.CaptureFixture[str]) -> None:
    code, out, err = run(capsys, "--codes", whole, *arguments)
    assert (code, out) == (2, "")
    assert told in err


def test_codes_without_an_outline_have_no_ledger(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write_example({}, tmp_path)
    code, _, err = run(capsys, "--codes", str(tmp_path / "codes"))
    assert code == 2
    assert "has an outline.yaml" in " ".join(err.split())


def test_an_outline_that_cannot_be_read_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = write(tmp_path, {"10": {"heading": "Red", "status": "never", "why": "x"}})
    code, _, err = run(capsys, "--codes", folder)
    assert code == 2
    assert "codes/st/outline.yaml" in err
    assert "regdb lint" in err
