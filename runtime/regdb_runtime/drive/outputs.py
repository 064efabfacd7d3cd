"""What a drive leaves in its folder: its log, the scene it can be driven from again, the figures, a picture of the scene at each event."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path

from regdb.vocabulary import Vocabulary
from regdb_runtime.database import RegulationDatabase
from regdb_runtime.drive.figures import Scenes, draw_all
from regdb_runtime.drive.log import Log, writing
from regdb_runtime.drive.paper_scene import scene_spec
from regdb_runtime.drive.prepare import Choices, drive_scene
from regdb_runtime.drive.scene_pictures import draw_events, instants
from regdb_runtime.drive.summary import Row, row_of
from regdb_runtime.drive.variants import variant
from regdb_runtime.errors import MissingExtra
from regdb_runtime.worlds.road_builder import build_road_map
from regdb_runtime.worlds.scene_spec import SceneSpec


def write_drive(log: Log, spec: SceneSpec, folder: Path) -> tuple[Path, ...]:
    """`drive.jsonl` and `scene.json`. Raises LogError when the folder cannot be written."""
    files = folder / "drive.jsonl", folder / "scene.json"
    with writing(files[0]) as out:
        for record in (log.run, *log.ticks, log.end):
            out.write(record)
    files[1].write_text(spec.to_json(), "utf-8")
    return files


def drive_variant(name: str, database: RegulationDatabase, folder: Path) -> tuple[Row, tuple[Path, ...]]:
    """A variant driven in the built-in world, written and, where matplotlib is installed, drawn: its row of the table and the files."""
    item = variant(name)
    spec = scene_spec(item.scene, name)
    log = drive_scene(name, spec, database, Choices())
    files = write_drive(log, spec, folder)
    with suppress(MissingExtra):
        files += draw_drive(log, spec, database.vocabulary, folder)
    return row_of(log, item), files


def draw_drive(log: Log, spec: SceneSpec, vocabulary: Vocabulary, folder: Path) -> tuple[Path, ...]:
    """The figures, and a picture of the scene at each event, as PNG. Raises MissingExtra without matplotlib."""
    road_map, drawn = build_road_map(spec.streets, vocabulary), instants(log)
    return (*draw_all(log, folder, Scenes(road_map, drawn)), *draw_events(drawn, road_map, folder))
