"""`regdb match`: text, file and standard input; carets, tables and JSON; what it refuses."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path


def match(*arguments: str, told: str = "", folder: Path | None = None) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "regdb", "match", *arguments]
    return subprocess.run(command, capture_output=True, text=True, check=False, input=told, cwd=folder, timeout=120)


def test_the_words_are_underlined_and_the_facts_listed() -> None:
    found = match("The light is red. There are no pedestrians, but watch for cyclists.")
    assert found.returncode == 0, found.stderr
    first, second, *rest = found.stdout.splitlines()
    assert first == "The light is red. There are no pedestrians, but watch for cyclists."
    assert second == "    ^^^^^^^^^^^^               -----------                ~~~~~~~~"
    assert 'signal.color = red  "light is red"  by light and colour' in rest
    assert '  bicycle.present  advice: "cyclists"' in rest


def test_long_texts_are_wrapped_with_their_carets() -> None:
    found = match("lorem " * 30 + "stop sign " + "lorem " * 10)
    lines = found.stdout.splitlines()
    assert max(map(len, lines)) <= 80
    marked = next(at for at, line in enumerate(lines) if "^" in line)
    start = lines[marked].index("^")
    assert lines[marked - 1][start : start + 9] == "stop sign"


def test_json_gives_places_in_the_text_from_a_file(tmp_path: Path) -> None:
    (tmp_path / "answer.txt").write_text("A stop\u2011sign, “30 mph” speed limit.\n", "utf-8")
    data = json.loads(match("--file", "answer.txt", "--format", "json", folder=tmp_path).stdout)
    by_fact = {item["fact"]: item for item in data["statements"]}
    assert by_fact["posted.speed"]["value"] == "30 mph"
    ((start, end),) = by_fact["sign.stop"]["spans"]
    assert data["text"][start:end] == "stop\u2011sign"


def test_standard_input_and_a_text_without_facts() -> None:
    found = match(told="A picture of a cat.\n")
    assert found.returncode == 0
    assert "silence is unknown, never absent" in found.stdout


def test_refusals_are_one_sentence(tmp_path: Path) -> None:
    (tmp_path / "x.bin").write_bytes(b"\xff\xfe\x00")
    wrong = (("   ",), ("a", "--format", "xml"), ("a", "--file", "x.bin"), ("--file", "none.txt"), ("--file", "x.bin"), ("a", "--db", "x.bin"))
    for arguments in wrong:
        found = match(*arguments, folder=tmp_path)
        assert (found.returncode, found.stdout) == (2, ""), arguments
        assert found.stderr.startswith("error: ")
        assert "Traceback" not in found.stderr
