"""Drive random scenes and hold them against what no drive may do: `python tests/random_drives.py 0 1000 [--seconds 60] [-o FOLDER]`.

Each failing scene is written as JSON, made as small as it still fails; `regdb drive replay FILE` drives it again.
"""

# ruff: noqa: T201  # a script whose result is what it prints
from __future__ import annotations

import argparse
import signal
import sys
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field
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


@dataclass
class Tally:
    """What a series of drives came to so far."""

    scenes: int = 0
    faults: Counter[str] = field(default_factory=Counter)
    flags: Counter[str] = field(default_factory=Counter)
    driven: float = 0.0
    seconds: float = 0.0

    def add(self, outcome: Outcome) -> None:
        self.scenes += 1
        self.faults.update(fault.kind for fault in outcome.faults)
        self.flags.update(outcome.flags)
        self.driven, self.seconds = self.driven + outcome.driven, self.seconds + outcome.seconds

    def __str__(self) -> str:
        lines = [f"{self.scenes} scenes, {self.seconds:.0f} s, {self.driven / 1000:.1f} km, {sum(self.flags.values())} ticks"]
        lines.append("flags: " + ", ".join(f"{name or 'lawful'} {count}" for name, count in self.flags.most_common()))
        lines.append("faults: " + (", ".join(f"{name} {count}" for name, count in self.faults.most_common()) or "none"))
        return "\n".join(lines)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("first", type=int)
    parser.add_argument("last", type=int, help="the seed after the last")
    parser.add_argument("--seconds", type=float, default=60.0, help="how long each scene is driven")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--shrink", action="store_true", help="make failing scenes smaller before they are written")
    parser.add_argument("-o", "--out", type=Path, default=Path("out/drives"))
    chosen = parser.parse_args()
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # stopped or interrupted, it says what there was
    seeds, tally = range(chosen.first, chosen.last), Tally()
    try:
        for seed, outcome in zip(seeds, outcomes(seeds, chosen.seconds, chosen.jobs), strict=True):
            tally.add(outcome)
            if tally.scenes % 10 == 0:
                print(f"{tally.scenes} of {len(seeds)}", file=sys.stderr, flush=True)
            for fault in outcome.faults:
                print(f"seed {seed}: {fault.kind} at {fault.time:.1f} s: {fault.what}", flush=True)
            if outcome.faults:
                spec = small_failure(seed, outcome.faults[0]) if chosen.shrink else random_scene(seed)
                chosen.out.mkdir(parents=True, exist_ok=True)
                (chosen.out / f"{outcome.scene}.json").write_text(spec.to_json(), "utf-8")
    except KeyboardInterrupt:
        print("interrupted", file=sys.stderr)
    print(tally)
    return 1 if tally.faults or tally.scenes < len(seeds) else 0


if __name__ == "__main__":
    sys.exit(main())
