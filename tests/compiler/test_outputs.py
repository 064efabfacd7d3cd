"""All outputs together: JSON, Parquet, manifest; moved in whole, or nothing changed."""

import builtins
import datetime
import json
from hashlib import sha256
from pathlib import Path
from typing import Any

import pytest
from regdb_compiler.diagnostics import Diagnostic, Place
from regdb_compiler.driver import Build
from regdb_compiler.emit import in_place, to_parquet
from regdb_compiler.emit.outputs import write_outputs
from regdb_compiler.emit.table import COLUMNS

from regdb.front import FrontError

NAMES = ["datapackage.json", "manifest.json", "paper.csv", "regulations.csv", "regulations.json", "regulations.sqlite"]


def _json(path: Path) -> Any:
    return json.loads(path.read_text("utf-8"))


def test_json_holds_every_regulation_with_typed_values(small: Build, tmp_path: Path) -> None:
    outputs = write_outputs(small, tmp_path)
    document = _json(tmp_path / "regulations.json")
    assert document["schema"] == "urn:regdb:regulations:1.0"
    assert document["content_hash"] == outputs.database.content_hash
    assert [item["id"] for item in document["regulations"]] == [rule.id for rule in small.regulations]
    rule = document["regulations"][1]
    assert list(rule) == [column.name for column in COLUMNS]
    assert (rule["legality"], rule["until"], rule["effective"]) == (False, None, "2005-01-01")
    assert rule["attributes"] == {"road_type": "highway", "max_speed": "100 mph"}
    assert rule["applies_to"] == ["passenger", "bus"]
    assert rule["location"] == ["Division 11", "Chapter 7"]


def test_the_manifest_lists_inputs_outputs_relations_and_counts(small: Build, small_codes: Path, tmp_path: Path) -> None:
    outputs = write_outputs(small, tmp_path)
    manifest = _json(tmp_path / "manifest.json")
    assert [item.name for item in outputs.files][-1] == "manifest.json"
    for item in manifest["outputs"]:
        data = (tmp_path / item["name"]).read_bytes()
        assert (item["size"], item["sha256"]) == (len(data), sha256(data).hexdigest())
    assert {item["name"] for item in manifest["inputs"]} == {path.relative_to(small_codes).as_posix() for path in small_codes.rglob("*.yaml")}
    for item in manifest["inputs"]:
        assert item["sha256"] == sha256((small_codes / item["name"]).read_bytes()).hexdigest()
    assert manifest["relations"][-1] == {
        "regulation": "la_city-80.14-a", "kind": "overrides", "target": "cvc-22350-a", "authority": "CVC 22350",
        "effective": "2010-07-01", "until": None,
    }  # fmt: skip
    assert manifest["counts"]["cvc"] == {"sections": 2, "regulations": 4, "definitions": 1, "delegations": 1, "tests": 1, "cases": 0}
    assert manifest["confidence"] == {"recalled": 1, "seen": 1, "verified": 2}
    assert manifest["warnings"] == []
    assert str(tmp_path) not in (tmp_path / "manifest.json").read_text("utf-8")
    assert str(small_codes.parent) not in (tmp_path / "manifest.json").read_text("utf-8")


def test_warnings_stand_in_the_manifest(small: Build, tmp_path: Path) -> None:
    from dataclasses import replace

    warning = Diagnostic("R505", "version-gap", "warning", "no text", Place("small_codes/cvc/1.yaml", 3, 1, 3, 2))
    write_outputs(replace(small, diagnostics=(warning,)), tmp_path)
    assert _json(tmp_path / "manifest.json")["warnings"] == [
        {"code": "R505", "name": "version-gap", "level": "warning", "message": "no text", "path": "small_codes/cvc/1.yaml", "line": 3, "column": 1}
    ]


def test_parquet_has_types(small: Build, tmp_path: Path) -> None:
    pandas = pytest.importorskip("pandas")
    write_outputs(small, tmp_path, parquet=True)
    frame = pandas.read_parquet(tmp_path / "regulations.parquet")
    assert list(frame.columns) == [column.name for column in COLUMNS]
    assert frame["legality"].tolist() == [False, False, False, True, False]
    assert frame["effective"].tolist()[0] == datetime.date(1984, 1, 1)
    assert frame["until"].isna().tolist() == [False, True, True, True, True]
    assert frame["vagueness"].tolist() == [0, 1, 0, 0, 0]
    assert json.loads(frame["limits"].tolist()[0])[0]["value"] == 100.0


def test_without_pyarrow_the_message_says_what_to_type_and_nothing_changes(
    small: Build, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_outputs(small, tmp_path)
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}

    def missing(name: str) -> None:
        raise ModuleNotFoundError(f"No module named {name!r}", name=name)

    monkeypatch.setattr(to_parquet.importlib, "import_module", missing)
    with pytest.raises(FrontError, match=r"Parquet needs pyarrow, .* pip install 'regdb\[compiler\]'"):
        write_outputs(small, tmp_path, datetime.date(1990, 1, 1).toordinal(), parquet=True)
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before
    monkeypatch.undo()

    def import_(name: str, *rest: Any) -> Any:
        return missing(name) if name == "pandas" else real(name, *rest)

    real = builtins.__import__
    monkeypatch.setattr(builtins, "__import__", import_)
    with pytest.raises(FrontError, match="Parquet needs pandas"):
        to_parquet.write_parquet([], tmp_path / "x")


def test_other_files_of_the_folder_stay(small: Build, tmp_path: Path) -> None:
    (tmp_path / "notes.txt").write_text("mine")
    write_outputs(small, tmp_path)
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted([*NAMES, "notes.txt"])


def test_old_leftovers_are_swept_and_fresh_ones_stay(tmp_path: Path) -> None:
    import os

    for name, age in ((".regdb-old", 0.0), (".regdb-new", None)):
        (tmp_path / name).mkdir()
        (tmp_path / name / "part").write_text("half")
        if age is not None:
            os.utime(tmp_path / name, (age, age))
    with in_place.folder_beside(tmp_path / "x") as folder:
        assert folder.parent == tmp_path
        (folder / "x").write_text("whole")
        in_place.move_in(folder / "x", tmp_path / "x")
    assert sorted(path.name for path in tmp_path.iterdir()) == [".regdb-new", "x"]
    assert (tmp_path / "x").stat().st_mode & 0o777 == 0o666 & ~in_place._umask()
