"""One recording observed: read, every vehicle judged, written with a picture of each breach."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

from regdb_runtime.database import RegulationDatabase
from regdb_runtime.drive.observed.findings import Finding, Observed
from regdb_runtime.drive.observed.observer import Observer, ObserverSettings
from regdb_runtime.drive.observed.report import NOTES, About, data
from regdb_runtime.drive.picture import Instant, PictureSettings, draw_scene
from regdb_runtime.errors import RequestError, WorldError
from regdb_runtime.maps.commonroad import open_scenario, road_map_of
from regdb_runtime.maps.commonroad_traffic import traffic_of
from regdb_runtime.worlds.recorded import footprint_of
from regdb_runtime.worlds.replay import Replay

VIEW = PictureSettings(along=90.0, across=56.0, pixels=1100)


def open_recording(file: Path, database: RegulationDatabase, settings: ObserverSettings) -> Observer:
    """An observer of one CommonRoad file. Raises MapError, RequestError; WorldError when nothing is recorded in it."""
    root = open_scenario(file)
    observer = Observer(database, road_map_of(root), Replay(traffic_of(root)), settings)
    if not observer.vehicles:
        raise WorldError(f"{file} records no vehicle that moves or could; there is nothing to judge in it")
    return observer


def observe(observer: Observer, wanted: Sequence[str] = (), told: Callable[[str], None] | None = None) -> tuple[Observed, ...]:
    """The vehicles wanted, else all. `told` hears each one's id before it is judged. Raises RequestError for one that is not recorded."""
    for name in wanted:
        if name not in observer.vehicles:
            raise RequestError(f"{observer.replay.traffic.id} has no vehicle {name!r} to judge; there are: {', '.join(observer.vehicles)}")
    found = []
    for name in wanted or observer.vehicles:
        if told is not None:
            told(name)
        found.append(observer.vehicle(name))
    return tuple(found)


def about(observer: Observer) -> About:
    """What is judged, by what."""
    settings, database = observer.settings, observer.database
    place = next(item for item in database.tree if item.id == observer.road_map.jurisdiction)
    notes = NOTES
    if settings.eye == "scripted":
        notes = ("perception is scripted: nothing unusual on the street or about the vehicles", *notes)
    else:
        notes = ("what the recording and its map do not tell is unknown, people on foot included", *notes)
    return About(
        observer.replay.traffic.id, observer.replay.ends, place.id, place.name, f"{settings.start:%Y-%m-%d %H:%M}", settings.eye,
        settings.interpretation, database.hash, place.status == "model", notes,
    )  # fmt: skip


def write_observed(observer: Observer, found: Sequence[Observed], folder: Path) -> Path:
    """`observed.json`."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "observed.json"
    path.write_text(json.dumps(data(about(observer), found), indent=1, ensure_ascii=False) + "\n", "utf-8")
    return path


def draw_observed(observer: Observer, found: Sequence[Observed], folder: Path) -> tuple[Path, ...]:
    """A picture of each breach, at the instant and place of the worst that was measured. Raises MissingExtra without matplotlib."""
    files = []
    for vehicle in found:
        for number, item in enumerate(vehicle.broken, 1):
            path = folder / f"breach-{vehicle.vehicle}-{number}.png"
            folder.mkdir(parents=True, exist_ok=True)
            _draw(observer, vehicle, item, path)
            files.append(path)
    return tuple(files)


def _draw(observer: Observer, vehicle: Observed, item: Finding, path: Path) -> None:
    motion = observer.replay.motions[vehicle.vehicle]
    worst = next(moment for moment in vehicle.moments if (moment.x, moment.y) == item.place)
    row = int(abs(motion.time - worst.time).argmin())
    footprint = footprint_of(motion)
    seen = replace(observer.observation(motion, row, footprint), time=worst.time)
    draw_scene(
        path, observer.road_map, Instant(seen, footprint), title=f"{vehicle.vehicle}: {item.said.citation}",
        caption=f"t = {worst.time:.1f} s; {item.said.because}", settings=VIEW,
    )  # fmt: skip
