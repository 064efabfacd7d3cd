"""`regdb explain`: why a verdict is as it is, and the smallest change that would turn it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

import typer

from regdb import completion
from regdb_runtime.commands.asking import ask
from regdb_runtime.commands.verdict_text import explanation_data, explanation_text


def command(
    scene: Annotated[Path | None, typer.Argument(help="Scene file, YAML or JSON: scene, plan, in, on.")] = None,
    fact: Annotated[
        list[str] | None,
        typer.Option("--fact", "-f", help="A fact of scene or plan as name=value; repeatable.", autocompletion=completion.facts),
    ] = None,
    current: Annotated[str, typer.Option(help="State the vehicle is in.", autocompletion=completion.states)] = "",
    following: Annotated[str, typer.Option("--next", help="State it would go to.", autocompletion=completion.states)] = "",
    place: Annotated[
        str, typer.Option("--in", help="Jurisdiction, or its code; default: the only state.", autocompletion=completion.jurisdictions)
    ] = "",
    on: Annotated[str, typer.Option("--on", help="Day as 2026-03-02; default: today.")] = "",
    db: Annotated[Path | None, typer.Option("--db", help="Compiled database; default: compiled from the codes.")] = None,
    codes: Annotated[Path | None, typer.Option("--codes", help="Folder of codes.")] = None,
    everything: Annotated[bool, typer.Option("--all", help="Show long lists whole.")] = False,
    format_: Annotated[str, typer.Option("--format", help="text or json.")] = "text",
) -> None:
    """Say why a verdict is as it is, and what would turn it."""
    asked = ask(scene, fact, current, following, place, on, db, codes, format_)
    typer.echo(json.dumps(explanation_data(asked), indent=2) if format_ == "json" else explanation_text(asked, everything=everything))
    raise typer.Exit(asked.exit_code)
