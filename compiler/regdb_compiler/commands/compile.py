"""`regdb compile`: the codes as database, CSV, JSON and manifest."""

import json
from pathlib import Path
from typing import Annotated

import typer

from regdb.front import FrontError, codes_folder
from regdb_compiler.commands.options import Codes, Format, On, Output, asked_day, has_color
from regdb_compiler.commands.progress import working
from regdb_compiler.diagnostics import Diagnostic
from regdb_compiler.driver import Build, build
from regdb_compiler.emit.outputs import Outputs, write_outputs
from regdb_compiler.report import to_json as findings_json
from regdb_compiler.report.text import render
from regdb_compiler.source import collector_paused


def command(
    codes: Codes = None,
    output: Annotated[Path, typer.Option("-o", "--output", metavar="DIR", help="Where the files go.")] = Path("out"),
    on: On = "",
    parquet: Annotated[bool, typer.Option("--parquet", help="Also write regulations.parquet (needs pandas and pyarrow).")] = False,
    format_: Output = Format.text,
) -> None:
    day = asked_day(on).number if on else None
    with collector_paused():  # everything made here lives until the end
        _compile(codes, output, on, day, format_, parquet=parquet)


def _compile(codes: Path | None, output: Path, on: str, day: int | None, format_: Format, *, parquet: bool) -> None:
    with working("reading the codes"):
        found = build(codes_folder(codes))
    errors = [item for item in found.diagnostics if item.level == "error"]
    if errors:
        _report(errors, found, format_)
        raise typer.Exit(1)
    try:
        with working(f"writing to {output}"):
            outputs = write_outputs(found, output, day, parquet=parquet)
    except OSError as error:
        raise FrontError(f"{output} cannot be written: {error.strerror}") from error
    typer.echo(_json(outputs, on) if format_ is Format.json else _text(outputs, on), nl=False)


def _report(errors: list[Diagnostic], found: Build, format_: Format) -> None:
    if format_ is Format.json:
        typer.echo(findings_json.render(errors, found.corpus.texts), nl=False)
    else:
        typer.echo(render(errors, found.corpus.texts, color=has_color()), nl=False)
        typer.echo("nothing was written", err=True)


def _text(outputs: Outputs, on: str) -> str:
    rows = outputs.database.rows
    lines = [f"{outputs.folder / item.name!s:<40} {size_in_words(item.size):>10}" for item in outputs.files]
    scope = f" in force on {on}" if on else ""
    counted = f"{rows['regulation']:,} regulations{scope}, {rows['section_version']:,} versions of {rows['section']:,} sections"
    return "\n".join([*lines, "", counted, f"content hash {outputs.database.content_hash}"]) + "\n"


def _json(outputs: Outputs, on: str) -> str:
    data = {
        "folder": str(outputs.folder),
        "files": [{"name": item.name, "size": item.size, "sha256": item.sha256} for item in outputs.files],
        "rows": dict(outputs.database.rows),
        "content_hash": outputs.database.content_hash,
        "in_force_on": on or None,
    }
    return json.dumps(data, indent=1, ensure_ascii=False) + "\n"


def size_in_words(size: int) -> str:
    """`512 B`, `1.5 KB`, `12.3 MB`."""
    if size < 1000:
        return f"{size} B"
    return f"{size / 1000:.1f} KB" if size < 1_000_000 else f"{size / 1_000_000:.1f} MB"
