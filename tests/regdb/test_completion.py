"""Shell completion: names from the cached list, quickly, without the compiler; never an error."""

import json
import os
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

from regdb import completion

NAMES = {"regulation": ["cvc-1-a", "cvc-2-b"], "section": ["cvc-1"], "state": ["stop", "go"], "jurisdiction": ["los_angeles"], "fact": ["sign.stop"]}


@pytest.fixture
def codes_with_names(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    codes = tmp_path / "codes"
    (codes / "cvc").mkdir(parents=True)
    (codes / "jurisdictions.yaml").write_text("")
    (codes / "cvc" / "1.yaml").write_text("")
    (codes / "cvc" / "outline.yaml").write_text("")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    file = completion.names_file(codes, tmp_path / "cache" / "regdb")
    file.parent.mkdir(parents=True)
    file.write_text(json.dumps(NAMES))
    return codes


def _ctx(codes: Path | str | None) -> SimpleNamespace:
    return SimpleNamespace(params={"codes": codes})


def test_names_that_begin_with_what_is_typed(codes_with_names: Path) -> None:
    ctx = _ctx(codes_with_names)
    assert completion.regulations(ctx, "cvc-2") == ["cvc-2-b"]
    assert completion.subjects(ctx, "cvc-1") == ["cvc-1-a", "cvc-1"]
    assert completion.subjects(ctx, "s") == ["sign.stop", "stop"]
    assert completion.jurisdictions(ctx, "") == ["los_angeles"]
    assert completion.states(ctx, "g") == ["go"]
    assert completion.facts(ctx, "sign") == ["sign.stop"]
    assert completion.regulations(_ctx(str(codes_with_names)), "cvc-2") == ["cvc-2-b"]


def test_before_the_first_compilation_file_names_serve(codes_with_names: Path, tmp_path: Path) -> None:
    completion.names_file(codes_with_names, tmp_path / "cache" / "regdb").unlink()
    assert completion.subjects(_ctx(codes_with_names), "") == ["cvc-1", "cvc"]
    assert completion.regulations(_ctx(codes_with_names), "") == []


@pytest.mark.parametrize("content", ["", "{", "[]", '"x"', "\xff"])
def test_a_damaged_list_is_as_none(codes_with_names: Path, tmp_path: Path, content: str) -> None:
    completion.names_file(codes_with_names, tmp_path / "cache" / "regdb").write_text(content, "latin-1")
    assert completion.subjects(_ctx(codes_with_names), "") == ["cvc-1", "cvc"]


def test_no_codes_offer_nothing() -> None:
    assert completion.subjects(_ctx("no/such/folder"), "") == []


def _complete(line: str, codes: Path) -> tuple[list[str], set[str]]:
    """What bash would offer at the end of a line, and the modules loaded for it."""
    probe = (
        "import sys, atexit; from regdb.cli import main\n"
        "atexit.register(lambda: print('LOADED', *sorted(sys.modules), file=sys.stderr)); main([])"
    )
    words = line.split(" ")
    asked = {"_REGDB_COMPLETE": "complete_bash", "COMP_WORDS": line, "COMP_CWORD": str(len(words) - 1)}
    run = [sys.executable, "-W", "error", "-c", probe]
    done = subprocess.run(run, capture_output=True, text=True, env={**os.environ, **asked}, cwd=codes.parent, check=False)
    loaded = next(text for text in done.stderr.splitlines() if text.startswith("LOADED"))
    return done.stdout.split(), set(loaded.split())


def test_the_shell_s_answer_needs_neither_compiler_nor_pydantic(codes_with_names: Path) -> None:
    offered, loaded = _complete("regdb show cvc-", codes_with_names)
    assert offered == ["cvc-1-a", "cvc-2-b", "cvc-1"]
    assert not loaded & {"pydantic", "lark", "yaml", "sqlite3", "pandas", "numpy", "regdb_compiler.documents"}
    assert _complete("regdb chain --in l", codes_with_names)[0] == ["los_angeles"]


def test_commands_are_offered_without_loading_them(codes_with_names: Path) -> None:
    offered, loaded = _complete("regdb s", codes_with_names)
    assert offered == ["show", "search", "schema"]
    assert not any(name.startswith("regdb_compiler") for name in loaded)
