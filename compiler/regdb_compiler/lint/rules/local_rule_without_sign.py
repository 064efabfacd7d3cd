"""A local regulation is in force without a sign.

Why:
    Few local rules are. Where the delegation asks for a sign this is an error (R606); where it does not, the road user knows only by
    the ordinance, which is worth a second look.

Fails:
    local: {attributes: {max_speed: 25 mph}, force: prima_facie}

Passes:
    local: {attributes: {max_speed: 25 mph}, force: prima_facie, requires_sign: sign.speed_limit}
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build
from regdb_compiler.lint.view import view_of

CODE, NAME = "R621", "local-rule-without-sign"
LEVEL: Level = "info"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each local limit that requires no sign, where none of its delegations does."""
    for rule in view_of(build).first:
        entry = rule.entry
        if not entry.jurisdiction.is_local or entry.doc.requires_sign or not rule.limits:
            continue
        delegations = build.authority.delegations(rule)
        if delegations and not any(item.doc.sign for item in delegations):
            message = f"{entry.id} holds without a sign"
            help_ = "add `requires_sign:` where the law gives it no effect without one"
            yield Diagnostic(CODE, NAME, LEVEL, message, entry.place("authority"), help=help_, law=str(entry.citation))
