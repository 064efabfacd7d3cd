"""`regdb drive`: the paper's drive and its variants, replays, recorded streets observed or driven; each writes what it found with pictures of it.

What to do is the first word; each has a function of its own in WAYS, so a new way is an entry there.
"""

from __future__ import annotations

import difflib
import json
import os
import sys
import textwrap
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer

from regdb.front import ADDED_CODES, FrontError, database, told
from regdb_runtime.commands.drive_options import Options
from regdb_runtime.database import RegulationDatabase
from regdb_runtime.drive.log import Log, read_log
from regdb_runtime.drive.outputs import draw_drive, write_drive
from regdb_runtime.drive.paper_scene import scene_spec
from regdb_runtime.drive.prepare import Choices, choices_of, drive_scene, eye_record, first_difference, with_eye, write_text
from regdb_runtime.drive.summary import Row, markdown, row_data, row_of, table
from regdb_runtime.drive.variants import VARIANTS, Variant, variant
from regdb_runtime.errors import MissingExtra, RegdbRuntimeError
from regdb_runtime.worlds.scene_spec import SceneSpec

EYES = ("scripted", "recorded", "none", "frames")


def command(
    what: Annotated[str, typer.Argument(help="paper, list, replay, observe, recorded, frames, or degradation.")],
    file: Annotated[Path | None, typer.Argument(help="replay: a scene (JSON) or a log (JSONL). observe, recorded: CommonRoad traffic (XML).")] = None,
    out: Annotated[Path | None, typer.Option("-o", "--out", help="Where logs, figures and the table go; default: out/drive.")] = None,
    names: Annotated[list[str] | None, typer.Option("--variant", help="A variant's name, or all; repeatable.")] = None,
    world: Annotated[str, typer.Option(help="built-in or sumo.")] = "built-in",
    eye: Annotated[str, typer.Option(help="What tells facts of perception: scripted, recorded, none, or frames.")] = "",
    record: Annotated[Path | None, typer.Option(help="recorded: its file (JSONL); default: made from a scripted drive.")] = None,
    profile: Annotated[str, typer.Option(help="What plans are weighed by: default, or the paper's terms.")] = "default",
    seed: Annotated[int | None, typer.Option(help="Seed of the other traffic.")] = None,
    db: Annotated[Path | None, typer.Option("--db", help="Compiled database; default: compiled from the codes.")] = None,
    figures: Annotated[bool, typer.Option(help="Draw the figures and pictures.")] = True,
    vehicles: Annotated[list[str] | None, typer.Option("--vehicle", help="observe: a recorded vehicle; repeatable; default: all.")] = None,
    place: Annotated[str, typer.Option("--in", help="observe, recorded: jurisdiction; default: the model code.")] = "",
    on: Annotated[str, typer.Option("--on", help="observe, recorded: day, or day and time; default: today at noon.")] = "",
    route: Annotated[str, typer.Option(help="recorded: lanes from start to end, with commas.")] = "",
    lights: Annotated[str, typer.Option(help="recorded: what lights show, red or green first, nominal or none.")] = "red",
    interpretation: Annotated[str, typer.Option(help="observe: profile for what the law leaves to judgement.")] = "",
    error_rate: Annotated[
        float | None, typer.Option(min=0.0, max=1.0, help="frames, degradation: share of the model's answers that are wrong.")
    ] = None,
    format_: Annotated[str, typer.Option("--format", help="text or json.")] = "text",
) -> None:
    """Drive the paper's experiment by the law in the database, or observe recorded traffic."""
    way = WAYS.get(what)
    if way is None:
        near = difflib.get_close_matches(what, WAYS, 1)
        raise FrontError(f"`regdb drive` knows {', '.join(WAYS)}, not {what!r}" + (f"; did you mean {near[0]}?" if near else ""))
    if format_ not in {"text", "json"}:
        raise FrontError("--format is text or json")
    if eye and eye not in EYES:
        raise FrontError(f"--eye is {', '.join(EYES[:-1])} or {EYES[-1]}")
    options = Options(
        out, tuple(names or ("paper",)), world, eye, record, profile, seed, db, figures, format_, tuple(vehicles or ()), place, on, route, lights,
        interpretation, error_rate,
    )
    try:
        code = way(file, options)
    except RegdbRuntimeError as error:
        raise FrontError(str(error)) from None
    raise typer.Exit(code)


