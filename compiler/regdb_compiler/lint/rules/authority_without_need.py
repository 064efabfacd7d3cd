"""A regulation of a state or model code names an authority.

Why:
    Only counties, cities and districts need one. On other law the field does nothing, and a reader takes the rule for a local one.

Fails:
    authority: ST 40

Passes:
    local: {attributes: {max_speed: 25 mph}, force: absolute, authority: ST 40, requires_sign: sign.speed_limit}

Fix (unsafe):
    Takes `authority` out.
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Fix, Level
from regdb_compiler.driver import Build
from regdb_compiler.lint.edits import delete_key

CODE, NAME = "R625", "authority-without-need"
LEVEL: Level = "warning"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each such field."""
    for entry in build.corpus.regulations:
        if entry.doc.authority and not entry.jurisdiction.is_local:
            edit = delete_key(entry.node, "authority")
            fix = Fix("unsafe", "take `authority` out", (edit,)) if edit else None
            message = f"the law of {entry.jurisdiction.name} needs no authority"
            yield Diagnostic(CODE, NAME, LEVEL, message, entry.place("authority"), law=str(entry.citation), fix=fix)
