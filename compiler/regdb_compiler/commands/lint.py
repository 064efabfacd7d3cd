"""`regdb lint`: check the codes."""

from pathlib import Path
from typing import Annotated

import typer

from regdb.front import codes_folder
from regdb_compiler.driver import build
from regdb_compiler.report import FORMATS


def command(
    paths: Annotated[list[Path] | None, typer.Argument(help="Files or folders to report on; default: all.")] = None,
    codes: Annotated[Path | None, typer.Option(help="Folder of codes.")] = None,
    format_: Annotated[str, typer.Option("--format", help="text, concise, json, sarif, junit or github.")] = "text",
) -> None:
    found = build(codes_folder(codes))
    wanted = [str(path.resolve().relative_to(found.corpus.root.parent)) for path in paths or ()]
    kept = [item for item in found.diagnostics if not wanted or any(item.place.path.startswith(name) for name in wanted)]
    typer.echo(FORMATS[format_](kept, found.corpus.texts))
    raise typer.Exit(1 if any(item.level == "error" for item in kept) else 0)
