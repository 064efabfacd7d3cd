"""`regdb check`: whether a manoeuvre is lawful in a scene, and by which sections."""

import json

import typer

from regdb_runtime.commands.asking import Codes, Current, Db, Everything, Facts, Following, Form, In, On, SceneFile, ask
from regdb_runtime.commands.verdict_text import verdict_text


def command(
    scene: SceneFile = None,
    fact: Facts = None,
    current: Current = "",
    following: Following = "",
    place: In = "",
    on: On = "",
    db: Db = None,
    codes: Codes = None,
    everything: Everything = False,
    format_: Form = "text",
) -> None:
    """Ask whether a manoeuvre is lawful in a scene."""
    asked = ask(scene, fact, current, following, place, on, db, codes, format_)
    typer.echo(json.dumps(asked.verdict.to_dict(), indent=2) if format_ == "json" else verdict_text(asked, everything=everything))
    raise typer.Exit(asked.exit_code)
