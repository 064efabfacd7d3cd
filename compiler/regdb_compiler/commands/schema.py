"""`regdb schema`: the JSON Schema of the file formats, for editors."""

import json
from pathlib import Path
from typing import Annotated, Any

import typer

from regdb.front import FrontError, codes_folder
from regdb_compiler.commands.options import Codes

NAMES = ("section", "cases", "vocabulary", "states", "jurisdictions", "outline", "interpretation")
"""Kinds of files that have a schema."""

_LISTED = ", ".join(NAMES)


def command(
    name: Annotated[str, typer.Argument(metavar="[NAME]", help=f"One of: {_LISTED}.", autocompletion=lambda: list(NAMES))] = "",
    codes: Codes = None,
    write: Annotated[Path | None, typer.Option("--write", metavar="DIR", help="Write all of them as DIR/<name>.json.")] = None,
) -> None:
    if name and name not in NAMES:
        raise typer.BadParameter(f"there is no schema {name!r}; there are: {_LISTED}", param_hint="NAME")
    if not name and write is None:
        typer.echo("\n".join(NAMES))
        return
    # Loaded here so that the shell's completion, which loads this module, need not wait for them.
    from regdb_compiler.emit.to_json_schema import json_schema
    from regdb_compiler.read_corpus import read_corpus

    corpus = read_corpus(codes_folder(codes))
    if write is None:
        typer.echo(_text(json_schema(name, corpus.vocabulary, corpus.machine, corpus.tree)), nl=False)
        return
    for item in [name] if name else NAMES:
        _write(write / f"{item}.json", _text(json_schema(item, corpus.vocabulary, corpus.machine, corpus.tree)))


def _text(schema: dict[str, Any]) -> str:
    return json.dumps(schema, indent=1, ensure_ascii=False) + "\n"


def _write(path: Path, text: str) -> None:
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, "utf-8", newline="\n")
    except OSError as error:
        raise FrontError(f"{path} cannot be written: {error.strerror}") from error
    typer.echo(str(path))
