"""`regdb drive frames` and `regdb drive degradation`: what the front camera sees, and how a drive fares when the model behind it errs."""

from __future__ import annotations

import json
from contextlib import closing
from pathlib import Path

import typer

from regdb.front import FrontError, database
from regdb_runtime.commands.drive_options import Options
from regdb_runtime.database import RegulationDatabase
from regdb_runtime.drive.degradation import RATES, SCENES, Outcome, degradation, drive_by_frames, write_degradation
from regdb_runtime.drive.frame_camera import FrameCamera, Shot
from regdb_runtime.drive.log import Log
from regdb_runtime.drive.paper_scene import scene_spec
from regdb_runtime.drive.variants import variant
from regdb_runtime.perception.stub_model import ErrorRates
from regdb_runtime.planner import Planner
from regdb_runtime.worlds.built_in.world import BuiltInWorld
from regdb_runtime.worlds.eye import build_eye
from regdb_runtime.worlds.scene_spec import SceneSpec

EVERY = 4.0
"""Seconds of the drive between two frames written."""
LONGEST = 240.0
"""Seconds after which a drive that writes frames ends."""


def frames_run(file: Path | None, options: Options) -> int:
    """Write what the front camera sees along a variant, with the truth about every thing in each frame."""
    if file is not None:
        raise FrontError("`regdb drive frames` takes no file; a variant is named by --variant")
    item = variant(options.variants[0])
    law = _open(options)
    folder = options.folder / f"{item.name}-frames"
    folder.mkdir(parents=True, exist_ok=True)
    count = _write_frames(scene_spec(item.scene, item.name), law, folder)
    typer.echo(f"written: {count} frames (1920 x 1080) and truth.json in {folder}")
    return 0


def degradation_run(file: Path | None, options: Options) -> int:
    """Drive the paper's scenes by what an erring model says of frames, at rising error rates; exit 1 when any drive broke the law."""
    if file is not None:
        raise FrontError("`regdb drive degradation` takes no file")
    rates = RATES if options.error_rate is None else (0.0, options.error_rate)
    seeds = (0, 1, 2) if options.seed is None else (options.seed,)
    outcomes = degradation(_open(options), rates, seeds, told=_tell)
    table, picture = write_degradation(outcomes, options.folder)
    if options.form == "json":
        typer.echo(table.read_text("utf-8"), nl=False)
    else:
        for line in _table(outcomes):
            typer.echo(line)
        typer.echo(f"written: {table}, {picture}")
    return 1 if any(outcome.breaches for outcome in outcomes) else 0


def by_frames(name: str, spec: SceneSpec, law: RegulationDatabase, options: Options) -> Log:
    """One drive of `regdb drive paper --eye frames`."""
    return drive_by_frames(name, spec, law, ErrorRates.even(options.error_rate or 0.0), options.seed or 0)[0]


def _open(options: Options) -> RegulationDatabase:
    return RegulationDatabase.open(options.db or database())


def _write_frames(spec: SceneSpec, law: RegulationDatabase, folder: Path) -> int:
    """Frames of a scripted drive, one every few seconds, named by their time."""
    truths = []
    with closing(BuiltInWorld(spec, law.vocabulary)) as world:
        camera = FrameCamera(world, law.vocabulary, build_eye(spec.eye, law.vocabulary))
        planner = Planner(law, world.road_map, world.route, world.footprint)
        goal, due = world.road_map.lanes[world.route[-1]].center[-1], 0.0
        while world.time < LONGEST:
            if world.time >= due - 1e-9:
                shot = camera.take()
                path = folder / f"{round(world.time):04d}s.jpg"
                path.write_bytes(shot.frame.image)
                truths.append({"frame": path.name, "time": world.time, "things": _things(shot)})
                due += EVERY
            if (goal[0] - world.ego.x) ** 2 + (goal[1] - world.ego.y) ** 2 < 40.0**2:
                break
            decision = planner.step(world.observe())
            world.step(decision.trajectory, decision.turn_signal, 0.1)
    (folder / "truth.json").write_text(json.dumps(truths, indent=1) + "\n", "utf-8")
    return len(truths)


def _things(shot: Shot) -> list[dict[str, object]]:
    return [
        {
            "kind": truth.kind, "id": truth.id, "fact": truth.fact, "value": truth.value, "box": [round(side, 1) for side in truth.box],
            "distance": round(truth.distance, 2), "hidden": round(truth.hidden, 2),
        }
        for truth in shot.rendering.truths
    ]  # fmt: skip


def _tell(outcome: Outcome) -> None:
    typer.echo(f"{outcome.scene} at {100 * outcome.rate:.0f} %, seed {outcome.seed}: {outcome.ended} at {outcome.time:.0f} s", err=True)


def _table(outcomes: tuple[Outcome, ...]) -> list[str]:
    """80 columns: each scene and rate, means over the seeds."""
    lines = [f"{'scene':<14}{'errors':>8}{'drives':>8}{'time, s':>9}{'unknown':>9}{'breaches':>10}"]
    for scene in SCENES:
        for rate in dict.fromkeys(item.rate for item in outcomes if item.scene == scene):
            own = [item for item in outcomes if (item.scene, item.rate) == (scene, rate)]
            time, unknown = (sum(values) / len(own) for values in ([item.time for item in own], [100 * item.unknown for item in own]))
            broken = sum(bool(item.breaches) for item in own)
            lines.append(f"{scene:<14}{100 * rate:>6.0f} %{len(own):>8}{time:>9.1f}{unknown:>7.1f} %{broken:>10}")
    lines.append("unknown: share of strategic ticks at which nothing was known to be lawful")
    return lines
