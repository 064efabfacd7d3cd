"""No test and no case shows an exception deciding.

Why:
    An exception that never decides in any test may as well not be there: its condition may be wrong, or its name lead elsewhere. The test
    says so by `deciding`.

Fails:
    exception_to: [st-10-a]
    legality: true
    result: may turn right
    tests: [{name: x, plan: {current: stop, next: turn_right}, expect: unknown}]

Passes:
    exception_to: [st-10-a]
    legality: true
    result: may turn right
    tests:
      - {name: x, scene: {children.present: true}, plan: {current: stop, next: turn_right}, expect: {verdict: legal, deciding: [a]}}
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build

CODE, NAME = "R814", "untested-exception"
LEVEL: Level = "warning"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each permission with tests that no `deciding` names."""
    shown = _shown(build)
    for entry in build.corpus.regulations:
        if entry.doc.legality and entry.doc.tests and entry.id not in shown and (entry.doc.exception_to or entry.doc.overrides):
            message = f"no test shows {entry.id} deciding"
            help_ = f"expect: {{verdict: legal, deciding: [{entry.doc.id}]}}"
            place = entry.place("exception_to" if entry.doc.exception_to else "overrides")
            yield Diagnostic(CODE, NAME, LEVEL, message, place, help=help_, law=str(entry.citation))


def _shown(build: Build) -> set[str]:
    """The ids that tests and cases expect to decide."""
    found: set[str] = set()
    for entry in build.corpus.regulations:
        for test in entry.doc.tests:
            for name in test.expect.deciding or ():
                found.update((name, f"{entry.section.id}-{name}", f"{entry.jurisdiction.code}-{name}"))
    for case in build.corpus.cases:
        found.update(case.doc.expect.deciding or ())
    return found
