"""`regdb search`: the law that speaks of these words."""

import json
from dataclasses import asdict
from typing import Annotated

import typer

from regdb.front import database
from regdb_compiler.commands.options import AskedDay, Codes, Format, In, On, Output, asked_day, has_color
from regdb_compiler.commands.progress import working
from regdb_compiler.commands.sheet import Sheet
from regdb_compiler.library import Library
from regdb_compiler.word_search import CLOSE, OPEN, Hit, search


def command(
    words: Annotated[list[str], typer.Argument(metavar="WORDS...", help="Words of condition, result, title or text.")],
    codes: Codes = None,
    on: On = "",
    in_: In = "",
    limit: Annotated[int, typer.Option("--limit", "-n", min=1, help="Most hits shown.")] = 10,
    format_: Output = Format.text,
) -> None:
    day = asked_day(on)
    with working("compiling"):
        path = database(codes)
    with Library(path, in_) as library:
        hits = search(library, " ".join(words), day.iso, limit)
    if format_ is Format.json:
        plain = [asdict(hit) | {"passage": _marked(hit.passage, "", "")} for hit in hits]
        typer.echo(json.dumps({"on": day.iso, "words": " ".join(words), "hits": plain}, indent=1, ensure_ascii=False))
    else:
        typer.echo(_text(hits, day, color=has_color()), nl=False)
    raise typer.Exit(0 if hits else 1)


def _text(hits: tuple[Hit, ...], day: AskedDay, *, color: bool) -> str:
    sheet = Sheet(color=color)
    for hit in hits:
        sheet.heading(f"{hit.citation}  {hit.title}  ({hit.id})")
        start, end = ("\033[1m", "\033[0m") if color else ("*", "*")
        sheet.passage(_marked(" ".join(hit.passage.split()), start, end))
    sheet.gap()
    found = f"{len(hits)} found" if hits else "nothing found"
    sheet.line(f"{found}; law as of {day}")
    return sheet.render()


def _marked(passage: str, start: str, end: str) -> str:
    return passage.replace(OPEN, start).replace(CLOSE, end)
