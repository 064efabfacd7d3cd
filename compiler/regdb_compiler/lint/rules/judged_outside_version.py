"""A test is judged on a day on which its regulation is not in force.

Why:
    The regulation takes no part in it, so the test passes whatever the regulation says.

Fails:
    tests: [{name: long ago, on: 1990-01-01, plan: {current: lane_following, next: lane_change}, expect: legal}]

Passes:
    tests: [{name: now, on: 2020-01-01, plan: {current: lane_following, next: lane_change}, expect: unknown}]
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build

CODE, NAME = "R513", "judged-outside-version"
LEVEL: Level = "warning"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each test that names such a day; a test whose rule has another version on that day compares the two."""
    for entry in build.corpus.regulations:
        for position, test in enumerate(entry.doc.tests):
            on = test.on.toordinal() if test.on else None
            if on is None or entry.in_force(on) or any(other.in_force(on) for other in build.corpus.by_id[entry.id]):
                continue
            message = f"{entry.id} is not in force on this day"
            place = entry.place("tests", position, "on")
            yield Diagnostic(CODE, NAME, LEVEL, message, place, law=str(entry.citation))