def _paper(file: Path | None, options: Options) -> int:
    """Drive the paper's experiment, or variants of it."""
    if file is not None:
        raise FrontError(f"`regdb drive paper` takes no file; to drive a scene of your own:  regdb drive replay {file}")
    chosen = VARIANTS if "all" in options.variants else tuple(variant(name) for name in options.variants)
    rows = [_drive_variant(item, options) for item in chosen]
    return _show(rows, options)


def _drive_variant(item: Variant, options: Options) -> Row:
    """One variant, driven and written."""
    law = _open(options.db, item.codes)
    scene = item.scene if options.seed is None else replace(item.scene, seed=options.seed)
    spec = scene_spec(scene, item.name)
    folder = options.folder / item.name
    if options.eye == "frames":
        return _drive_by_frames(item, spec, law, folder, options)
    if options.eye:
        spec = with_eye(spec, options.eye, _record_for(item.name, spec, law, folder, options))  # type: ignore[arg-type]  # checked by `command`
    log = _driven(item.name, spec, law, Choices(options.world, options.profile))
    _write(log, spec, law, folder, options)
    blinded = spec.eye.kind == "none" != item.scene.eye
    return row_of(log, None if blinded else item)


def _drive_by_frames(item: Variant, spec: SceneSpec, law: RegulationDatabase, folder: Path, options: Options) -> Row:
    """One variant by what a model says of rendered frames; what it must do is expected of one that errs not."""
    from regdb_runtime.commands.drive_frames import by_frames

    log = by_frames(item.name, spec, law, options)
    _write(log, spec, law, folder, options)
    return row_of(log, None if options.error_rate else item)


def _record_for(name: str, spec: SceneSpec, law: RegulationDatabase, folder: Path, options: Options) -> str:
    """The file a recorded eye reads: the one given, else one made by a scripted drive. Empty for other eyes."""
    if options.eye != "recorded":
        return ""
    if options.record is not None:
        return str(options.record)
    log = _driven(f"{name}, to record its eye", with_eye(spec, "scripted"), law, Choices(options.world, options.profile))
    path = folder / "eye.jsonl"
    write_text(path, "".join(f"{line}\n" for line in eye_record(log, law.vocabulary)))
    return str(path)


def _list(file: Path | None, options: Options) -> int:
    """Name every variant with what it expects."""
    if file is not None:
        raise FrontError("`regdb drive list` takes no file")
    if options.form == "json":
        typer.echo(json.dumps([{"variant": item.name, "expects": item.expects.says, "on": item.scene.start[:10]} for item in VARIANTS], indent=2))
    else:
        for item in VARIANTS:
            head = f"{item.name:<22}"
            typer.echo(textwrap.fill(f"{item.expects.says} ({item.scene.start[:10]})", 80, initial_indent=head, subsequent_indent=" " * 22))
    return 0


def _replay(file: Path | None, options: Options) -> int:
    """Drive a scene of one's own, or a log again to see whether it comes out the same."""
    if file is None:
        raise FrontError("which scene or log? type: regdb drive replay FILE")
    if file.suffix == ".jsonl":
        return _replay_log(read_log(file), file, options)
    try:
        text = file.read_text("utf-8")
        spec = SceneSpec.from_json(text)
    except (OSError, UnicodeDecodeError) as error:
        raise FrontError(f"{file} cannot be read: {getattr(error, 'strerror', None) or 'it is not UTF-8 text'}") from None
    except json.JSONDecodeError as error:
        raise FrontError(f"{file}:{error.lineno}:{error.colno}: this is no JSON: {error.msg}") from None
    law = _open(options.db, "")
    log = _driven(spec.name, spec, law, Choices(options.world, options.profile))
    _write(log, spec, law, options.folder / spec.name, options)
    return _show([row_of(log, None)], options)


