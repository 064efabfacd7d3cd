"""From a scene and a few choices to a world, a planner in it, and what the log says about both."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any, Literal

from regdb.vocabulary import Vocabulary
from regdb_runtime.database import RegulationDatabase
from regdb_runtime.drive.log import Log
from regdb_runtime.drive.run import DriveSettings, drive
from regdb_runtime.errors import RequestError
from regdb_runtime.planner import Planner, PlannerSettings
from regdb_runtime.planning.cost_settings import DEFAULT, PAPER, CostSettings
from regdb_runtime.scenes.tellers import eye_facts
from regdb_runtime.worlds.built_in.world import BuiltInWorld
from regdb_runtime.worlds.plain_form import to_plain
from regdb_runtime.worlds.scene_spec import SceneSpec
from regdb_runtime.worlds.world import World

WorldName = Literal["built-in", "sumo"]
PROFILES: Mapping[str, CostSettings] = {"paper": PAPER, "default": DEFAULT}
LOOKS_EVERY = 0.5
"""Seconds between the reports of a recorded eye: LLaVA-1.5-7B in 4 bit answers twice a second (paper, Table IV)."""


@dataclass(frozen=True)
class Choices:
    """How to drive: in which world, weighing plans by which profile, and how the loop turns."""

    world: str = "built-in"
    profile: str = "default"
    settings: DriveSettings = field(default_factory=DriveSettings)


def drive_scene(name: str, spec: SceneSpec, database: RegulationDatabase, choices: Choices, told: Any = None) -> Log:
    """One drive through a scene. Raises RequestError for a choice that is not there, WorldError for a scene that does not fit together."""
    cost = PROFILES.get(choices.profile)
    if cost is None:
        raise RequestError(f"there is no profile {choices.profile!r} of the cost; there are: {', '.join(PROFILES)}")
    settings = PlannerSettings(cost=cost)
    with closing(make_world(choices.world, spec, database.vocabulary)) as world:
        planner = Planner(database, world.road_map, world.route, world.footprint, settings)
        return drive(world, planner, _about(name, spec, database, choices, settings), choices.settings, told)


def make_world(name: str, spec: SceneSpec, vocabulary: Vocabulary) -> World:
    """A scene in the world of that name. Raises RequestError for another name, MissingExtra without SUMO."""
    if name == "built-in":
        return BuiltInWorld(spec, vocabulary)
    if name == "sumo":
        from regdb_runtime.worlds.sumo.world import SumoWorld

        return SumoWorld(spec, vocabulary)
    raise RequestError(f"there is no world {name!r}; there are: built-in, sumo")


def _about(name: str, spec: SceneSpec, database: RegulationDatabase, choices: Choices, settings: PlannerSettings) -> dict[str, Any]:
    """What the first record of the log says of a drive: enough to drive it again."""
    return {
        "variant": name, "provenance": spec.eye.kind, "world": choices.world, "profile": choices.profile, "seed": spec.seed, "start": spec.start,
        "place": spec.streets.jurisdiction, "database": database.hash, "interpretation": settings.interpretation,
        "strategic_period": settings.strategic_period, "weights": asdict(settings.cost.weights), "scene": to_plain(spec),
    }  # fmt: skip


def choices_of(log: Log) -> tuple[SceneSpec, Choices]:
    """The scene of a log and the choices it was driven with, to drive it again."""
    run = log.run
    spec = SceneSpec.from_json(json.dumps(run["scene"]))
    return spec, Choices(run["world"], run["profile"], DriveSettings(**run["settings"]))


def with_eye(spec: SceneSpec, kind: Literal["scripted", "recorded", "none"], record: str = "") -> SceneSpec:
    """The same scene seen by another eye."""
    return replace(spec, eye=replace(spec.eye, kind=kind, record=record if kind == "recorded" else ""))


def eye_record(log: Log, vocabulary: Vocabulary) -> Iterator[str]:
    """What the eye of a drive reported, as lines that a recorded eye reads; facts as people write them.

    Of a fact that the eye looks for and says nothing about, the record says what the vocabulary assumes then.
    """
    own, next_look = eye_facts(vocabulary), 0.0
    assumed = {name: fact.assumption.value for name in sorted(own) if (fact := vocabulary.fact(name)).assumption is not None}
    for tick, seen, silent in eye_of(log):
        if tick["time"] >= next_look - 1e-6:
            told = {name: value for name, value in assumed.items() if name not in silent} | {
                name: frozenset(value) if isinstance(value, list) else value for name, value in seen.items()
            }
            facts = {name: vocabulary.fact(name).show(value) for name, value in sorted(told.items())}
            yield json.dumps({"time": tick["time"], "facts": facts}, ensure_ascii=False, separators=(",", ":"))
            next_look = tick["time"] + LOOKS_EVERY


def eye_of(log: Log) -> Iterator[tuple[Mapping[str, Any], Mapping[str, Any], Sequence[str]]]:
    """Every tick with what the eye reports and does not; the log writes both only where they change."""
    facts: Mapping[str, Any] = {}
    silent: Sequence[str] = ()
    for tick in log.ticks:
        facts = facts if tick["facts"] is None else tick["facts"]
        silent = silent if tick["silent"] is None else tick["silent"]
        yield tick, facts, silent


def first_difference(one: Log, other: Log) -> str:
    """Where two drives part, in words; empty when they are the same, whatever the law's hash."""
    for index, (a, b) in enumerate(zip(one.ticks, other.ticks, strict=False)):
        if a != b:
            keys = [key for key in a if a.get(key) != b.get(key)]
            return f"tick {index} at {a['time']:.1f} s differs in {', '.join(keys)}"
    if len(one.ticks) != len(other.ticks):
        return f"{len(one.ticks)} ticks and {len(other.ticks)}"
    changed = [key for key in one.run if key != "database" and one.run[key] != other.run.get(key)]
    if changed:
        return f"the run differs in {', '.join(changed)}"
    return "" if one.end == other.end else "they end differently"


def write_text(path: Path, text: str) -> None:
    """A small file, its folder made when it is not there."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, "utf-8")
