"""Progress: only on a terminal, only for long work, gone afterwards."""

import io
import time

import pytest
from regdb_compiler.commands import progress
from regdb_compiler.commands.progress import working


class _Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def _terminal(monkeypatch: pytest.MonkeyPatch) -> _Terminal:
    """A terminal in place of stderr; set in the test itself, since pytest puts its own there between fixture and test."""
    terminal = _Terminal()
    monkeypatch.setattr(progress.sys, "stderr", terminal)
    return terminal


def test_long_work_is_announced_and_wiped(monkeypatch: pytest.MonkeyPatch) -> None:
    stderr = _terminal(monkeypatch)
    monkeypatch.setattr(progress, "PATIENCE_S", 0.01)
    with working("reading"):
        deadline = time.monotonic() + 5
        while not stderr.getvalue() and time.monotonic() < deadline:
            time.sleep(0.005)
    assert stderr.getvalue() == "reading ...\r" + " " * 11 + "\r"


def test_short_work_says_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    stderr = _terminal(monkeypatch)
    with working("reading"):
        pass
    assert stderr.getvalue() == ""


def test_without_a_terminal_nothing_is_said(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr(progress, "PATIENCE_S", 0.0)
    with working("reading"):
        time.sleep(0.02)
    assert capsys.readouterr().err == ""
