"""The demo: the whole job on the shipped codes, every situation of the paper as its case expects."""

import json
import subprocess
import sys
from pathlib import Path

import pytest


@pytest.fixture(scope="module")
def decided(codes: Path, tmp_path_factory: pytest.TempPathFactory) -> dict[str, object]:
    """What `regdb demo --format json` prints."""
    out = tmp_path_factory.mktemp("demo")
    command = [sys.executable, "-m", "regdb", "demo", "--codes", str(codes), "-o", str(out), "--format", "json"]
    result = subprocess.run(command, capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stderr
    data: dict[str, object] = json.loads(result.stdout)
    assert {path.name for path in out.iterdir()} >= {"regulations.sqlite", "paper.csv", "regulations.csv", "manifest.json"}
    return data


def situations(data: dict[str, object], group: str) -> list[dict[str, object]]:
    found = data["situations"]
    assert isinstance(found, list)
    return [item for item in found if item["group"] == group]


def test_every_situation_comes_out_as_its_case_expects(decided: dict[str, object]) -> None:
    groups = {"Speed": 3, "Cyclist": 13, "Right on red": 5, "School road": 16}
    for group, count in groups.items():
        items = situations(decided, group)
        assert len(items) == count, group
        assert [item["name"] for item in items if not item["as_expected"]] == []


def test_the_sign_not_seen_is_unknown_and_named(decided: dict[str, object]) -> None:
    (item,) = [item for item in situations(decided, "Right on red") if item["verdict"] == "unknown"]
    missing = item["missing"]
    assert isinstance(missing, list)
    assert [entry["fact"] for entry in missing] == ["sign.no_turn_on_red"]


def test_the_paper_is_driven_by_the_database_just_written(decided: dict[str, object]) -> None:
    drive = decided["drive"]
    assert isinstance(drive, dict)
    assert drive["as_expected"] is True
    assert [event["name"] for event in drive["events"]] == [
        "overtaking_begins", "back_in_lane", "stopped", "released", "zone_detected", "reduced_speed",
    ]  # fmt: skip


def test_text_fits_80_columns(codes: Path, tmp_path: Path) -> None:
    command = [sys.executable, "-m", "regdb", "demo", "--codes", str(codes), "-o", str(tmp_path / "o")]
    lines = subprocess.run(command, capture_output=True, text=True, check=True, cwd=tmp_path).stdout.splitlines()
    assert [line for line in lines if len(line) > 80 and str(tmp_path) not in line] == []
    assert any("UNKNOWN" in line for line in lines)
