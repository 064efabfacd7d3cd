"""`regdb match`: which facts a text about a driving scene states, with the words underlined, and what was set aside and why."""

import json
import sys
from pathlib import Path
from typing import Annotated

import typer

from regdb.front import database as compiled
from regdb.front import told
from regdb_runtime.commands.asking import FORMATS, Codes, Db, Form
from regdb_runtime.commands.match_text import reading_data, reading_text
from regdb_runtime.database import RegulationDatabase
from regdb_runtime.errors import RegdbRuntimeError
from regdb_runtime.perception.lexicon import PhraseError
from regdb_runtime.perception.matcher import Matcher

Text = Annotated[str | None, typer.Argument(help="The text; left out, or -, it is read from standard input.")]
File = Annotated[Path | None, typer.Option("--file", "-i", help="Read the text from a file instead.")]


def command(text: Text = None, file: File = None, db: Db = None, codes: Codes = None, format_: Form = "text") -> None:
    """Say which facts a text about a driving scene states, and by which words."""
    if format_ not in FORMATS:
        raise _refused(f"unknown format {format_!r}; there are: {', '.join(FORMATS)}")
    words = _text(text, file)
    try:
        vocabulary = RegulationDatabase.open(db if db is not None else compiled(codes)).vocabulary
        reading = Matcher(vocabulary).read(words)
    except (RegdbRuntimeError, PhraseError) as error:
        raise _refused(str(error)) from None
    typer.echo(json.dumps(reading_data(reading, vocabulary), indent=2) if format_ == "json" else reading_text(reading, vocabulary))


def _text(text: str | None, file: Path | None) -> str:
    """What to read, from wherever it comes. Exits 2 where there is nothing."""
    if text not in (None, "-") and file is not None:
        raise _refused("give the text or --file, not both")
    try:
        found = file.read_text("utf-8") if file is not None else sys.stdin.read() if text in (None, "-") else str(text)
    except (OSError, UnicodeDecodeError) as error:
        raise _refused(f"{file or 'standard input'} cannot be read: {getattr(error, 'strerror', None) or 'it is no UTF-8 text'}") from None
    if not found.strip():
        raise _refused("there is no text to read")
    return found.rstrip("\n")


def _refused(problem: str) -> typer.Exit:
    typer.echo(told(f"error: {problem}"), err=True)
    return typer.Exit(2)
