"""The cache: the same input is compiled once, another input anew; errors are told; processes do not disturb each other."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from regdb_compiler import cache
from regdb_compiler.cache import KEPT, cached_database, input_hash
from regdb_runtime.database import RegulationDatabase

from regdb.completion import known_names
from regdb.front import FrontError


@pytest.fixture
def mine(small_codes: Path, tmp_path: Path) -> Path:
    """A copy of the small codes to change."""
    return Path(shutil.copytree(small_codes, tmp_path / "codes"))


def test_compiled_once_then_found(mine: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    first = cached_database(mine, tmp_path / "cache")
    assert len(RegulationDatabase.open(first)) == 5
    monkeypatch.setattr(cache, "_compile", lambda *_: pytest.fail("compiled again"))
    assert cached_database(mine, tmp_path / "cache") == first


def test_every_input_byte_counts_and_nothing_else(mine: Path) -> None:
    before = input_hash(mine)
    (mine / "cvc" / "notes.txt").write_text("no input")
    (mine / ".hidden").mkdir()
    (mine / ".hidden" / "x.yaml").write_text("a: b")
    os.utime(mine / "states.yaml", (1, 1))
    assert input_hash(mine) == before
    with (mine / "cvc" / "22350.yaml").open("a") as file:
        file.write("# a comment\n")
    changed = input_hash(mine)
    assert changed != before
    (mine / "cvc" / "22348.yaml").rename(mine / "cvc" / "22348-x.yaml")
    assert input_hash(mine) != changed


def test_another_version_of_regdb_or_of_the_compiler_is_another_entry(mine: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    before = input_hash(mine)
    monkeypatch.setattr(cache, "VERSION", "99.0")
    newer = input_hash(mine)
    assert newer != before
    monkeypatch.setattr(cache, "USER_VERSION", 2000)
    assert input_hash(mine) != newer
    monkeypatch.undo()
    monkeypatch.setattr(cache, "_own_files", lambda: iter(["lower.py 1 2\n"]))
    assert input_hash(mine) != before


def test_errors_are_told_with_their_places_and_nothing_is_kept(mine: Path, tmp_path: Path) -> None:
    path = mine / "cvc" / "22350.yaml"
    path.write_text(path.read_text("utf-8").replace("emergency.siren", "emergency.sirn").replace("force: prima_facie", "force: some"))
    with pytest.raises(FrontError) as caught:
        cached_database(mine, tmp_path / "cache")
    message = str(caught.value)
    assert "codes/cvc/22350.yaml:" in message
    assert "R014" in message
    assert message.endswith("run `regdb lint` to see them all")
    assert not list(tmp_path.glob("cache/*.sqlite"))


def test_many_errors_are_counted(mine: Path, tmp_path: Path) -> None:
    for number in range(9):
        (mine / "cvc" / f"9{number}.yaml").write_text("section: []\n")
    with pytest.raises(FrontError, match=r"and \d+ more"):
        cached_database(mine, tmp_path / "cache")


def test_a_damaged_entry_is_compiled_again(mine: Path, tmp_path: Path) -> None:
    path = cached_database(mine, tmp_path / "cache")
    whole = path.read_bytes()
    for damage in (b"", whole[:5000], b"x" * len(whole)):
        path.write_bytes(damage)
        assert cached_database(mine, tmp_path / "cache").read_bytes() == whole


def test_the_least_recently_used_go_first(mine: Path, tmp_path: Path) -> None:
    folder = tmp_path / "cache"
    first = cached_database(mine, folder)
    for number in range(KEPT + 2):
        (folder / f"old{number}.sqlite").write_text("x")
        os.utime(folder / f"old{number}.sqlite", (1000 + number, 1000 + number))
    with (mine / "states.yaml").open("a") as file:
        file.write("# changed\n")
    second = cached_database(mine, folder)
    kept = {path.name for path in folder.glob("*.sqlite")}
    assert len(kept) == KEPT
    assert {first.name, second.name, f"old{KEPT + 1}.sqlite"} <= kept
    assert "old0.sqlite" not in kept


def test_a_cache_that_cannot_be_written_says_what_to_set(mine: Path, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("in the way")
    with pytest.raises(FrontError, match=r"cannot be written: .*; set XDG_CACHE_HOME"):
        cached_database(mine, tmp_path / "file" / "cache")


_CACHED = "import sys; from pathlib import Path; from regdb_compiler.cache import cached_database as c; print(c(*map(Path, sys.argv[1:])))"


def test_two_processes_at_once_both_answer(mine: Path, tmp_path: Path) -> None:
    run = [sys.executable, "-W", "error", "-c", _CACHED, str(mine), str(tmp_path / "cache")]
    both = [subprocess.Popen(run, stdout=subprocess.PIPE, text=True) for _ in range(2)]
    answers = {process.communicate()[0].strip() for process in both}
    assert len(answers) == 1
    assert len(RegulationDatabase.open(answers.pop())) == 5
    assert not list(tmp_path.glob("cache/.regdb-*"))


def test_names_are_left_for_completion(mine: Path, tmp_path: Path) -> None:
    cached_database(mine, tmp_path / "cache")
    names = known_names(mine, tmp_path / "cache")
    assert names["regulation"] == ("cvc-22348-b", "cvc-22350-a", "cvc-22350-b", "la_city-80.14-a")
    assert names["jurisdiction"] == ("california", "los_angeles", "model")
    assert {"follow", "overtaking", "passing", "lane_following.go_straight"} <= set(names["state"])


def test_a_hit_loads_nothing_of_the_compiler(mine: Path, tmp_path: Path) -> None:
    cached_database(mine, tmp_path / "cache")
    probe = _CACHED + "; print([m for m in ('pydantic', 'lark', 'yaml', 'pandas', 'sqlite3') if m in sys.modules])"
    run = [sys.executable, "-c", probe, str(mine), str(tmp_path / "cache")]
    assert subprocess.run(run, capture_output=True, text=True, check=True).stdout.splitlines()[1] == "[]"
