"""Drive random scenes and hold them against what no drive may do: `python tests/random_drives.py 0 1000 [--seconds 60] [-o FOLDER]`.

Each failing scene is written as JSON, made as small as it still fails; `regdb drive replay FILE` drives it again.
"""

# ruff: noqa: T201  # a script whose result is what it prints
from __future__ import annotations

import argparse
import sys
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from functools import lru_cache, partial
from pathlib import Path

from regdb_runtime.database import RegulationDatabase
from regdb_runtime.drive.shrink import shrink
from regdb_runtime.drive.trial import Fault, Outcome, TrialSettings, trial
from regdb_runtime.worlds.random_scenes import random_scene
from regdb_runtime.worlds.scene_spec import SceneSpec

from regdb.front import database


@lru_cache(maxsize=1)
def law() -> RegulationDatabase:
    """The shipped law, opened once a process."""
    return RegulationDatabase.open(database())


def drive_seed(seed: int, seconds: float) -> Outcome:
    """One seed's scene, driven."""
    return trial(random_scene(seed), law(), TrialSettings(seconds=seconds))


def small_failure(seed: int, fault: Fault) -> SceneSpec:
    """The seed's scene with all that the fault does not need taken away."""
    until = TrialSettings(seconds=fault.time + 1.0)
    return shrink(random_scene(seed), lambda spec: any(item.kind == fault.kind for item in trial(spec, law(), until).faults))


def outcomes(seeds: range, seconds: float, jobs: int) -> Iterator[Outcome]:
    """Every seed's outcome, in order."""
    if jobs == 1:
        yield from (drive_seed(seed, seconds) for seed in seeds)
        return
    with ProcessPoolExecutor(jobs) as pool:
        yield from pool.map(partial(drive_seed, seconds=seconds), seeds, chunksize=1)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("first", type=int)
    parser.add_argument("last", type=int, help="the seed after the last")
    parser.add_argument("--seconds", type=float, default=60.0, help="how long each scene is driven")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--shrink", action="store_true", help="make failing scenes smaller before they are written")
    parser.add_argument("-o", "--out", type=Path, default=Path("out/drives"))
    chosen = parser.parse_args()
    seeds = range(chosen.first, chosen.last)
    faults, flags, driven, seconds = Counter[str](), Counter[str](), 0.0, 0.0
    for seed, outcome in zip(seeds, outcomes(seeds, chosen.seconds, chosen.jobs), strict=True):
        flags.update(outcome.flags)
        driven, seconds = driven + outcome.driven, seconds + outcome.seconds
        for fault in outcome.faults:
            faults[fault.kind] += 1
            print(f"seed {seed}: {fault.kind} at {fault.time:.1f} s: {fault.what}", flush=True)
        if outcome.faults:
            spec = small_failure(seed, outcome.faults[0]) if chosen.shrink else random_scene(seed)
            chosen.out.mkdir(parents=True, exist_ok=True)
            (chosen.out / f"{outcome.scene}.json").write_text(spec.to_json(), "utf-8")
    ticks = sum(flags.values())
    print(f"{len(seeds)} scenes, {seconds:.0f} s, {driven / 1000:.1f} km, {ticks} ticks")
    print("flags: " + ", ".join(f"{name or 'lawful'} {count}" for name, count in flags.most_common()))
    print("faults: " + (", ".join(f"{name} {count}" for name, count in faults.most_common()) or "none"))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
