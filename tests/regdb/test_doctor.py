"""`regdb doctor`: what it looks at, and when it says that something needed is missing."""

import sqlite3
import sys
import tomllib
from importlib import metadata
from pathlib import Path
from typing import Any

import pytest

from regdb import doctor
from regdb.cli import main
from regdb.version import VERSION


@pytest.fixture(autouse=True)
def at_root(root: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(root)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))


def _lines() -> dict[str, doctor.Line]:
    return {line.name: line for line in doctor.examine()}


def test_a_complete_installation_is_fine(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as caught:
        main(["doctor"])
    assert caught.value.code == 0
    out = capsys.readouterr().out
    for part in (f"regdb                 {VERSION}", "Python", sqlite3.sqlite_version, "full-text search works", "extra [compiler]", "sections)"):
        assert part in out
    assert "MISSING" not in out


def test_a_missing_package_is_named_with_what_to_type(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    real = metadata.version

    def version(name: str) -> str:
        if name in {"scipy", "lark"}:
            raise metadata.PackageNotFoundError(name)
        return real(name)

    monkeypatch.setattr(metadata, "version", version)
    assert doctor.command() == 1
    out = capsys.readouterr().out
    assert "MISSING scipy                 not installed; type: pip install 'scipy>=1.11'" in out
    assert "-       extra [compiler]      lacks lark; type: pip install 'regdb[compiler]'" in out
    assert "lacks lark; type: pip install 'regdb[all]'" in out


def test_every_extra_is_looked_at(root: Path) -> None:
    project = tomllib.loads((root / "pyproject.toml").read_text("utf-8"))["project"]
    lines = _lines()
    for extra in project["optional-dependencies"]:
        line = lines[f"extra [{extra}]"]
        assert line.fine or f"type: pip install 'regdb[{extra}]'" in line.found
    assert {"vlm", "local-vlm"} <= project["optional-dependencies"].keys()


def test_regdb_itself_may_not_be_installed(monkeypatch: pytest.MonkeyPatch) -> None:
    def requires(name: str) -> Any:
        raise metadata.PackageNotFoundError(name)

    monkeypatch.setattr(metadata, "requires", requires)
    assert _lines()["packages"].fine is False


def test_an_old_python_or_sqlite_is_missing_something(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "version_info", (3, 10, 0))
    monkeypatch.setattr(sqlite3, "sqlite_version_info", (3, 26, 0))
    lines = _lines()
    assert (lines["Python"].fine, lines["SQLite"].fine) == (False, False)
    assert "at least 3.27" in lines["SQLite"].found


def test_sqlite_without_full_text_search(monkeypatch: pytest.MonkeyPatch) -> None:
    class Bare:
        def execute(self, _: str) -> None:
            raise sqlite3.OperationalError("no such module: fts5")

        def close(self) -> None:
            pass

    monkeypatch.setattr(sqlite3, "connect", lambda _: Bare())
    assert _lines()["SQLite FTS5"].fine is False


def test_no_codes_and_a_cache_that_cannot_be_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "codes").mkdir()
    (tmp_path / "codes" / "jurisdictions.yaml").write_text("jurisdictions: {}\n")
    monkeypatch.chdir(tmp_path)
    assert _lines()["codes"].fine is False
    monkeypatch.setattr(doctor.os, "access", lambda *_: False)
    assert _lines()["cache"].fine is False


def test_the_cache_is_counted(tmp_path: Path) -> None:
    (tmp_path / "regdb").mkdir()
    (tmp_path / "regdb" / "a.sqlite").write_bytes(b"x" * 1_500_000)
    assert "(1 databases, 1.5 MB)" in _lines()["cache"].found
