"""A regulation goes on to name another that has expired.

Why:
    From that day on the exception or override displaces nothing; what it was to displace may live on under another id.

Fails:
    effective: 2000-01-01
    regulations:
      - {id: a, until: 2010-01-01}
      - {id: b, exception_to: [a], legality: true, result: may change lanes}

Passes:
    effective: 2000-01-01
    regulations:
      - {id: a}
      - {id: b, exception_to: [a], legality: true, result: may change lanes}
"""

from __future__ import annotations

import datetime
from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build
from regdb_compiler.entries import RegulationEntry
from regdb_compiler.lint.naming import named_targets

CODE, NAME = "R511", "expired-target"
LEVEL: Level = "warning"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each name whose regulations all end while the naming one goes on, and does not name what comes after them."""
    successors: dict[RegulationEntry, list[RegulationEntry]] = {}
    for name in named_targets(build):
        successors.setdefault(name.entry, []).extend(name.targets)
    for name in named_targets(build):
        entry, targets = name.entry, name.targets
        ends = [target.until for target in targets]
        if None in ends or not any(entry.overlaps(target) for target in targets):
            continue
        last = max(end for end in ends if end is not None)
        section = targets[0].section
        succeeded = any(other.section is section and other.in_force(last) for other in successors[entry])
        if not succeeded and (entry.until is None or entry.until > last):
            day = datetime.date.fromordinal(last).isoformat()
            message = f"{targets[0].id} is in force until {day} only, and {entry.id} goes on"
            related = ((targets[-1].place("id"), "expires"),)
            yield Diagnostic(CODE, NAME, LEVEL, message, name.place, related=related, law=str(entry.citation))
