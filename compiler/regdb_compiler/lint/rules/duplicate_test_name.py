"""Two tests of a regulation, or two cases of a file, have one name.

Why:
    A failure names its test. With two of that name, nobody knows which.

Fails:
    tests:
      - {name: x, scene: {children.present: true}, plan: {current: lane_following, next: lane_change}, expect: illegal}
      - {name: x, scene: {children.present: false}, plan: {current: lane_following, next: lane_change}, expect: legal}

Passes:
    tests:
      - {name: x, scene: {children.present: true}, plan: {current: lane_following, next: lane_change}, expect: illegal}
      - {name: y, scene: {children.present: false}, plan: {current: lane_following, next: lane_change}, expect: legal}
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Level, Place
from regdb_compiler.driver import Build

CODE, NAME = "R815", "duplicate-test-name"
LEVEL: Level = "warning"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each name that was there before."""
    for entry in build.corpus.regulations:
        names = [test.name for test in entry.doc.tests]
        if len(set(names)) < len(names):
            for position, name in enumerate(names):
                if name in names[:position]:
                    first = entry.place("tests", names.index(name), "name")
                    yield _finding(name, entry.place("tests", position, "name"), first, str(entry.citation))
    held: dict[tuple[str, str], Place] = {}
    for case in build.corpus.cases:
        key = (case.file.path, case.doc.name)
        if key in held:
            yield _finding(case.doc.name, case.place("name"), held[key], "")
        held.setdefault(key, case.place("name"))


def _finding(name: str, place: Place, first: Place, law: str) -> Diagnostic:
    return Diagnostic(CODE, NAME, LEVEL, f"there are two called `{name}`", place, related=((first, "the first"),), law=law)
