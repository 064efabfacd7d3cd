"""A drive of the planner among recorded traffic: the same loop, log, figures and table as the paper's drive."""

from __future__ import annotations

import math
from collections.abc import Sequence
from contextlib import closing
from dataclasses import asdict
from pathlib import Path
from typing import Any

from regdb.vocabulary import Vocabulary
from regdb_runtime.database import RegulationDatabase
from regdb_runtime.drive.downtrack import Downtrack
from regdb_runtime.drive.figures import Scenes, draw_all
from regdb_runtime.drive.log import Log, writing
from regdb_runtime.drive.picture import Instant, draw_scene
from regdb_runtime.drive.prepare import PROFILES, Choices
from regdb_runtime.drive.run import DriveSettings, drive
from regdb_runtime.drive.scene_pictures import VIEW, draw_events, instants, observation_of
from regdb_runtime.emergency import EmergencyBrake
from regdb_runtime.errors import RequestError
from regdb_runtime.maps.commonroad import read_commonroad
from regdb_runtime.maps.commonroad_traffic import read_traffic
from regdb_runtime.maps.lane_path import path_along
from regdb_runtime.maps.road_map import RoadMap
from regdb_runtime.maps.route import route_through
from regdb_runtime.observation import Footprint
from regdb_runtime.planner import Planner, PlannerSettings
from regdb_runtime.worlds.plain_form import to_plain
from regdb_runtime.worlds.recorded import RecordedWorld, ego_at
from regdb_runtime.worlds.recorded_spec import RecordedSpec
from regdb_runtime.worlds.replay import Replay

GENTLE, DECIDES = 2.0, 8.0
"""m/s2 at which a drive that begins before a stop line could brake for it, and metres left for deciding so."""
SLOWER = 0.5
"""m/s by which it begins slower than that, as often as somebody recorded is too near ahead."""
UNPOSTED = 11.2
"""m/s (25 mph) at which it begins where no limit is posted."""
LOOP = DriveSettings(arrived_within=8.0)
"""Recorded maps end soon after the junction, so the destination is the route's end itself."""


def drive_recorded(spec: RecordedSpec, database: RegulationDatabase, choices: Choices | None = None, told: Any = None) -> Log:
    """One drive. Raises RequestError, MapError, NoRoute and WorldError for what does not fit together."""
    choices = choices or Choices("recorded", "default", LOOP)
    cost = PROFILES.get(choices.profile)
    if cost is None:
        raise RequestError(f"there is no profile {choices.profile!r} of the cost; there are: {', '.join(PROFILES)}")
    database.at(spec.place, spec.start[:10])  # a place or day that is not there is said before the drive
    settings = PlannerSettings(cost=cost)
    with closing(RecordedWorld(spec, database.vocabulary)) as world:
        planner = Planner(database, world.road_map, world.route, world.footprint, settings)
        about = {
            "variant": spec.name, "provenance": spec.eye.kind, "lights": lights_said(spec), "world": "recorded", "profile": choices.profile,
            "seed": 0, "start": spec.start, "place": world.road_map.jurisdiction, "database": database.hash,
            "interpretation": settings.interpretation, "strategic_period": settings.strategic_period,
            "weights": asdict(settings.cost.weights), "scene": to_plain(spec),
            "recording": {"id": world.replay.traffic.id, "seconds": world.replay.ends, "note": "nobody recorded reacts to the ego; who leaves the "
                          "recording leaves the scene"},
        }  # fmt: skip
        return drive(world, planner, about, choices.settings, told)


def recorded_spec(name: str, file: Path, lanes: Sequence[str], station: float = 5.0, **choices: Any) -> RecordedSpec:
    """A drive along lanes of a recorded street, those between them found. It begins at the limit posted there, or slower where a line is near:
    so that braking at GENTLE still reaches it. Raises MapError and NoRoute."""
    road_map = read_commonroad(file)
    route = route_through(road_map, tuple(lanes)).lanes
    downtrack = Downtrack(road_map, route)
    lines = [station_of for name in route[:-1] if (station_of := downtrack.stop_line(name)) is not None and station_of > station]
    speeds = [road_map.lanes[route[0]].speed_limit or UNPOSTED]
    footprint = choices.get("footprint", Footprint())
    if lines:
        room = max(lines[0] - station - footprint.front - DECIDES, 0.0)
        speeds.append(math.sqrt(2 * GENTLE * room))
    speed = _without_emergency(file, road_map, route, station, min(speeds), footprint, choices.get("begins", 0.0))
    return RecordedSpec(name, str(file), route, station, round(speed, 2), **choices)


def _without_emergency(
    file: Path, road_map: RoadMap, route: tuple[str, ...], station: float, speed: float, footprint: Footprint, begins: float
) -> float:
    """The speed, or as much less as it takes not to begin in an emergency behind somebody recorded."""
    tracks, path = Replay(read_traffic(file)).tracks(begins), path_along(road_map, route).path
    while speed > SLOWER and EmergencyBrake(footprint).check(ego_at(path, station, speed), tracks, 0.0).active:
        speed -= SLOWER
    return speed


def lights_said(spec: RecordedSpec) -> str:
    """Where the lights' phases come from: never from the recording."""
    words = {"none": "none", "nominal": "scripted: the file's nominal plan", "red": "scripted: red first", "green": "scripted: green first"}
    return words[spec.lights.plan]


def write_recorded(log: Log, spec: RecordedSpec, folder: Path) -> tuple[Path, ...]:
    """`drive.jsonl` and `recorded.json`. Raises LogError when the folder cannot be written."""
    files = folder / "drive.jsonl", folder / "recorded.json"
    with writing(files[0]) as out:
        for record in (log.run, *log.ticks, log.end):
            out.write(record)
    files[1].write_text(spec.to_json(), "utf-8")
    return files


def draw_recorded(log: Log, spec: RecordedSpec, vocabulary: Vocabulary, folder: Path) -> tuple[Path, ...]:
    """The figures, a picture of the scene at each event, and one among the recorded traffic, as PNG. Raises MissingExtra without matplotlib."""
    with closing(RecordedWorld(spec, vocabulary)) as world:
        road_map, drawn = world.road_map, instants(log)
    files = (*draw_all(log, folder, Scenes(road_map, drawn)), *draw_events(drawn, road_map, folder))
    return (*files, _draw_traffic(log, spec, road_map, folder / "scene-traffic.png"))


def _draw_traffic(log: Log, spec: RecordedSpec, road_map: RoadMap, path: Path) -> Path:
    """The scene half way through what is left of the recording when the run begins."""
    middle = max(log.run["recording"]["seconds"] - spec.begins, 0.0) / 2
    tick = min(log.ticks, key=lambda item: abs(item["time"] - middle))
    path.parent.mkdir(parents=True, exist_ok=True)
    draw_scene(path, road_map, Instant(observation_of(tick), Footprint(**log.run["footprint"])), title="Among recorded traffic", settings=VIEW)
    return path
