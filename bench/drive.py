"""Time ticks of the planner and whole drives: the paper's drive in the built-in world, and ticks among traffic; writes out/bench/drive.json.

Processor time of this process, one core. The database's decisions are compiled as they are first asked for (milliseconds each, once), so
ticks are timed on a second drive with the same database; the first one's worst tick is told beside them. `--strict` exits 1 when a mark is missed.
"""

# ruff: noqa: T201, E402  # a script whose result is what it prints; the number of threads is set before numpy is read
from __future__ import annotations

import argparse
import json
import os
import sys
import time
from dataclasses import dataclass, field
from pathlib import Path

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(name, "1")  # before numpy: one core, as the marks are

from regdb_runtime.database import RegulationDatabase
from regdb_runtime.drive.downtrack import Downtrack
from regdb_runtime.drive.paper_scene import scene_spec
from regdb_runtime.drive.variants import variant
from regdb_runtime.planner import Planner
from regdb_runtime.worlds.built_in.world import BuiltInWorld
from regdb_runtime.worlds.random_scenes import random_scene
from regdb_runtime.worlds.scene_spec import SceneSpec

from regdb.front import database

OUT = Path("out/bench/drive.json")
STRATEGIC_MS, MOTION_MS, TIMES_REAL = 10.0, 6.0, 30.0
AMONG_TRAFFIC = (0, 1, 2, 3, 4, 6, 7, 8)
"""Seeds of random scenes whose ticks are timed too."""
PERIOD = 0.1


@dataclass
class Timed:
    """Processor seconds of the ticks of one or more drives, and of the worlds between them."""

    strategic: list[float] = field(default_factory=list)
    motion: list[float] = field(default_factory=list)
    plans: list[int] = field(default_factory=list)
    world: float = 0.0
    driven: float = 0.0

    @property
    def total(self) -> float:
        return sum(self.strategic) + sum(self.motion) + self.world


def drive(spec: SceneSpec, law: RegulationDatabase, seconds: float, into: Timed) -> None:
    """Drive a scene to the end of its route or for so many seconds."""
    world = BuiltInWorld(spec, law.vocabulary)
    planner = Planner(law, world.road_map, world.route, world.footprint)
    way, near = Downtrack(world.road_map, world.route), None
    while world.time < seconds:
        begun = time.process_time()
        observation = world.observe()
        seen = time.process_time()
        decision = planner.step(observation)
        decided = time.process_time()
        (into.strategic if decision.strategic else into.motion).append(decided - seen)
        into.plans.append(sum(item.sampled for item in decision.candidates))
        near, _ = way.locate(*observation.ego.front_bumper(world.footprint), near)
        if near > way.length - 40.0:
            break
        before = time.process_time()
        world.step(decision.trajectory, decision.turn_signal, PERIOD)
        into.world += time.process_time() - before + seen - begun
    into.driven += world.time


def share(times: list[float], part: float) -> float:
    """Milliseconds below which that part of the times lies."""
    return sorted(times)[min(len(times) - 1, int(part * len(times)))] * 1000.0 if times else 0.0


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="fewer scenes among traffic")
    parser.add_argument("--strict", action="store_true", help="exit 1 when a mark is missed")
    chosen = parser.parse_args()
    law = RegulationDatabase.open(database())
    item = variant("paper")
    spec = scene_spec(item.scene, item.name)
    cold, paper, traffic = Timed(), Timed(), Timed()
    drive(spec, law, 200.0, cold)
    drive(spec, law, 200.0, paper)
    for seed in AMONG_TRAFFIC[: 3 if chosen.quick else None]:
        drive(random_scene(seed), law, 20.0, Timed())
        drive(random_scene(seed), law, 20.0, traffic)
    result = {
        "paper_times_real": paper.driven / paper.total, "paper_seconds": paper.driven, "paper_world_share": paper.world / paper.total,
        "paper_first_worst_ms": share(cold.strategic + cold.motion, 1.0),
    }  # fmt: skip
    for name, timed in (("paper", paper), ("traffic", traffic)):
        for kind, times in (("strategic", timed.strategic), ("motion", timed.motion)):
            result |= {f"{name}_{kind}_{word}_ms": share(times, part) for word, part in (("median", 0.5), ("p99", 0.99))}
        result[f"{name}_plans_median"] = sorted(timed.plans)[len(timed.plans) // 2]
    met = (
        result["paper_times_real"] >= TIMES_REAL and result["paper_strategic_p99_ms"] <= STRATEGIC_MS and result["paper_motion_p99_ms"] <= MOTION_MS
    )  # fmt: skip
    for name, value in result.items():
        print(f"{name:32} {value:10.2f}")
    print(f"marks: {TIMES_REAL:.0f} x real time, strategic {STRATEGIC_MS:.0f} ms, motion {MOTION_MS:.0f} ms at p99: {'met' if met else 'MISSED'}")
    OUT.parent.mkdir(parents=True, exist_ok=True)
    OUT.write_text(json.dumps(result, indent=1) + "\n", "utf-8")
    return 1 if chosen.strict and not met else 0


if __name__ == "__main__":
    sys.exit(main())
