"""What `check` and `explain` share: from options to a verdict, with every problem of the question told at once."""

from __future__ import annotations

import datetime
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from regdb import completion
from regdb.front import told
from regdb.situation import Plan, Scene, SceneError, read_plan, read_scene
from regdb_runtime.commands.scene_file import Question, add_facts, read_question
from regdb_runtime.database import RegulationDatabase
from regdb_runtime.errors import RegdbRuntimeError, RequestError
from regdb_runtime.legality import View, day_number
from regdb_runtime.verdict import Verdict

FORMATS = ("text", "json")

SceneFile = Annotated[Path | None, typer.Argument(help="Scene file, YAML or JSON: scene, plan, in, on.")]
Facts = Annotated[
    list[str] | None,
    typer.Option("--fact", "-f", help="A fact of scene or plan as name=value; repeatable.", autocompletion=completion.facts),
]
Current = Annotated[str, typer.Option(help="State the vehicle is in.", autocompletion=completion.states)]
Following = Annotated[str, typer.Option("--next", help="State it would go to.", autocompletion=completion.states)]
In = Annotated[
    str, typer.Option("--in", help="Jurisdiction, or its code; default: the only state.", autocompletion=completion.jurisdictions)
]
On = Annotated[str, typer.Option("--on", help="Day as 2026-03-02; default: today.")]
Db = Annotated[Path | None, typer.Option("--db", help="Compiled database; default: compiled from the codes.")]
Codes = Annotated[Path | None, typer.Option("--codes", help="Folder of codes.")]
Everything = Annotated[bool, typer.Option("--all", help="Show long lists whole.")]
Form = Annotated[str, typer.Option("--format", help="text or json.")]


@dataclass(frozen=True)
class Asked:
    """A verdict with the law it was asked of; `today` says that the day was not given."""

    verdict: Verdict
    view: View
    database: RegulationDatabase
    today: bool

    @property
    def exit_code(self) -> int:
        """0 when lawful, 1 when not or not known to be."""
        return 0 if self.verdict.verdict == "legal" else 1


def ask(
    scene: Path | None, facts: list[str] | None, current: str, following: str, place: str, on: str, db: Path | None,
    codes: Path | None, format_: str,
) -> Asked:  # fmt: skip
    """Judge what the options say. Exits 2, all problems on stderr, when they cannot be understood."""
    problems = [] if format_ in FORMATS else [f"unknown format {format_!r}; there are: {', '.join(FORMATS)}"]
    try:
        question = read_question(scene) if scene is not None else Question()
        database = RegulationDatabase.open(db if db is not None else _compiled(codes))
    except RegdbRuntimeError as error:
        raise _refused([*problems, str(error)]) from None
    problems += add_facts(question, facts or (), database.vocabulary)
    question.plan |= {key: value for key, value in (("current", current), ("next", following)) if value}
    today = not (on or question.day)
    day = on or question.day or datetime.date.today().isoformat()
    view, read = _read(question, database, place, day, problems)
    if problems or view is None or read is None:
        raise _refused(problems)
    return Asked(view.judge(*read), view, database, today)


def _read(
    question: Question, database: RegulationDatabase, place: str, day: str, problems: list[str]
) -> tuple[View | None, tuple[Scene, Plan] | None]:
    """The law and the situation asked about; what cannot be read is added to `problems`."""
    view, scene, plan = None, None, None
    if not any(question.plan.get(key) for key in ("current", "next")):
        problems.append("no transition: give --current and --next, or `plan:` with current and next in the scene file")
    wrong = _wrong_day(day)
    problems += wrong
    try:
        where = place or question.place or _only_state(database)
        view = database.at(where, datetime.date.today() if wrong else day)
    except RequestError as error:
        problems.append(str(error))
    try:
        scene = read_scene(question.scene, database.vocabulary)
    except SceneError as error:
        problems += error.problems
    try:
        plan = read_plan(question.plan, database.vocabulary, database.machine)
    except SceneError as error:
        problems += error.problems
    return view, None if scene is None or plan is None else (scene, plan)


def _wrong_day(day: str) -> list[str]:
    """Why the day is none; told beside what is wrong with the place, so it is asked for apart."""
    try:
        day_number(day)
    except RequestError as error:
        return [str(error)]
    return []


def _only_state(database: RegulationDatabase) -> str:
    """The one enacted state of the database. Raises RequestError where there is none or a choice."""
    states = [item.id for item in database.tree if item.kind == "state" and item.status == "law"]
    if len(states) != 1:
        raise RequestError(f"which jurisdiction? give --in, one of: {', '.join(sorted(item.id for item in database.tree))}")
    return states[0]


def _compiled(codes: Path | None) -> Path:
    """The database of the codes, compiled when needed; the front door knows where codes and cache lie."""
    from regdb.front import database

    return database(codes)


def _refused(problems: list[str]) -> typer.Exit:
    for problem in problems:
        typer.echo(told(f"error: {problem}"), err=True)
    return typer.Exit(2)
