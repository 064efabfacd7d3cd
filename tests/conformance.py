"""A neutral conformance case in, the answer in the same form out, by the project's own compiler, database and runtime.

`judge(case)` writes the case as a folder of codes (tests/neutral_codes.py), compiles it to a database file, opens that with the runtime
and judges. Nothing of the meaning is implemented here.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path
from typing import Any

sys.path[:0] = [str(Path(__file__).parent)] if str(Path(__file__).parent) not in sys.path else []

from neutral_codes import NeutralCodes  # noqa: E402  # the line above makes it importable from wherever this file is loaded
from regdb_compiler.driver import Build, build  # noqa: E402
from regdb_compiler.emit.to_sqlite import write_database  # noqa: E402
from regdb_runtime.database import RegulationDatabase  # noqa: E402

from regdb.situation import read_plan, read_scene  # noqa: E402

NAMED_ERRORS = ("permission-without-target", "unknown-target", "exception-cycle", "missing-authority")


def judge(case: dict[str, Any]) -> dict[str, Any]:
    """The answer to a case: `verdict`, `deciding`, `limits`, `assumed` and `unknown`, or `error` with the name of the first error.

    Ids, facts and numbers are the case's own. Raises nothing for a case the README describes.
    """
    neutral = NeutralCodes(case)
    with tempfile.TemporaryDirectory(prefix="regdb-conformance-") as folder:
        codes = neutral.write(Path(folder) / "codes")
        built = build(codes)
        if built.has_errors:
            return {"error": _error(built)}
        path = Path(folder) / "regulations.sqlite"
        write_database(built, path)
        database = RegulationDatabase.open(path)
        scene = read_scene(neutral.scene, database.vocabulary)
        plan = read_plan(neutral.plan, database.vocabulary, database.machine)
        verdict = database.at(neutral.place, neutral.date).judge(scene, plan)
        return {
            "verdict": verdict.verdict,
            "deciding": sorted({neutral.name_of(rule.id) for rule in verdict.deciding}),
            "limits": {name: plain(item.bound) for name, item in sorted(verdict.combined.items())},
            "assumed": sorted(verdict.assumed),
            "unknown": sorted(verdict.missing),
        }


def _error(built: Build) -> str:
    """The first error that cases may name, else the first error."""
    errors = [item.name for item in built.diagnostics if item.level == "error"]
    return next((name for name in errors if name in NAMED_ERRORS), errors[0])


def plain(number: float) -> float | int:
    """A whole number without its point, as cases write it."""
    return int(number) if number == int(number) else number
