"""`force` stands in a regulation that has no limit, and is not the basic speed law.

Why:
    The kinds are kinds of limit. Without one they say nothing, save `advisory`, which silently makes the prohibition unbreakable, and
    `basic`: the basic speed law bounds speed without a number.

Fails:
    force: absolute

Passes:
    attributes: {max_speed: 25 mph}
    force: absolute

Fix (safe):
    Takes `force` out, unless it is advisory, where that would change what is unlawful.
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Fix, Level
from regdb_compiler.driver import Build
from regdb_compiler.lint.edits import delete_key
from regdb_compiler.lint.view import view_of

CODE, NAME = "R311", "force-without-limit"
LEVEL: Level = "warning"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each such regulation."""
    for rule in view_of(build).first:
        entry = rule.entry
        if entry.doc.force not in {None, "basic"} and not rule.limits:
            advisory = entry.doc.force == "advisory"
            edit = None if advisory else delete_key(entry.node, "force")
            fix = Fix("safe", "take `force` out", (edit,)) if edit else None
            message = f"`force: {entry.doc.force}` without a limit" + (" makes the prohibition one that nobody can break" if advisory else "")
            yield Diagnostic(CODE, NAME, LEVEL, message, entry.place("force"), law=str(entry.citation), fix=fix)
