"""A regulation has no test beside it.

Why:
    A test is a sentence of law: a scene, a plan, a verdict. Without one nobody has said what the annotation is to mean.

Fails:
    tests: []

Passes:
    tests: [{name: among children, scene: {children.present: true}, plan: {current: lane_following, next: lane_change}, expect: illegal}]
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build

CODE, NAME = "R811", "untested-regulation"
LEVEL: Level = "warning"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each regulation without tests; another version of it that has some will do where the words are the same."""
    for entry in build.corpus.regulations:
        if entry.doc.tests:
            continue
        others = build.corpus.by_id[entry.id]
        same = (other.doc.condition == entry.doc.condition and other.doc.attributes == entry.doc.attributes for other in others if other.doc.tests)
        if not any(same):
            yield Diagnostic(CODE, NAME, LEVEL, f"{entry.id} has no test", entry.place("id"), help="add `tests:`", law=str(entry.citation))