def _replay_log(before: Log, file: Path, options: Options) -> int:
    spec, choices = choices_of(before)
    name = before.run["variant"]
    known = next((item for item in VARIANTS if item.name == name), None)
    law = _open(options.db, known.codes if known is not None else "")
    log = _driven(name, spec, law, choices)
    if options.out is not None:
        _write(log, spec, law, options.out / name, options)
    difference = first_difference(before, log)
    if law.hash != before.run["database"]:
        change = f"it was driven by law {before.run['database'][:12]}, now by {law.hash[:12]}"
        difference = f"{difference or 'the same drive'}; {change}"
    if options.form == "json":
        typer.echo(json.dumps({"schema": "regdb-drive-replay/1", "file": str(file), "same": not difference, "difference": difference}, indent=2))
    else:
        typer.echo(f"{file}: {difference}" if difference else f"{file}: {len(log.ticks)} ticks, the same to the last byte")
    return 1 if difference else 0


def _observe(file: Path | None, options: Options) -> int:
    """Judge recorded traffic."""
    from regdb_runtime.commands.drive_recorded import observe_file

    return observe_file(file, options)


def _recorded(file: Path | None, options: Options) -> int:
    """Drive among recorded traffic."""
    from regdb_runtime.commands.drive_recorded import drive_file

    return drive_file(file, options)


def _frames(file: Path | None, options: Options) -> int:
    """Write what the camera sees."""
    from regdb_runtime.commands.drive_frames import frames_run

    return frames_run(file, options)


def _degradation(file: Path | None, options: Options) -> int:
    """Drive by a model that errs."""
    from regdb_runtime.commands.drive_frames import degradation_run

    return degradation_run(file, options)


WAYS: Mapping[str, Callable[[Path | None, Options], int]] = {
    "paper": _paper, "list": _list, "replay": _replay, "observe": _observe, "recorded": _recorded, "frames": _frames,
    "degradation": _degradation,
}  # fmt: skip
"""First word -> what it does; returns the exit code."""


def _driven(name: str, spec: SceneSpec, law: RegulationDatabase, choices: Choices) -> Log:
    """One drive, with a line of progress on a terminal."""
    with _progress(name) as tell:
        return drive_scene(name, spec, law, choices, tell)


def _write(log: Log, spec: SceneSpec, law: RegulationDatabase, folder: Path, options: Options) -> None:
    """The log always; figures where they are wanted and can be drawn."""
    write_drive(log, spec, folder)
    if options.figures:
        try:
            draw_drive(log, spec, law.vocabulary, folder)
        except MissingExtra as error:
            typer.echo(told(f"no figures: {error}"), err=True)


@contextmanager
def _progress(name: str) -> Iterator[Callable[[float], None] | None]:
    if not sys.stderr.isatty():
        yield None
        return

    def tell(time: float) -> None:
        if round(time * 10) % 10 == 0:
            typer.echo(f"\r{name}: {time:.0f} s driven", err=True, nl=False)

    yield tell
    typer.echo("\r\033[K", err=True, nl=False)


def _open(db: Path | None, codes: str) -> RegulationDatabase:
    """The database named, else the one compiled from the codes, with a folder of this package added where a variant needs it."""
    if db is not None:
        return RegulationDatabase.open(db)
    with _added(Path(__file__).parents[1] / "drive" / codes if codes else None):
        return RegulationDatabase.open(database())


@contextmanager
def _added(folder: Path | None) -> Iterator[None]:
    """The environment with one more folder of added codes."""
    before = os.environ.get(ADDED_CODES)
    if folder is not None:
        os.environ[ADDED_CODES] = os.pathsep.join(part for part in (str(folder), before or "") if part)
    try:
        yield
    finally:
        if folder is not None:
            if before is None:
                del os.environ[ADDED_CODES]
            else:
                os.environ[ADDED_CODES] = before


def _show(rows: Sequence[Row], options: Options) -> int:
    """The table on stdout and beside the drives; 1 when a drive is not as expected."""
    folder = options.folder
    write_text(folder / "summary.md", markdown(rows))
    if options.form == "json":
        typer.echo(json.dumps({"schema": "regdb-drive-summary/1", "folder": str(folder), "drives": [row_data(row) for row in rows]}, indent=2))
    else:
        typer.echo(table(rows))
        typer.echo(f"written: {folder}/summary.md, and a folder with log and figures for each drive")
    return 1 if any(row.wrong for row in rows) else 0
