"""How a drive degrades as perception errs more: the paper's scenes seen through frames by a model that errs at stated rates.

Breaches are measured against what was there, not against what was believed: a line crossed on red where a sign forbids the turn, a school
passed above the limit that its sign and its children set.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from contextlib import closing
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

from regdb.units import to_si
from regdb_runtime.database import RegulationDatabase
from regdb_runtime.drive.frame_camera import FrameCamera, Shot
from regdb_runtime.drive.log import Log
from regdb_runtime.drive.measures import Measures, measure
from regdb_runtime.drive.paper_scene import PaperScene, scene_spec
from regdb_runtime.drive.run import DriveSettings, drive
from regdb_runtime.drive.seeing import SeeingPlanner, seeing
from regdb_runtime.errors import MissingExtra
from regdb_runtime.perception.matcher import Matcher
from regdb_runtime.perception.render.camera import CameraSettings
from regdb_runtime.perception.stub_model import ErrorRates, StubModel
from regdb_runtime.planner import Planner
from regdb_runtime.worlds.built_in.world import BuiltInWorld
from regdb_runtime.worlds.eye import build_eye
from regdb_runtime.worlds.plain_form import to_plain
from regdb_runtime.worlds.scene_spec import SceneSpec

RATES = (0.0, 0.02, 0.05, 0.1, 0.2, 0.4)
"""Error rates of the plot: misses, inventions and confusions each at this rate."""
FRAMES = CameraSettings(960, 540)
"""Half of 1080p in each direction: what a small model is given anyway."""
ZONE_LIMIT = float(to_si(25, "mph"))
PATIENCE = DriveSettings(standstill_limit=150.0)
"""A vehicle that has seen a sign, or thinks so, stands for a whole cycle of the light."""
ROUNDING = 0.05
"""m/s by which a measured speed may lie over a limit that was kept."""
SCENES: Mapping[str, PaperScene] = {
    "red": PaperScene(part="red"), "no-turn-sign": PaperScene(part="red", no_turn_sign=True), "school": PaperScene(part="school", cyclist=False),
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class Outcome:
    """One drive. `breaches`: what the law of what was there forbade and the vehicle did; `unknown`: share of strategic ticks at which nothing
    was known to be lawful; `asked`, `failed`: questions put and those without an answer."""

    scene: str
    rate: float
    seed: int
    ended: str
    reason: str
    time: float
    unknown: float
    breaches: tuple[str, ...]
    asked: int
    failed: int


def drive_by_frames(
    name: str, spec: SceneSpec, database: RegulationDatabase, errors: ErrorRates, seed: int = 0, settings: DriveSettings | None = None,
    camera: CameraSettings = FRAMES, told: Callable[[float], None] | None = None,
) -> tuple[Log, int, int]:  # fmt: skip
    """A drive through a scene by what a stub model says of rendered frames; the log, the questions put and those that failed.

    Raises WorldError for a scene that does not fit together, MissingExtra without Pillow.
    """
    vocabulary = database.vocabulary
    with closing(BuiltInWorld(spec, vocabulary)) as world:
        shots = _Shots(FrameCamera(world, vocabulary, build_eye(replace(spec.eye, kind="scripted"), vocabulary), camera))
        model = StubModel(vocabulary, lambda frame: shots.facts(frame.id), errors, seed)
        eye = seeing(world, database, model, shots, Matcher(vocabulary))
        world.eye = eye
        planner = Planner(database, world.road_map, world.route, world.footprint)
        log = drive(world, SeeingPlanner(planner, eye), _about(name, spec, database, errors, seed, planner), settings or PATIENCE, told)
    return log, len(eye.answers), sum(bool(description.failure) for _, _, description in eye.answers)


def degradation(
    database: RegulationDatabase, rates: Sequence[float] = RATES, seeds: Sequence[int] = (0, 1, 2), scenes: Sequence[str] = tuple(SCENES),
    told: Callable[[Outcome], None] | None = None,
) -> tuple[Outcome, ...]:  # fmt: skip
    """Every scene at every rate with every seed."""
    found = []
    for scene in scenes:
        for rate in rates:
            for seed in seeds if rate else seeds[:1]:
                outcome = _outcome(scene, rate, seed, database)
                found.append(outcome)
                if told is not None:
                    told(outcome)
    return tuple(found)


def breaches(scene: PaperScene, found: Measures) -> tuple[str, ...]:
    """What was done against the law of what was there, in words."""
    said = []
    if scene.no_turn_sign and found.crosses == "red":
        said.append("turned on red against the sign")
    if scene.part in {"school", "whole"} and scene.children and found.zone_speed is not None and found.zone_speed > ZONE_LIMIT + ROUNDING:
        said.append(f"passed the school at {found.zone_speed:.2f} m/s")
    if found.ended == "collision":
        said.append(found.reason)
    return tuple(said)


def write_degradation(outcomes: Sequence[Outcome], folder: Path) -> tuple[Path, ...]:
    """The table as JSON, and the plot. Raises MissingExtra without matplotlib."""
    folder.mkdir(parents=True, exist_ok=True)
    table, picture = folder / "degradation.json", folder / "degradation.png"
    table.write_text(json.dumps([asdict(item) for item in outcomes], indent=1) + "\n", "utf-8")
    _plot(outcomes, picture)
    return table, picture


class _Shots:
    """A camera that remembers what its latest frames showed, for the model to err about."""

    def __init__(self, camera: FrameCamera) -> None:
        self._camera = camera
        self._shots: dict[str, Shot] = {}

    def take(self) -> Shot:
        shot = self._camera.take()
        self._shots = {**dict(list(self._shots.items())[-3:]), shot.frame.id: shot}
        return shot

    def facts(self, frame: str) -> Mapping[str, Any]:
        return self._shots[frame].facts


def _outcome(scene: str, rate: float, seed: int, database: RegulationDatabase) -> Outcome:
    spec = scene_spec(SCENES[scene], scene)
    log, asked, failed = drive_by_frames(scene, spec, database, ErrorRates.even(rate), seed)
    measured = measure(log)
    chosen = [tick["flag"] for tick in log.ticks if tick["strategic"]]
    unknown = sum(flag == "unknown" for flag in chosen) / max(1, len(chosen))
    return Outcome(scene, rate, seed, measured.ended, measured.reason, measured.time, unknown, breaches(SCENES[scene], measured), asked, failed)


def _about(name: str, spec: SceneSpec, database: RegulationDatabase, errors: ErrorRates, seed: int, planner: Planner) -> dict[str, Any]:
    settings = planner.settings
    return {
        "variant": name, "provenance": "scripted", "perception": {"eye": "frames", "model": "stub", "errors": asdict(errors), "seed": seed},
        "world": "built-in", "profile": "default", "seed": spec.seed, "start": spec.start, "place": spec.streets.jurisdiction,
        "database": database.hash, "interpretation": settings.interpretation, "strategic_period": settings.strategic_period,
        "weights": asdict(settings.cost.weights), "scene": to_plain(spec),
    }  # fmt: skip


def _plot(outcomes: Sequence[Outcome], path: Path) -> None:
    """Time and what was unknown against the error rate, with every breach marked."""
    try:
        import matplotlib as library
        from matplotlib.figure import Figure
    except ModuleNotFoundError as error:
        raise MissingExtra("matplotlib", "plots", "the plot") from error
    style: Any = {"font.size": 10, "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True, "grid.color": "#e3e3e3"}
    with library.rc_context(style):
        figure = Figure(figsize=(9.0, 6.4), layout="constrained")
        upper, lower = figure.subplots(2, 1, sharex=True)
        for scene, colour in zip(dict.fromkeys(item.scene for item in outcomes), ("#1f5fa8", "#c23b2e", "#2c7d4f"), strict=False):
            own = [item for item in outcomes if item.scene == scene]
            _curve(upper, own, colour, lambda item: item.time)
            _curve(lower, own, colour, lambda item: 100 * item.unknown)
            broken = [item for item in own if item.breaches]
            upper.plot([100 * item.rate for item in broken], [item.time for item in broken], "x", color="black", ms=10, mew=2)
        count = sum(bool(item.breaches) for item in outcomes)
        title = f"Errors of perception: {count} breaches in {len(outcomes)} drives (perception: scripted, through frames)"
        upper.set_title(title, loc="left", fontsize=11)
        upper.set_ylabel("time to the end, s")
        upper.set_ylim(bottom=0)
        upper.legend(frameon=False, ncols=3)
        lower.set_ylabel("ticks with nothing\nknown to be lawful, %")
        lower.set_xlabel("error rate of the model, % (misses, inventions and confusions each)")
        lower.set_ylim(bottom=0)
        figure.savefig(path, dpi=130, metadata={"Software": None})


def _curve(axes: Any, own: Sequence[Outcome], colour: str, value: Callable[[Outcome], float]) -> None:
    """Mean over the seeds at each rate, with the range between the least and the most."""
    rates = sorted({item.rate for item in own})
    groups = [[value(item) for item in own if item.rate == rate] for rate in rates]
    shares = [100 * rate for rate in rates]
    axes.plot(shares, [sum(group) / len(group) for group in groups], "o-", color=colour, label=own[0].scene, lw=1.8, ms=4)
    axes.fill_between(shares, [min(group) for group in groups], [max(group) for group in groups], color=colour, alpha=0.12, lw=0)
