"""`regdb drive frames` and `regdb drive degradation` as typed."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from regdb_runtime.commands import drive_frames
from regdb_runtime.drive.degradation import Outcome

from regdb.cli import main


def run(*arguments: str, code: int = 0) -> None:
    with pytest.raises(SystemExit) as caught:
        main(["drive", *arguments])
    assert caught.value.code == code


def test_frames_of_a_drive_with_their_truth(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr(drive_frames, "LONGEST", 5.0)
    run("frames", "--variant", "no-turn-sign", "-o", str(tmp_path))
    assert "2 frames" in capsys.readouterr().out
    folder = tmp_path / "no-turn-sign-frames"
    truths = json.loads((folder / "truth.json").read_text("utf-8"))
    assert [item["frame"] for item in truths] == ["0000s.jpg", "0004s.jpg"]
    assert all((folder / item["frame"]).read_bytes()[:2] == b"\xff\xd8" for item in truths)
    assert any(thing["kind"] == "sign R10-11" and thing["fact"] == "sign.no_turn_on_red" for item in truths for thing in item["things"])


def test_degradation_prints_a_table_and_fails_on_a_breach(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def drives(*arguments: Any, **more: Any) -> tuple[Outcome, ...]:  # noqa: ARG001
        return tuple(
            Outcome("red", rate, seed, "destination", "", 50.0, rate, ("turned on red",) if (rate, seed) == (0.1, 1) else (), 90, 0)
            for rate in (0.0, 0.1)
            for seed in (0, 1)
        )

    monkeypatch.setattr(drive_frames, "degradation", drives)
    run("degradation", "--error-rate", "0.1", "-o", str(tmp_path), code=1)
    out = capsys.readouterr().out
    assert "red               10 %       2     50.0   10.0 %         1" in out
    assert max(map(len, out.splitlines()[:-1])) <= 80
    assert (tmp_path / "degradation.png").exists()
    run("degradation", "--format", "json", "-o", str(tmp_path), code=1)
    assert len(json.loads(capsys.readouterr().out)) == 4


@pytest.mark.parametrize("arguments", [("frames", "x.json"), ("degradation", "x.json"), ("frames", "--variant", "nope")])
def test_what_is_not_there_is_refused(arguments: tuple[str, ...], capsys: pytest.CaptureFixture[str]) -> None:
    run(*arguments, code=2)
    assert "error" in capsys.readouterr().err
