"""Time the step from 10,000 resolved regulations to the database file, and to all outputs: `python bench/emit.py [COUNT]`.

Reading and resolving are not counted. Writes out/bench/emit.json.
"""

# ruff: noqa: T201  # a script whose result is what it prints
from __future__ import annotations

import json
import platform
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from generate import generate
from regdb_compiler.driver import build
from regdb_compiler.emit.outputs import write_outputs
from regdb_compiler.emit.to_sqlite import write_database

OUT = Path("out/bench/emit.json")
MARK_S = 1.0
"""The database from 10,000 regulations, in processor seconds."""

REPEATS = 3


def best(work: Callable[[], Any]) -> float:
    """Least processor time of a few runs, in seconds."""
    times = []
    for _ in range(REPEATS):
        started = time.process_time()
        work()
        times.append(time.process_time() - started)
    return min(times)


def main(count: int = 10_000) -> int:
    """Measure and print; 1 if the mark for 10,000 is missed."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        found = build(generate(count, folder))
        assert len(found.rows) == count
        database = best(lambda: write_database(found, folder / "regulations.sqlite"))
        outputs = best(lambda: write_outputs(found, folder / "out"))
        size = (folder / "regulations.sqlite").stat().st_size
    result = {"regulations": count, "database_s": database, "all_outputs_s": outputs, "bytes": size, "python": platform.python_version()}
    OUT.parent.mkdir(parents=True, exist_ok=True)
    OUT.write_text(json.dumps(result, indent=1) + "\n")
    print(f"{count:,} regulations: database {database:.2f} s, all outputs {outputs:.2f} s, {size / 1e6:.1f} MB")
    return 1 if count == 10_000 and database > MARK_S else 0


if __name__ == "__main__":
    sys.exit(main(*map(int, sys.argv[1:2])))
