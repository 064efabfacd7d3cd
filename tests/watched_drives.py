"""Drives watched from outside: what the world itself says after every step, measured with geometry of the test's own."""

from __future__ import annotations

import datetime
import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import pytest
from regdb_runtime import drive as drive_package
from regdb_runtime.database import RegulationDatabase
from regdb_runtime.drive.log import Log
from regdb_runtime.drive.paper_scene import scene_spec
from regdb_runtime.drive.run import DriveSettings, drive
from regdb_runtime.drive.variants import variant
from regdb_runtime.observation import EgoState, Footprint, Observation, Track
from regdb_runtime.planner import Planner
from regdb_runtime.worlds.built_in.world import BuiltInWorld
from regdb_runtime.worlds.scene_spec import SceneSpec

from regdb.front import ADDED_CODES, database

Point = tuple[float, float]


@dataclass(frozen=True)
class Instant:
    """What was so at one instant, whoever saw it."""

    time: float
    ego: EgoState
    tracks: tuple[Track, ...]
    lights: dict[str, str]


class Watched(BuiltInWorld):
    """The built-in world, with a witness who notes every observation's instant: all road users and lights, seen or not."""

    def __init__(self, spec: SceneSpec, law: RegulationDatabase) -> None:
        super().__init__(spec, law.vocabulary)
        self.instants: list[Instant] = []

    def observe(self) -> Observation:
        lights = {name: self.signals.color(name, self.time) for name in sorted(self.road_map.lights)}
        self.instants.append(Instant(self.time, self.ego, self.tracks(), lights))
        return super().observe()


@dataclass(frozen=True)
class Witnessed:
    """A drive: its log, and what the witness noted."""

    log: Log
    world: Watched
    instants: tuple[Instant, ...]
    footprint: Footprint


@lru_cache(maxsize=1)
def law() -> RegulationDatabase:
    """The shipped codes with New York's red signals."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv(ADDED_CODES, str(Path(drive_package.__file__).parent / "added_codes"))
        return RegulationDatabase.open(database())


@lru_cache(maxsize=4)
def witnessed(name: str) -> Witnessed:
    """A variant, driven once."""
    return witness(name, scene_spec(variant(name).scene, name))


def witness(name: str, spec: SceneSpec) -> Witnessed:
    """A scene, driven."""
    world = Watched(spec, law())
    planner = Planner(law(), world.road_map, world.route, world.footprint)
    about = {"variant": name, "provenance": spec.eye.kind, "world": "built-in"}
    log = drive(world, planner, about, DriveSettings())
    return Witnessed(log, world, tuple(world.instants), world.footprint)


def corners(x: float, y: float, heading: float, length: float, width: float) -> list[Point]:
    """A rectangle's corners in order."""
    cos, sin = math.cos(heading), math.sin(heading)
    sides = ((1, 1), (-1, 1), (-1, -1), (1, -1))
    return [(x + a * length / 2 * cos - b * width / 2 * sin, y + a * length / 2 * sin + b * width / 2 * cos) for a, b in sides]


def edges(polygon: list[Point]) -> Iterator[tuple[Point, Point]]:
    return itertools.pairwise([*polygon, polygon[0]])


def to_segment(point: Point, start: Point, end: Point) -> float:
    """Distance of a point to a segment."""
    dx, dy = end[0] - start[0], end[1] - start[1]
    part = max(0.0, min(1.0, ((point[0] - start[0]) * dx + (point[1] - start[1]) * dy) / (dx * dx + dy * dy)))
    return math.hypot(point[0] - start[0] - part * dx, point[1] - start[1] - part * dy)


def inside(point: Point, polygon: list[Point]) -> bool:
    """Whether a point lies in a polygon, by the angles it is seen under."""
    turned = 0.0
    for a, b in edges(polygon):
        first, second = math.atan2(a[1] - point[1], a[0] - point[0]), math.atan2(b[1] - point[1], b[0] - point[0])
        turned += math.remainder(second - first, 2 * math.pi)
    return abs(turned) > math.pi


def gap(ego: EgoState, footprint: Footprint, track: Track) -> float:
    """Distance edge to edge between the vehicle and a road user; 0 when they overlap."""
    middle = footprint.length / 2 - footprint.rear_overhang
    own = corners(ego.x + middle * math.cos(ego.heading), ego.y + middle * math.sin(ego.heading), ego.heading, footprint.length, footprint.width)
    other = corners(track.x, track.y, track.heading, track.length, track.width)
    if inside(own[0], other) or inside(other[0], own):
        return 0.0
    return min(to_segment(p, *edge) for a, b in ((own, other), (other, own)) for p in a for edge in edges(b))


def bumper(ego: EgoState, footprint: Footprint) -> Point:
    """The middle of the front bumper."""
    reach = footprint.length - footprint.rear_overhang
    return ego.x + reach * math.cos(ego.heading), ego.y + reach * math.sin(ego.heading)


def clock_of(item: Witnessed) -> datetime.datetime:
    return datetime.datetime.fromisoformat(item.world.spec.start)
