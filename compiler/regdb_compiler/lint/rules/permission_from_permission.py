"""A permission is written as an exception to a permission.

Why:
    A permission forbids nothing, so there is nothing to be excused from. The prohibition behind both is the one to name; what takes the
    first permission back is a prohibition.

Fails:
    exception_to: [st-10-b]
    legality: true
    result: may turn right
    states: {current: [intersection_handling], next: [turn_right]}

Passes:
    exception_to: [st-10-a]
    legality: true
    result: may turn right
    states: {current: [intersection_handling], next: [turn_right]}
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build
from regdb_compiler.lint.naming import named_targets

CODE, NAME = "R623", "permission-from-permission"
LEVEL: Level = "warning"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each such name."""
    for name in named_targets(build):
        entry, targets = name.entry, name.targets
        if entry.doc.legality and all(target.doc.legality for target in targets):
            message = f"{targets[0].id} is a permission itself, so {entry.id} defeats no prohibition by naming it"
            related = ((targets[0].place("legality"), "a permission"),)
            yield Diagnostic(CODE, NAME, LEVEL, message, name.place, related=related, law=str(entry.citation))
