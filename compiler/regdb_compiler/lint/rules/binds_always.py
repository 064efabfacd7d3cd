"""A prohibition has neither condition nor limits nor states, so it makes every plan unlawful.

Why:
    Nothing narrows it down: no transition, no scene, no number. Something was forgotten.

Fails:
    condition: {when: null}
    states: null

Passes:
    condition: {when: children.present}
    states: null
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb.condition import TRUE
from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build
from regdb_compiler.lint.view import view_of

CODE, NAME = "R207", "binds-always"
LEVEL: Level = "error"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each regulation that nothing narrows down."""
    for rule in view_of(build).first:
        if rule.when == TRUE and rule.scope == TRUE and not rule.limits and rule.current is None and rule.next is None:
            if rule.unless is not None or rule.entry.doc.authority:
                continue
            entry = rule.entry
            message = f"{entry.id} {'permits' if entry.doc.legality else 'forbids'} everything, always"
            help_ = "write when it holds (`when`), for which transitions (`states`), or beyond which number (`attributes`)"
            yield Diagnostic(CODE, NAME, LEVEL, message, entry.place("id"), help=help_, law=str(entry.citation))
