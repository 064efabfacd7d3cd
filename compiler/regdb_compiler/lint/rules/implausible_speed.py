"""A speed limit above 100 mph is not marked as a penalty tier.

Why:
    No road here is signed so. A number of that size is the threshold of an aggravated offence, or a slip of the keys.

Fails:
    attributes: {max_speed: 250 mph}
    force: absolute

Passes:
    attributes: {max_speed: 25 mph}
    force: absolute
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb.units import to_si
from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build
from regdb_compiler.lint.view import view_of
from regdb_compiler.resolve import constant_of

CODE, NAME = "R312", "implausible-speed"
LEVEL: Level = "warning"
HIGHEST = to_si(100, "mph")


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each bound on a speed above that."""
    for rule in view_of(build).first:
        if rule.entry.doc.force == "penalty_tier":
            continue
        for limit in rule.limits:
            bound = constant_of(limit.bound)
            if bound is not None and bound > HIGHEST and limit.unit in {"mph", "km/h", "m/s"}:
                message = f"{limit.text} is no speed limit of any road"
                place = rule.entry.place("attributes", limit.attribute)
                help_ = "if it is the threshold of an aggravated offence, mark it `force: penalty_tier`"
                yield Diagnostic(CODE, NAME, LEVEL, message, place, help=help_, law=str(rule.entry.citation))
