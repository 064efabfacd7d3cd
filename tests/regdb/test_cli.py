"""The front door: lazy, fast, and never a traceback for a person's mistake."""

import importlib
import json
import subprocess
import sys
from pathlib import Path

import pytest

from regdb import cli, front

HEAVY = ("pydantic", "yaml", "ruamel", "lark", "jinja2", "sqlite_utils", "pandas", "numpy", "scipy", "rich", "regdb_compiler", "regdb_runtime")


def run(*arguments: str, **named: object) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, "-m", "regdb", *arguments], capture_output=True, text=True, check=False, **named)  # type: ignore[call-overload,no-any-return]


def test_help_loads_nothing_heavy() -> None:
    told = (
        "import sys; sys.argv = ['regdb', '--help']\n"
        "from regdb.cli import main\n"
        "try: main()\nexcept SystemExit: pass\n"
        "import json; print('LOADED ' + json.dumps(sorted(sys.modules)))"
    )
    result = subprocess.run([sys.executable, "-c", told], capture_output=True, text=True, check=True)
    loaded = json.loads(result.stdout.rpartition("LOADED ")[2])
    assert [name for name in loaded if name.partition(".")[0] in HEAVY] == []


def test_help_names_every_command_and_fits_80_columns() -> None:
    result = run("--help")
    assert result.returncode == 0
    for name in cli.COMMANDS:
        assert f"  {name} " in result.stdout
    assert max(map(len, result.stdout.splitlines())) <= 80


@pytest.mark.parametrize("name", sorted(cli.COMMANDS))
def test_every_command_is_there_with_the_help_the_table_promises(name: str) -> None:
    module = importlib.import_module(cli.COMMANDS[name].module)
    assert callable(module.command)
    result = run(name, "--help")
    assert result.returncode == 0, result.stderr
    assert cli.COMMANDS[name].help.split()[0] in result.stdout
    assert max(map(len, result.stdout.splitlines())) <= 80


@pytest.mark.parametrize("arguments", [("nonsense",), ("lint", "--nope"), ("diff", "2020-01-01"), ("--nope",)])
def test_usage_errors_exit_2_without_traceback(arguments: tuple[str, ...]) -> None:
    result = run(*arguments)
    assert result.returncode == 2
    assert "Traceback" not in result.stderr
    assert "Error" in result.stderr


def test_our_own_error_is_one_line_and_a_report(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    def broken(*_: object) -> None:
        raise ZeroDivisionError

    monkeypatch.setattr(cli, "_load", broken)
    with pytest.raises(SystemExit) as stopped:
        cli.main(["lint"])
    told = capsys.readouterr().err
    assert stopped.value.code == 70
    assert told.count("\n") == 1
    assert "ZeroDivisionError" in told
    report = told.rpartition("with ")[2].strip()
    assert "Traceback" in Path(report).read_text("utf-8")


def test_a_missing_extra_says_what_to_type(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    def missing(name: str) -> None:
        raise ModuleNotFoundError(f"No module named {name!r}", name="lark")

    monkeypatch.setattr(cli.importlib, "import_module", missing)
    with pytest.raises(SystemExit) as stopped:
        cli.main(["lint"])
    assert stopped.value.code == 2
    assert "pip install 'regdb[compiler]'" in capsys.readouterr().err


def test_codes_are_those_named_else_here_else_shipped(tmp_path, monkeypatch: pytest.MonkeyPatch) -> None:  # type: ignore[no-untyped-def]
    monkeypatch.chdir(tmp_path)
    assert front.codes_folder(None) == front.shipped_codes()
    (tmp_path / "codes").mkdir()
    (tmp_path / "codes" / "jurisdictions.yaml").write_text("jurisdictions: {}\n")
    assert str(front.codes_folder(None)) == "codes"
    with pytest.raises(front.FrontError, match="no folder of codes"):
        front.codes_folder(tmp_path / "nowhere")


def test_version() -> None:
    assert run("--version").stdout.startswith("regdb 0.")
