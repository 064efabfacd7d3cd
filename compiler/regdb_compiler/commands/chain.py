"""`regdb chain`: what displaces a regulation, and what it displaces, as a tree."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import asdict
from typing import TYPE_CHECKING, Annotated

import typer

from regdb import completion
from regdb.front import FrontError, database
from regdb_compiler.commands.options import Codes, Format, In, On, Output, asked_day, has_color
from regdb_compiler.commands.progress import working
from regdb_compiler.commands.sheet import WIDTH, Sheet, wrapped

if TYPE_CHECKING:
    from regdb_compiler.library import Library
    from regdb_compiler.relations import Link

_KINDS = {"exception_to": "exception", "overrides": "override"}


def command(
    name: Annotated[
        list[str], typer.Argument(metavar="NAME...", help="cvc-21453-a, CVC 21453(a).", autocompletion=completion.regulations)
    ],
    codes: Codes = None,
    on: On = "",
    in_: In = "",
    format_: Output = Format.text,
) -> None:  # fmt: skip
    # Loaded here so that the shell's completion, which loads this module, need not wait for them.
    from regdb_compiler.library import Library
    from regdb_compiler.relations import displaced_by, displaces

    day = asked_day(on)
    with working("compiling"):
        path = database(codes)
    with Library(path, in_) as library:
        ids = _ids(library, " ".join(name))
        trees = [(displaced_by(library, item, day.iso), displaces(library, item, day.iso)) for item in ids]
    if format_ is Format.json:
        data = [{"id": up.id, "displaced_by": asdict(up)["links"], "displaces": asdict(down)["links"]} for up, down in trees]
        typer.echo(json.dumps({"on": day.iso, "regulations": data}, indent=1, ensure_ascii=False))
        return
    sheet = Sheet(color=has_color())
    for up, down in trees:
        _write(sheet, up, down)
    sheet.gap()
    sheet.line(f"law as of {day}")
    typer.echo(sheet.render(), nl=False)


def _ids(library: Library, text: str) -> tuple[str, ...]:
    """Regulations the words name; of a section all. Raises FrontError."""
    found = library.find(text)
    if found.kind == "regulation":
        return found.names
    if found.kind == "section":
        query = """SELECT DISTINCT r.id FROM regulation r JOIN section_version v ON v.key = r.section_version
                   WHERE v.section = ? ORDER BY r.key"""
        names = [name for section in found.names for name in library.column(query, section)]
        if names:
            return tuple(names)
    raise FrontError(f"{text!r} is a {found.kind} without regulations; chain takes a regulation, such as cvc-21453-a")


def _write(sheet: Sheet, up: Link, down: Link) -> None:
    sheet.heading(f"{up.citation}  {up.id}  ({_dates(up)})")
    sheet.line(f"  {'may' if up.legality else 'forbidden'}: {up.result}")
    for title, root in (("displaced by", up), ("displaces", down)):
        sheet.line(f"  {title}" + ("" if root.links else ": nothing"))
        sheet.verbatim(_branches(root, "  "))


def _branches(link: Link, indent: str) -> Iterator[str]:
    """ASCII branches; the result stands under each regulation, long lines broken beside the branch."""
    for position, item in enumerate(link.links):
        last = position == len(link.links) - 1
        authority = f", by {item.authority}" if item.authority else ""
        above = " (shown above)" if item.seen else ""
        head = f"{item.citation}  {item.id}  [{_KINDS[item.kind]}{authority}; {_dates(item)}]{above}"
        below = indent + ("    " if last else "|   ")
        first, *rest = wrapped(head, max(WIDTH - len(indent) - 4, 30))
        yield f"{indent}{'`-- ' if last else '|-- '}{first}"
        yield from (f"{below}{line}" for line in rest)
        yield from (f"{below}{line}" for line in wrapped(item.result, max(WIDTH - len(below), 30)) if not item.seen)
        yield from _branches(item, below)


def _dates(link: Link) -> str:
    return f"{link.effective or 'ever'} to {link.until}" if link.until else f"since {link.effective or 'ever'}"
