"""All tests of a regulation expect the same verdict.

Why:
    A rule that always says so would pass them too. One test shows it at work, another shows where it stops.

Fails:
    tests: [{name: among children, scene: {children.present: true}, plan: {current: lane_following, next: lane_change}, expect: illegal}]

Passes:
    tests:
      - {name: among children, scene: {children.present: true}, plan: {current: lane_following, next: lane_change}, expect: illegal}
      - {name: nobody there, scene: {children.present: false}, plan: {current: lane_following, next: lane_change}, expect: legal}
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build

CODE, NAME = "R812", "one-sided-tests"
LEVEL: Level = "warning"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each regulation with tests of one verdict only; advisory limits and penalty tiers have one side."""
    for entry in build.corpus.regulations:
        verdicts = {test.expect.verdict for test in entry.doc.tests}
        if len(verdicts) == 1 and None not in verdicts and entry.doc.force not in {"advisory", "penalty_tier"}:
            message = f"every test expects `{next(iter(verdicts))}`"
            help_ = "add one in which it is otherwise, by as little as possible"
            yield Diagnostic(CODE, NAME, LEVEL, message, entry.key_place("tests"), help=help_, law=str(entry.citation))
