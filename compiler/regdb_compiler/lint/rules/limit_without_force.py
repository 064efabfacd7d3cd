"""A limit does not say what kind of limit it is.

Why:
    Absolute, prima facie, basic, penalty tier and advisory differ in what they bind to. A report names the kind, so the author does.

Fails:
    attributes: {max_speed: 25 mph}

Passes:
    attributes: {max_speed: 25 mph}
    force: prima_facie

Fix (safe):
    Writes `force: absolute`, as which the limit is compiled now.
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Fix, Level
from regdb_compiler.driver import Build
from regdb_compiler.lint.edits import insert_key_after
from regdb_compiler.lint.view import view_of

CODE, NAME = "R310", "limit-without-force"
LEVEL: Level = "warning"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each prohibition with limits and no force."""
    for rule in view_of(build).first:
        entry = rule.entry
        if rule.limits and entry.doc.force is None:
            edit = insert_key_after(entry.node, "attributes", "force: absolute")
            fix = Fix("safe", "write `force: absolute`, as it is compiled now", (edit,)) if edit else None
            place = entry.key_place("attributes", rule.limits[0].attribute)
            yield Diagnostic(CODE, NAME, LEVEL, "this limit does not say what kind it is", place, note="`force` is missing",
                             law=str(entry.citation), fix=fix)  # fmt: skip
