"""`regdb check` and `regdb explain`: what they print, how they exit, and that every problem is told at once."""

from __future__ import annotations

import builtins
import datetime
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import typer
from regdb_runtime.commands import check, explain
from typer.testing import CliRunner, Result

from regdb.condition import And, Is, Linear, OneOf
from regdb.condition_text import show
from regdb.regulation import Limit, Regulation


@pytest.fixture
def database(tmp_path: Path, random_law: Callable[[int], Any], write_law: Callable[..., Path]) -> Path:
    law = random_law(1)
    stop = Regulation("sc-1-a", "SC 1(a)", "state", legality=False, when=And((Is("b0"), OneOf("e0", ("red",)))), next=frozenset({"drive.b"}))
    turn = Regulation("sc-1-b", "SC 1(b)", "state", legality=True, when=Is("b1"), targets=("sc-1-a",))
    slow = Regulation(
        "sc-2", "SC 2", "state", legality=False, force="absolute", limits=(Limit("max_q0", "q0", "max", Linear(11.176), "mph"),)
    )
    assert show(stop.when) == "b0 and e0 == red"
    return write_law(tmp_path / "law.sqlite", law, [stop, turn, slow])


@pytest.fixture
def run(database: Path) -> Callable[..., Result]:
    def call(module: Any, *arguments: str) -> Result:
        app = typer.Typer()
        app.command()(module.command)
        return CliRunner().invoke(app, [*arguments, "--db", str(database)])

    return call


def unwrapped(result: Result) -> str:
    """What went to stderr on one line: where it wraps depends on how long the paths in it are."""
    return " ".join(result.stderr.split())


def facts(**values: str) -> list[str]:
    return [part for name, value in values.items() for part in ("--fact", f"{name}={value}")]


GO = ("--current", "a", "--next", "b")


def test_an_unlawful_manoeuvre(run: Callable[..., Result]) -> None:
    result = run(check, *GO, *facts(b0="true", e0="red", b1="false", q0="20 mph"), "--on", "2026-03-02", "--in", "sc")
    assert result.exit_code == 1
    assert result.stdout.splitlines() == [
        "ILLEGAL in state on 2026-03-02 (law of State)",
        "  drive.a -> drive.b",
        "",
        "Broken:",
        "  SC 1(a) [sc-1-a]",
        "",
        "Limits in force:",
        "  q0 at most 25 mph (SC 2, absolute)",
        "",
        "Not legal advice.",
    ]


def test_a_lawful_one_by_exception(run: Callable[..., Result]) -> None:
    result = run(check, *GO, *facts(b0="true", e0="red", b1="true", q0="20 mph"))
    assert result.exit_code == 0
    assert f"LEGAL in state on {datetime.date.today().isoformat()} (today)" in result.stdout
    assert "Allowed by these exceptions:\n  SC 1(b) [sc-1-b]" in result.stdout


def test_what_is_unknown_says_where_to_look(run: Callable[..., Result]) -> None:
    result = run(check, *GO, *facts(b0="true", e0="red", q0="1 mph"))
    assert result.exit_code == 1
    assert result.stdout.startswith("UNKNOWN in state")
    assert "Unknown; this would settle it:\n  look for: b1 - Meaning of b1." in result.stdout


def test_json_is_the_verdict(run: Callable[..., Result]) -> None:
    data = json.loads(run(check, *GO, *facts(b0="true", e0="red", b1="false"), "--format", "json").stdout)
    assert (data["verdict"], data["deciding"][0]["id"], data["transition"]["next"]) == ("illegal", "sc-1-a", "drive.b")
    data = json.loads(run(explain, *GO, *facts(b0="true", e0="red", b1="false"), "--format", "json").stdout)
    assert data["explanation"]["unless"][0]["id"] == "sc-1-b"


def test_explain_says_why_and_what_would_turn_it(run: Callable[..., Result]) -> None:
    text = run(explain, *GO, *facts(b0="true", e0="red", b1="false", q0="1 mph")).stdout
    assert "Because:\n  SC 1(a) [sc-1-a]\n      - true: b0\n      - true: e0 == red (e0 is red)" in text
    assert "Unless (exceptions that did not help):\n  SC 1(b) [sc-1-b]" in text
    assert "Smallest change that would make it lawful:\n  b1 is true (now false)" in text
    assert text.isascii()
    assert max(map(len, text.splitlines())) <= 80


@pytest.mark.parametrize("name", ["scene.yaml", "scene.json"])
def test_a_scene_file(run: Callable[..., Result], tmp_path: Path, name: str) -> None:
    path = tmp_path / name
    if name.endswith("json"):
        content = {"scene": {"b0": True, "e0": "red", "b1": False}, "plan": {"current": "a", "next": "b", "q0": "60 mph"}, "in": "city"}
        path.write_text(json.dumps(content))
    else:
        path.write_text("scene: {b0: true, e0: red, b1: false, t: 7:00}\nplan: {current: a, next: b, q0: 60 mph}\nin: city\non: 2026-03-02\n")
    result = run(check, str(path))
    assert "ILLEGAL in city" in result.stdout
    assert "SC 1(a)" in result.stdout
    assert "SC 2" in result.stdout
    assert "LEGAL" in run(check, str(path), "--next", "c", *facts(q0="1 mph")).stdout


def test_all_problems_at_once(run: Callable[..., Result]) -> None:
    result = run(check, *facts(b0="maybe", b9="true"), "--fact", "b1", "--fact", "q0=3", "--in", "atlantis", "--format", "xml")
    assert result.exit_code == 2
    assert result.stdout == ""
    said = unwrapped(result)
    for part in ("unknown format 'xml'", "'b1' is no fact", "no transition", "unknown jurisdiction 'atlantis'", "b0 is true, false",
                 "unknown fact 'b9'", "q0 takes a number with a unit"):  # fmt: skip
        assert part in said, part
    assert "Traceback" not in said


@pytest.mark.parametrize(
    ("name", "content", "said"),
    [
        ("x.yaml", "scene: [", "is no YAML"),
        ("x.json", "{", "is no JSON"),
        ("x.yaml", "just words", "is no scene"),
        ("x.yaml", "scene: 3", "`scene` is no list of facts"),
        ("x.yaml", "facts: {}", "has 'facts'; a scene file has: scene, plan, in, on"),
    ],
)
def test_unreadable_files(run: Callable[..., Result], tmp_path: Path, name: str, content: str, said: str) -> None:
    path = tmp_path / name
    path.write_text(content)
    result = run(check, str(path))
    assert (result.exit_code, said in unwrapped(result), "Traceback" in result.stderr) == (2, True, False)


def test_missing_files(run: Callable[..., Result], tmp_path: Path) -> None:
    assert "cannot be read" in unwrapped(run(check, str(tmp_path / "none.yaml")))
    app = typer.Typer()
    app.command()(check.command)
    result = CliRunner().invoke(app, ["--db", str(tmp_path / "none.sqlite")])
    assert (result.exit_code, "cannot be read" in unwrapped(result)) == (2, True)


def test_yaml_without_its_library_says_what_to_type(run: Callable[..., Result], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "x.yaml"
    path.write_text("scene: {}")
    real = builtins.__import__

    def refuse(name: str, *more: Any, **named: Any) -> Any:
        if name == "yaml":
            raise ModuleNotFoundError("No module named 'yaml'", name="yaml")
        return real(name, *more, **named)

    monkeypatch.setattr(builtins, "__import__", refuse)
    result = run(check, str(path))
    assert result.exit_code == 2
    assert "pip install 'regdb[compiler]'" in unwrapped(result)
