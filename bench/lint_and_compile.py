"""Time reading, linting and compiling one codes folder in this process: `python bench/lint_and_compile.py CODES`; prints JSON.

Processor seconds, so that what else the machine does counts little; the peak of memory is the process's.
"""

# ruff: noqa: T201  # a script whose result is what it prints
from __future__ import annotations

import json
import resource
import sys
import tempfile
import time
from itertools import pairwise
from pathlib import Path
from typing import Any

from regdb_compiler.driver import build
from regdb_compiler.emit.to_sqlite import write_database
from regdb_compiler.lint.run import lint
from regdb_compiler.source import collector_paused
from regdb_runtime.database import RegulationDatabase


def measure(codes: Path) -> dict[str, Any]:
    """Seconds of each step, counts, and the peak of memory. Raises RegdbInputError for codes with errors."""
    marks = [time.process_time()]
    found = build(codes)
    marks.append(time.process_time())
    findings = lint(found)
    marks.append(time.process_time())
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "law.sqlite"
        write_database(found, path)
        marks.append(time.process_time())
        peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
        opened = len(RegulationDatabase.open(path))
        marks.append(time.process_time())
    read, linted, written, opening = (after - before for before, after in pairwise(marks))
    return {
        "regulations": opened, "findings": len(findings), "peak_bytes": peak, "build_s": read, "lint_s": linted, "write_s": written,
        "lint_and_compile_s": read + linted + written, "open_s": opening,
    }  # fmt: skip


if __name__ == "__main__":
    with collector_paused():  # as the commands do
        print(json.dumps(measure(Path(sys.argv[1]))))
