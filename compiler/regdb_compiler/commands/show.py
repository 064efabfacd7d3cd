"""`regdb show`: a section, regulation, citation, fact, state, topic or jurisdiction, with what hangs on it; `states`: the machine."""

import json
from enum import StrEnum
from typing import Annotated

import typer

from regdb import completion
from regdb.front import database
from regdb.state_diagram import to_dot, to_mermaid
from regdb_compiler.commands.options import Codes, In, On, asked_day, has_color
from regdb_compiler.commands.progress import working


class ShowFormat(StrEnum):
    """How the answer is written; the diagrams are of the state machine alone."""

    text = "text"
    json = "json"
    mermaid = "mermaid"
    dot = "dot"


DIAGRAMS = {ShowFormat.mermaid: to_mermaid, ShowFormat.dot: to_dot}


def command(
    name: Annotated[
        list[str] | None, typer.Argument(metavar="NAME...", help="cvc-21453-a, CVC 21453(b), 21453, a fact, a state, `states`.",
                                  autocompletion=completion.subjects)
    ] = None,
    interpretation: Annotated[
        str, typer.Option("--interpretation", metavar="NAME", help="A profile by which a runtime decides what has no number in law.")
    ] = "",
    codes: Codes = None,
    on: On = "",
    in_: In = "",
    format_: Annotated[ShowFormat, typer.Option("--format", help="text; json, which is stable; mermaid or dot for `states`.")] = ShowFormat.text,
) -> None:  # fmt: skip
    # Loaded here so that the shell's completion, which loads this module, need not wait for them.
    from regdb_compiler.commands.show_text import show_text
    from regdb_compiler.library import Library
    from regdb_compiler.shown import shown

    if bool(name) == bool(interpretation):
        raise typer.BadParameter("name what to show, or a profile with --interpretation", param_hint="NAME")
    day = asked_day(on)
    with working("compiling"):
        path = database(codes)
    with Library(path, in_) as library:
        found = library.interpretation(interpretation) if interpretation else library.find(" ".join(name or ()))
        if format_ in DIAGRAMS:
            if found.kind != "machine":
                raise typer.BadParameter(f"{format_} draws the state machine alone: regdb show states --format {format_}", param_hint="--format")
            typer.echo(DIAGRAMS[format_](library.machine), nl=False)
            return
        data = shown(library, found, day.iso)
    if format_ is ShowFormat.json:
        typer.echo(json.dumps(data, indent=1, ensure_ascii=False))
    else:
        typer.echo(show_text(data, str(day), color=has_color()), nl=False)
