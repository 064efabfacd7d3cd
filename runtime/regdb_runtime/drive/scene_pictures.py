"""A picture of the scene at each event of a drive, drawn from its log and the map of its scene."""

from __future__ import annotations

import datetime
import math
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from regdb_runtime.drive.events import events_of
from regdb_runtime.drive.log import Log
from regdb_runtime.drive.picture import Instant, PictureSettings, draw_scene
from regdb_runtime.maps.road_map import Floats, RoadMap
from regdb_runtime.observation import EgoState, Footprint, Indication, Observation, Track
from regdb_runtime.trajectory import Trajectory

Record = Mapping[str, Any]
WORDS = {
    "overtaking_begins": "Overtaking begins", "alongside": "Alongside", "back_in_lane": "Back in lane", "overtaking_given_up": "Overtaking given up",
    "stopped": "Full stop", "released": "Leaves the stop", "zone_detected": "Zone detected, braking begins", "reduced_speed": "Reduced speed reached",
}  # fmt: skip
STANDS = 0.05
"""Metres from point to point of a plan below which it stands there and has no course."""
VIEW = PictureSettings(along=70.0, across=44.0, pixels=1100)
WIDE = PictureSettings(along=110.0, across=40.0, pixels=1100, ahead=40.0)
"""For what is far ahead as it begins: whom one overtakes, the zone one brakes for."""
FAR = frozenset(("overtaking_begins", "zone_detected"))


def instants(log: Log) -> dict[str, Instant]:
    """Event -> what is drawn at it, the first of each name; `alongside` is the instant of least clearance while overtaking."""
    footprint = Footprint(**log.run["footprint"])
    times: dict[str, float] = {}
    for event in events_of(log.run, log.ticks):
        times.setdefault(event.name, event.time)
    nearest = min(_passing(log), default=None)
    if nearest is not None and "back_in_lane" in times:
        times["alongside"] = nearest[1]
    by_time = {tick["time"]: tick for tick in log.ticks}
    return {
        name: Instant(observation_of(by_time[time]), footprint, _plan_at(log, time)) for name, time in sorted(times.items(), key=lambda item: item[1])
    }  # fmt: skip


def _passing(log: Log) -> Iterator[tuple[float, float]]:
    """Clearance and time, for each bicycle at each tick of an overtaking."""
    for tick in log.ticks:
        if tick["state"].startswith("overtaking."):
            yield from ((track["clearance"], tick["time"]) for track in tick["tracks"] if track["kind"] == "bicycle")


def draw_events(drawn: Mapping[str, Instant], road_map: RoadMap, folder: Path) -> tuple[Path, ...]:
    """`scene-<event>.png` for every event. Raises MissingExtra without matplotlib."""
    files = []
    folder.mkdir(parents=True, exist_ok=True)
    for name, instant in drawn.items():
        files.append(folder / f"scene-{name.replace('_', '-')}.png")
        draw_scene(files[-1], road_map, instant, title=WORDS[name], settings=WIDE if name in FAR else VIEW)
    return tuple(files)


def observation_of(tick: Record) -> Observation:
    """What was observed, as far as a picture needs it."""
    ego = {name: tick["ego"][name] for name in ("x", "y", "heading", "speed", "acceleration", "curvature", "turn_signal")}
    tracks = tuple(Track(**{name: value for name, value in track.items() if name != "clearance"}) for track in tick["tracks"])
    signals = {name: tuple(Indication(*lens) for lens in shown) for name, shown in tick["signals"].items()}
    clock = datetime.datetime.fromisoformat(tick["clock"])
    return Observation(tick["time"], clock, EgoState(**ego), tracks, signals)


def _courses(x: Floats, y: Floats) -> Floats:
    """The course at each point of a plan; where it stands that of its nearest motion before, else after; none for a plan that stands all along."""
    dx, dy = np.gradient(x), np.gradient(y)
    moving = np.flatnonzero(np.hypot(dx, dy) > STANDS)
    if not len(moving):
        return np.full_like(x, math.nan)
    nearest = moving[np.clip(np.searchsorted(moving, np.arange(len(x)), side="right") - 1, 0, None)]
    return np.asarray(np.arctan2(dy[nearest], dx[nearest]))


def _plan_at(log: Log, time: float) -> Trajectory | None:
    """The plan last decided on by strategy, as far as the log keeps it: its points in the plane."""
    plans = [tick["plan"] for tick in log.ticks if tick["plan"] is not None and time - 0.6 < tick["time"] <= time + 1e-6]
    if not plans:
        return None
    plan = plans[-1]
    held = {name: np.array(plan[name], dtype=float) for name in ("time", "x", "y", "speed", "station", "offset")}
    nothing = np.zeros_like(held["time"])
    heading = _courses(held["x"], held["y"]) if len(held["x"]) > 1 else nothing + math.nan
    return Trajectory(
        held["time"], held["x"], held["y"], heading, held["speed"], nothing, nothing, nothing, held["station"], held["offset"]
    )  # fmt: skip
