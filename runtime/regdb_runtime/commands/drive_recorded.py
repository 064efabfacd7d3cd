"""`regdb drive observe` and `regdb drive recorded`: recorded streets, judged as they are, or driven by the planner."""

from __future__ import annotations

import datetime
import json
import sys
from pathlib import Path
from typing import get_args

import typer

from regdb.front import FrontError, database, told
from regdb_runtime.commands.drive_options import Options
from regdb_runtime.database import RegulationDatabase
from regdb_runtime.drive.observed.observe import about, draw_observed, observe, open_recording, write_observed
from regdb_runtime.drive.observed.observer import ObserverSettings
from regdb_runtime.drive.observed.report import data, text
from regdb_runtime.drive.prepare import Choices
from regdb_runtime.drive.recorded_drive import LOOP, draw_recorded, drive_recorded, lights_said, recorded_spec, write_recorded
from regdb_runtime.drive.summary import markdown, row_data, row_of, table
from regdb_runtime.errors import MissingExtra
from regdb_runtime.worlds.recorded_spec import LightPlan, LightsSpec
from regdb_runtime.worlds.scene_spec import EyeSpec

MODEL = "model"
"""Whom a place without a name is asked of: the model code, which binds nobody."""


def observe_file(file: Path | None, options: Options) -> int:
    """Judge recorded vehicles; 1 when one broke the law."""
    if file is None:
        raise FrontError("which recording? type: regdb drive observe FILE")
    if options.eye == "recorded":
        raise FrontError("a recording of traffic has no eye; --eye is scripted or none")
    eye = "scripted" if options.eye == "scripted" else "none"
    settings = ObserverSettings(options.place or MODEL, _start(options), eye, options.interpretation or "statute_only")  # type: ignore[arg-type]  # one of two
    observer = open_recording(file, _open(options.db), settings)
    found = observe(observer, options.vehicles, _progress)
    _progress_over()
    folder = options.folder / f"observe-{observer.replay.traffic.id}"
    write_observed(observer, found, folder)
    if options.figures:
        try:
            draw_observed(observer, found, folder)
        except MissingExtra as error:
            typer.echo(told(f"no pictures: {error}"), err=True)
    said = about(observer)
    if options.form == "json":
        typer.echo(json.dumps(data(said, found), indent=2, ensure_ascii=False))
    else:
        typer.echo(text(said, found))
        for line in _not_given(options):
            typer.echo(told(line))
        typer.echo(f"written: {folder}")
    return 1 if any(item.broken for item in found) else 0


def drive_file(file: Path | None, options: Options) -> int:
    """Drive a route among recorded traffic."""
    if file is None or not options.route:
        raise FrontError("which street, and which way? type: regdb drive recorded FILE --route LANE,LANE")
    if options.lights not in get_args(LightPlan):
        raise FrontError(f"--lights is one of: {', '.join(get_args(LightPlan))}")
    lanes = [name.strip() for name in options.route.split(",") if name.strip()]
    eye = EyeSpec("none" if options.eye == "none" else "scripted")
    spec = recorded_spec(
        f"{file.stem}-{lanes[-1]}", file, lanes, place=options.place or MODEL, start=_start(options).isoformat(),
        lights=LightsSpec(options.lights), eye=eye,  # type: ignore[arg-type]  # checked above
    )  # fmt: skip
    law = _open(options.db)
    log = drive_recorded(spec, law, Choices("recorded", options.profile, LOOP), lambda time: _progress(f"{time:.0f} s driven"))
    _progress_over()
    folder = options.folder / spec.name
    write_recorded(log, spec, folder)
    if options.figures:
        try:
            draw_recorded(log, spec, law.vocabulary, folder)
        except MissingExtra as error:
            typer.echo(told(f"no figures: {error}"), err=True)
    row = row_of(log, None)
    (folder / "summary.md").write_text(markdown([row]), "utf-8")
    if options.form == "json":
        typer.echo(json.dumps({"schema": "regdb-drive-summary/1", "folder": str(folder), "drives": [row_data(row)]}, indent=2))
    else:
        typer.echo(table([row]))
        typer.echo(told(f"Lights: {lights_said(spec)}. Others: recorded for {log.run['recording']['seconds']:g} s; {log.run['recording']['note']}."))
        for line in _not_given(options):
            typer.echo(told(line))
        typer.echo(f"written: {folder}")
    return 0 if log.end["ended"] == "destination" else 1


def _start(options: Options) -> datetime.datetime:
    """The day and time: noon where no time is given, today where no day is."""
    try:
        given = options.on or datetime.date.today().isoformat()
        found = datetime.datetime.fromisoformat(given)
    except ValueError:
        raise FrontError(f"--on: {options.on!r} is no day; write 2026-03-02, or 2026-03-02T08:30") from None
    return found if "T" in given else found.replace(hour=12)


def _not_given(options: Options) -> list[str]:
    """What was taken because it was not given."""
    found = []
    if not options.place:
        found.append("No place was given, so the model code answers; name one:  --in los_angeles")
    if not options.on:
        found.append("No day was given: today at noon; name one:  --on 2026-03-02")
    return found


def _open(db: Path | None) -> RegulationDatabase:
    return RegulationDatabase.open(db if db is not None else database())


def _progress(said: str) -> None:
    if sys.stderr.isatty():
        typer.echo(f"\r\033[K{said}", err=True, nl=False)


def _progress_over() -> None:
    if sys.stderr.isatty():
        typer.echo("\r\033[K", err=True, nl=False)
