"""Whether a drive did what its variant expects, and what every drive owes: an end, no contact, no speed over the limit."""

from __future__ import annotations

from collections.abc import Iterator

from regdb_runtime.drive.measures import Measures
from regdb_runtime.drive.variants import Expectation

THREE_FEET = 0.9144
"""Metres; CVC 21760(c), the paper's P33."""
LINE_GAP = 2.0
"""Metres before the line within which a stop counts as at it (FEATURES H05)."""
_TOLERANCE = 0.01
"""m/s by which a speed may exceed its bound: the rounding of positions, not a way of driving."""


def shortfalls(expects: Expectation, found: Measures) -> tuple[str, ...]:
    """Everything in which a drive is not as expected, a sentence each; empty when it is."""
    return (*_owed(expects, found), *_wanted(expects, found))


def _owed(expects: Expectation, found: Measures) -> Iterator[str]:
    if found.ended != expects.ends:
        yield f"ended by {found.ended}: {found.reason}"
    if found.excess is not None and found.excess > _TOLERANCE:
        yield f"{found.excess:.2f} m/s over the limit in force"
    if found.clearance is not None and found.passes and found.clearance < THREE_FEET:
        yield f"passed at {found.clearance:.2f} m"
    if found.stop_gap is not None and not 0 <= found.stop_gap <= LINE_GAP:
        yield f"stood {found.stop_gap:.2f} m before the line"


def _wanted(expects: Expectation, found: Measures) -> Iterator[str]:
    names = tuple(event.name for event in found.events)
    if names != expects.events:
        yield f"events {', '.join(names) or 'none'}; expected {', '.join(expects.events) or 'none'}"
    if found.passes != expects.passes:
        yield f"passed {found.passes or 'nobody'}; expected {expects.passes or 'nobody'}"
    if expects.crosses and found.crosses != expects.crosses:
        yield f"crossed the line on {found.crosses or 'nothing shown'}; expected {expects.crosses}"
    missing = [citation for citation in expects.sections if citation not in found.sections]
    if missing:
        yield f"not decided by {', '.join(missing)}"
    if expects.zone_limit is not None and (found.zone_speed is None or found.zone_speed > expects.zone_limit + _TOLERANCE):
        yield f"{found.zone_speed or 0.0:.2f} m/s in the zone; expected at most {expects.zone_limit:.2f}"
