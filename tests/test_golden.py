"""Wrong inputs through the real command line, each held as a golden transcript: command, files, exit code, output.

`tests/golden/*.yaml` are the transcripts; their files are laid over the small codes of `tests/golden/codes`.
`pytest tests/test_golden.py --rewrite-golden` writes what the commands answer now; read the difference before you keep it.
"""

from __future__ import annotations

import contextlib
import io
import re
import shlex
import shutil
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
import yaml
from golden_files import RECIPES

from regdb.cli import COMMANDS, main

GOLDEN = Path(__file__).parent / "golden"
TRANSCRIPTS = sorted(GOLDEN.glob("*.yaml"))
WIDTH = 80
SECONDS = 5.0
"""How long the answer to a hostile input may take on a slow machine; it is far below a second on ours."""
SECONDS_TOLD = re.compile(r"in \d+\.\d s$", re.MULTILINE)
"""How long the tests of the law took, which no transcript can hold."""

KEYS = {"about", "command", "files", "edits", "made", "expect_exit", "output", "errors"}


@dataclass(frozen=True)
class Answer:
    """What a command said: its exit code, standard output and standard error."""

    exit: int
    output: str
    errors: str


def read(path: Path) -> dict[str, Any]:
    """A transcript. `edits` are replacements in the small codes, `made` names recipes of `golden_files`."""
    data = yaml.load(path.read_text("utf-8"), Loader=yaml.CBaseLoader)
    assert set(data) <= KEYS, f"{path.name} has {sorted(set(data) - KEYS)}; a transcript has {sorted(KEYS)}"
    return dict(data)


def lay_out(case: dict[str, Any], folder: Path) -> None:
    """The small codes, with the transcript's files over them."""
    shutil.copytree(GOLDEN / "codes", folder / "codes")
    for name, text in (case.get("files") or {}).items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, "utf-8")
    for edit in case.get("edits") or ():
        path = folder / edit["file"]
        text = path.read_text("utf-8")
        assert text.count(edit["old"]) >= 1, f"{edit['old']!r} is not in {edit['file']}"
        path.write_text(text.replace(edit["old"], edit["new"], 1), "utf-8")
    for name, recipe in (case.get("made") or {}).items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        RECIPES[recipe](folder / name)


def run(command: str) -> Answer:
    """A command line in this process, by the function that `python -m regdb` calls."""
    output, errors = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(output), contextlib.redirect_stderr(errors), pytest.raises(SystemExit) as stopped:
        main(shlex.split(command))
    return Answer(int(stopped.value.code or 0), SECONDS_TOLD.sub("in 0.0 s", output.getvalue()), errors.getvalue())


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty working directory, with nothing of this machine about it."""
    folder = tmp_path / "here"
    folder.mkdir()
    monkeypatch.chdir(folder)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setenv("COLUMNS", str(WIDTH))
    monkeypatch.setenv("TERMINAL_WIDTH", str(WIDTH))
    monkeypatch.setenv("NO_COLOR", "1")
    return folder


@pytest.mark.parametrize("path", TRANSCRIPTS, ids=lambda path: path.stem)
def test_transcript(path: Path, here: Path, request: pytest.FixtureRequest) -> None:
    case = read(path)
    lay_out(case, here)
    started = time.perf_counter()
    answer = run(case["command"])
    seconds = time.perf_counter() - started
    if request.config.getoption("--rewrite-golden"):
        path.write_text(rewritten(path.read_text("utf-8"), answer), "utf-8")
        case = read(path)
    _check_manners(case, answer, here)
    assert seconds < SECONDS or not case.get("made")
    assert (answer.output, answer.errors) == (case.get("output", ""), case.get("errors", ""))
    assert answer.exit == int(case["expect_exit"])


def _check_manners(case: dict[str, Any], answer: Answer, here: Path) -> None:
    """What holds of every answer to a wrong input, whatever it says."""
    told = answer.output + answer.errors
    assert answer.exit in {1, 2}, told
    assert "Traceback" not in told
    assert "internal error" not in told
    assert str(here) not in told, "the answer names a folder of this machine"
    assert [line for line in told.splitlines() if len(line) > WIDTH] == []
    assert re.sub(r"^ *\d+ \|.*", "", told, flags=re.MULTILINE).isascii(), "only a line of a file may be other than ASCII"
    if answer.exit == 1 and case["command"].split()[0] in {"lint", "compile"}:
        assert re.search(r"--> [\w./-]+:\d+:\d+", told), "the answer names no place"


def rewritten(text: str, answer: Answer) -> str:
    """A transcript with what a command answers now; what its author wrote stays as it is."""
    head = re.split(r"^expect_exit:", text, maxsplit=1, flags=re.MULTILINE)[0]
    return f"{head}expect_exit: {answer.exit}\n{_block('output', answer.output)}{_block('errors', answer.errors)}"


def _block(key: str, text: str) -> str:
    """A text as a YAML block that keeps every line feed and the first line's indentation; nothing for no text."""
    if not text:
        return ""
    keep = "-" if not text.endswith("\n") else "+" if text.endswith("\n\n") else ""
    lines = text.removesuffix("\n").split("\n")
    return f"{key}: |2{keep}\n" + "".join(f"  {line}\n" if line else "\n" for line in lines)


def test_the_small_codes_have_nothing_wrong(here: Path) -> None:
    lay_out({}, here)
    answer = run("compile -o out")
    assert (answer.exit, answer.errors) == (0, "")


def test_there_are_enough_transcripts_and_one_for_every_kind_of_command() -> None:
    commands = {read(path)["command"].split()[0] for path in TRANSCRIPTS}
    assert len(TRANSCRIPTS) >= 45
    assert commands & set(COMMANDS) >= {"lint", "test", "compile", "check", "explain", "show", "chain", "diff", "fmt", "new", "rule", "search"}


def test_every_recipe_is_used() -> None:
    used = {recipe for path in TRANSCRIPTS for recipe in (read(path).get("made") or {}).values()}
    assert used == set(RECIPES)


def test_python_m_regdb_answers_the_same(here: Path) -> None:
    case = read(GOLDEN / "typo-fact.yaml")
    lay_out(case, here)
    told = subprocess.run([sys.executable, "-m", "regdb", *shlex.split(case["command"])], capture_output=True, text=True, check=False)
    assert (told.returncode, told.stdout, told.stderr) == (int(case["expect_exit"]), case["output"], case["errors"])


@pytest.mark.parametrize("text", ["a\n", "a", "  a\n\nb\n", "a\n\n", "\na\n"])
def test_a_rewritten_block_reads_back(text: str) -> None:
    assert yaml.safe_load(_block("output", text)) == {"output": text}
