"""`regdb explain`: why a verdict is as it is, and the smallest change that would turn it."""

import json

import typer

from regdb_runtime.commands.asking import Codes, Current, Db, Everything, Facts, Following, Form, In, On, SceneFile, ask
from regdb_runtime.commands.verdict_text import explanation_data, explanation_text


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
    """Say why a verdict is as it is, and what would turn it."""
    asked = ask(scene, fact, current, following, place, on, db, codes, format_)
    typer.echo(json.dumps(explanation_data(asked), indent=2) if format_ == "json" else explanation_text(asked, everything=everything))
    raise typer.Exit(asked.exit_code)
