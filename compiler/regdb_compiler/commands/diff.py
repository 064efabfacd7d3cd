"""`regdb diff`: compare two dates, two jurisdictions, two folders or two databases."""

import datetime
import re
from pathlib import Path
from typing import Annotated

import typer

from regdb import completion
from regdb.front import FrontError, database
from regdb_compiler.diff.compare import DATE_FIELDS, Change, compare, compare_by_topic
from regdb_compiler.diff.report import to_json, to_text
from regdb_compiler.diff.sides import Item, jurisdiction_paths, read_items


def command(
    old: Annotated[str, typer.Argument(help="A date, a jurisdiction, a folder of codes or a database.", autocompletion=completion.jurisdictions)],
    new: Annotated[str, typer.Argument(help="The other one, of the same kind.", autocompletion=completion.jurisdictions)],
    codes: Annotated[Path | None, typer.Option(help="Folder of codes (for dates and jurisdictions).")] = None,
    in_: Annotated[str | None, typer.Option("--in", help="Only law that governs this jurisdiction.", autocompletion=completion.jurisdictions)] = None,
    on: Annotated[str | None, typer.Option("--on", help="The day, for jurisdictions; default: today.")] = None,
    format_: Annotated[str, typer.Option("--format", help="text or json.")] = "text",
) -> None:
    if format_ not in {"text", "json"}:
        raise typer.BadParameter("--format is text or json")
    names, changes = _compare(old, new, codes, in_, on)
    typer.echo((to_json if format_ == "json" else to_text)(*names, changes))
    raise typer.Exit(1 if changes else 0)


def _compare(old: str, new: str, codes: Path | None, in_: str | None, on: str | None) -> tuple[tuple[str, str], tuple[Change, ...]]:
    _refuse_bad_dates(old, new, *([on] if on else []))
    if _is_date(old) and _is_date(new):
        path = database(codes)
        where = _path_of(path, in_) if in_ else None
        place = f" in {in_}" if in_ else ""
        before, after = (read_items(path, on=day, jurisdictions=where) for day in (old, new))
        return (old, new + place), compare(before, after, DATE_FIELDS)
    if Path(old).exists() and Path(new).exists():
        return (old, new), compare(_items_at(Path(old), in_, on), _items_at(Path(new), in_, on))
    if _is_date(old) or _is_date(new):
        raise FrontError(f"{old} and {new} are not of one kind: compare two dates, two jurisdictions, two folders or two databases")
    path = database(codes)
    paths = jurisdiction_paths(path)
    for name in (old, new):
        if name not in paths:
            known = ", ".join(sorted(paths))
            raise FrontError(f"{name!r} is no date, no file and no jurisdiction; jurisdictions: {known}")
    day = on or datetime.date.today().isoformat()
    when = f"on {day}" + ("" if on else " (today)")
    return (old, f"{new} {when}"), compare_by_topic(_own(path, paths, old, day), _own(path, paths, new, day))


def _own(path: Path, paths: dict[str, frozenset[str]], name: str, day: str) -> list[Item]:
    """The law a jurisdiction itself made: its path's last step."""
    above = max((other for other in paths.values() if other < paths[name]), key=len, default=frozenset())
    return [item for item in read_items(path, on=day) if item.jurisdiction in paths[name] - above]


def _path_of(path: Path, name: str) -> frozenset[str]:
    paths = jurisdiction_paths(path)
    if name not in paths:
        raise FrontError(f"unknown jurisdiction {name!r}; known: {', '.join(sorted(paths))}")
    return paths[name]


def _items_at(path: Path, in_: str | None, on: str | None) -> tuple[Item, ...]:
    found = database(path) if path.is_dir() else path
    return read_items(found, on=on, jurisdictions=_path_of(found, in_) if in_ else None)


def _refuse_bad_dates(*texts: str) -> None:
    """Text in the form of a date that is none, such as 2026-02-30. Raises FrontError."""
    for text in texts:
        if re.fullmatch(r"\d+-\d+-\d+", text) and not _is_date(text) and not Path(text).exists():
            raise FrontError(f"{text!r} is no date; write it as 2026-03-02")


def _is_date(text: str) -> bool:
    try:
        return len(text) == 10 and bool(datetime.date.fromisoformat(text))
    except ValueError:
        return False
