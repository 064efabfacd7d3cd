"""A local limit overrides one with the same number.

Why:
    It changes nothing but the kind of limit and whose it is; the number was perhaps copied from the state's code.

Fails:
    local: {attributes: {max_speed: 65 mph}, force: absolute, overrides: [st-30-a]}

Passes:
    local: {attributes: {max_speed: 45 mph}, force: absolute, overrides: [st-30-a]}
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build
from regdb_compiler.lint.naming import named_targets

CODE, NAME = "R624", "redundant-override"
LEVEL: Level = "warning"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each override whose bounds are all those of its target."""
    by_entry = build.resolution.by_entry
    for name in named_targets(build):
        entry, targets = name.entry, name.targets
        if not entry.doc.overrides:
            continue
        ours = next(({(limit.attribute, limit.bound) for limit in rule.limits} for rule in by_entry.get(entry, ())), set())
        for target in targets:
            theirs = next(({(limit.attribute, limit.bound) for limit in rule.limits} for rule in by_entry.get(target, ())), set())
            if ours and ours == theirs and entry.doc.force == target.doc.force:
                message = f"{target.id} says the same number"
                related = ((target.place("attributes"), "the same"),)
                yield Diagnostic(CODE, NAME, LEVEL, message, name.place, related=related, law=str(entry.citation))
                break
