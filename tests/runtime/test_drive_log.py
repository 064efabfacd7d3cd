"""The log of a drive: its bytes, its place, and what a reader refuses."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
from made_logs import made_log, made_tick
from regdb_runtime.drive.log import SCHEMA, Log, line_of, plain, read_log, writing
from regdb_runtime.errors import LogError


def test_numbers_are_rounded_and_what_is_not_finite_is_null() -> None:
    record = {"a": np.float64(1 / 3), "b": math.inf, "c": -0.0, "d": frozenset(("y", "x")), "e": (True, None, 2), "f": np.bool_(True)}  # noqa: FBT003
    assert line_of(plain(record)) == '{"a":0.333333,"b":null,"c":0.0,"d":["x","y"],"e":[true,null,2],"f":true}'
    assert plain(math.nan) is None


def test_a_log_comes_back_as_it_was_written(tmp_path: Path) -> None:
    log = made_log([made_tick(0.0, 0.0, 10.0), made_tick(0.1, 1.0, 10.0)])
    path = tmp_path / "deep" / "drive.jsonl"
    plain_log = Log(plain(log.run), tuple(plain(log.ticks)), plain(log.end))
    with writing(path) as out:
        for record in (plain_log.run, *plain_log.ticks, plain_log.end):
            out.write(record)
    assert read_log(path) == plain_log
    assert [item.name for item in path.parent.iterdir()] == ["drive.jsonl"]


def test_a_log_that_fails_leaves_the_one_before_untouched(tmp_path: Path) -> None:
    path = tmp_path / "drive.jsonl"
    path.write_text("before")
    with pytest.raises(TypeError), writing(path) as out:
        out.write({"kind": object()})
    assert path.read_text() == "before"
    assert [item.name for item in tmp_path.iterdir()] == ["drive.jsonl"]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "does not begin with the run"),
        ("{}\n", "does not begin with the run"),
        ("[1]\n", "does not begin with the run"),
        ("no json\n", "is no log of a drive"),
        (json.dumps({"kind": "run", "schema": "regdb-drive/0"}), f"this program reads '{SCHEMA}'"),
        (json.dumps({"kind": "run", "schema": SCHEMA}) + '\n{"kind":"tick"}', "is cut off"),
    ],
)
def test_what_is_no_log_is_refused(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "drive.jsonl"
    path.write_text(text)
    with pytest.raises(LogError, match=message.replace("(", r"\(")):
        read_log(path)


def test_a_log_that_is_not_there_is_refused(tmp_path: Path) -> None:
    with pytest.raises(LogError, match="cannot be read: No such file"):
        read_log(tmp_path / "none.jsonl")


def test_a_log_that_cannot_be_placed_says_so(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(LogError, match="cannot be written"), writing(tmp_path / "file" / "drive.jsonl"):
        pass
