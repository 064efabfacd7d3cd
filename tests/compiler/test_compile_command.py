"""`regdb compile` as typed: what it writes, says and returns."""

import json
import shutil
from pathlib import Path

import pytest
from regdb_runtime.database import RegulationDatabase

from regdb.cli import main


def _run(*arguments: str) -> int:
    with pytest.raises(SystemExit) as caught:
        main(["compile", *arguments])
    return int(caught.value.code or 0)


def test_files_sizes_counts_and_hash(small_codes: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert _run("--codes", str(small_codes), "-o", str(tmp_path)) == 0
    out, err = capsys.readouterr()
    assert err == ""
    database = RegulationDatabase.open(tmp_path / "regulations.sqlite")
    assert f"content hash {database.hash}" in out
    assert "5 regulations, 5 versions of 4 sections" in out
    for name in ("regulations.sqlite", "paper.csv", "regulations.csv", "regulations.json", "datapackage.json", "manifest.json"):
        assert f"{tmp_path / name}" in out


def test_one_day_and_json(small_codes: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert _run("--codes", str(small_codes), "-o", str(tmp_path), "--on", "1990-01-01", "--format", "json") == 0
    found = json.loads(capsys.readouterr().out)
    assert found["in_force_on"] == "1990-01-01"
    assert found["rows"]["regulation"] == 3
    assert [item["name"] for item in found["files"]][-1] == "manifest.json"
    assert json.loads((tmp_path / "manifest.json").read_text("utf-8"))["in_force_on"] == "1990-01-01"


def test_errors_are_findings_and_nothing_is_written(small_codes: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    codes = Path(shutil.copytree(small_codes, tmp_path / "codes"))
    path = codes / "cvc" / "22350.yaml"
    path.write_text(path.read_text("utf-8").replace("emergency.siren", "emergency.sirn"))
    assert _run("--codes", str(codes), "-o", str(tmp_path / "out")) == 1
    out, err = capsys.readouterr()
    assert "error[R401] unknown-fact" in out
    assert "codes/cvc/22350.yaml:" in out
    assert err == "nothing was written\n"
    assert not (tmp_path / "out").exists()
    assert _run("--codes", str(codes), "-o", str(tmp_path / "out"), "--format", "json") == 1
    assert '"R401"' in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--codes", "no/such/folder"], "no/such/folder is no folder of codes"),
        (["--on", "1990"], "'1990' is no date; write it as 2026-03-02"),
        (["--on", "2026-02-30"], "is no date"),
        (["--format", "xml"], "xml"),
    ],
)
def test_a_mistake_is_answered_in_a_line(arguments: list[str], message: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert _run(*arguments) == 2
    err = capsys.readouterr().err
    assert message in err
    assert "Traceback" not in err


def test_a_folder_that_cannot_be_written(small_codes: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "file").write_text("in the way")
    assert _run("--codes", str(small_codes), "-o", str(tmp_path / "file" / "out")) == 2
    assert "cannot be written" in capsys.readouterr().err
