"""The table of drives: what happened, the sections that decided, and the numbers that matter; 80 columns, or Markdown."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from regdb.units import from_si
from regdb_runtime.drive.expected import shortfalls
from regdb_runtime.drive.log import Log
from regdb_runtime.drive.measures import Measures, measure
from regdb_runtime.drive.variants import Variant

WIDTH = 80
REASON = 120
"""Characters of a reason that the table shows."""
ROUNDING = 0.01
"""m/s over a limit that are rounding, not driving."""
_EVENT_WORDS = {
    "overtaking_begins": "overtakes", "back_in_lane": "is back in lane", "overtaking_given_up": "gives up overtaking", "stopped": "stops",
    "released": "goes on", "zone_detected": "brakes for the zone", "reduced_speed": "reaches its limit",
}  # fmt: skip


@dataclass(frozen=True)
class Row:
    """One drive in the table; `wrong` says in what it was not as its variant expects."""

    name: str
    provenance: str
    expects: str
    measures: Measures
    wrong: tuple[str, ...]


def row_of(log: Log, variant: Variant | None) -> Row:
    """The row of a drive; without a variant (a scene of one's own) nothing is expected of it."""
    found = measure(log)
    wrong = () if variant is None else shortfalls(variant.expects, found)
    return Row(log.run["variant"], log.run["provenance"], "" if variant is None else variant.expects.says, found, wrong)


def story(found: Measures) -> str:
    """What happened, in a line: each event with its time and its number, and the end."""
    parts = [_told(event.name, event.time, found) for event in found.events]
    parts.append("arrives" if found.ended == "destination" else f"ends by {found.ended} ({shorten(found.reason, REASON)})")
    return ", ".join([*parts[:-1], f"{parts[-1]} at {found.time:.1f} s"])


def shorten(text: str, most: int) -> str:
    """The beginning of a long list of reasons; the log has the whole."""
    return textwrap.shorten(text, most, placeholder=" …")


def _told(name: str, time: float, found: Measures) -> str:
    extra = ""
    if name == "stopped" and found.stop_gap is not None:
        extra = f" {found.stop_gap:.2f} m before the line"
    elif name == "back_in_lane" and found.clearance is not None:
        extra = f" ({found.clearance:.2f} m clear, {found.passes.replace('_', ' ')})"
    elif name == "released" and found.crosses:
        extra = f" ({found.crosses} light)"
    return f"{_EVENT_WORDS[name]}{extra} at {time:.1f} s"


def numbers(found: Measures) -> str:
    """The numbers of a drive in a line: least clearance, speed against the limit, where it stood, time and distance."""
    parts = []
    if found.clearance is not None:
        parts.append(f"clearance {found.clearance:.2f} m ({found.clearance / 0.3048:.1f} ft)")
    parts.append(f"top {mph(found.top_speed)}")
    if found.excess is not None:
        parts.append(f"{found.excess:.2f} m/s over the limit" if found.excess > ROUNDING else "never over the limit")
    if found.zone_speed is not None:
        parts.append(f"{mph(found.zone_speed)} in the zone")
    if found.stop_gap is not None:
        parts.append(f"stood {found.stop_gap:.2f} m before the line")
    return "; ".join([*parts, f"{found.distance:.0f} m in {found.time:.1f} s"])


def mph(speed: float) -> str:
    """A speed in m/s as miles per hour, one decimal."""
    return f"{float(from_si(1.0, 'mph')) * speed:.1f} mph"


def table(rows: Sequence[Row]) -> str:
    """All drives as text of 80 columns: name and outcome, what happened, sections, numbers."""
    lines: list[str] = []
    for row in rows:
        lines += _block(row)
    good = sum(1 for row in rows if row.expects and not row.wrong)
    if len(rows) > 1:
        lines += ["", f"{good} of {len(rows)} drives are as expected"]
    return "\n".join(lines)


def block(row: Row, width: int = WIDTH - 3) -> str:
    """One drive as text, narrow enough to be indented."""
    return "\n".join(_block(row, width))


def _block(row: Row, width: int = WIDTH) -> Iterable[str]:
    verdict = "driven" if not row.expects else "as expected" if not row.wrong else "NOT AS EXPECTED"
    yield f"{row.name:<24}{verdict}  (perception: {row.provenance})"
    for label, text in (("", row.expects), ("did", story(row.measures)), ("law", ", ".join(row.measures.sections)), ("", numbers(row.measures))):
        if text:
            yield from textwrap.wrap(text, width, initial_indent=f"  {label:<5}", subsequent_indent=" " * 7)
    for text in row.wrong:
        yield from textwrap.wrap(shorten(text, 3 * REASON), width, initial_indent="  !    ", subsequent_indent=" " * 7)


COLUMNS = ("variant", "perception", "what happened", "decided by", "least clearance", "top speed", "over the limit", "stood before the line", "time")


def markdown(rows: Sequence[Row]) -> str:
    """All drives as a Markdown table."""
    lines = ["| " + " | ".join(COLUMNS) + " |", "|" + "---|" * len(COLUMNS)]
    for row in rows:
        found = row.measures
        cells = (
            row.name, row.provenance, story(found) + "".join(f" **({text})**" for text in row.wrong), ", ".join(found.sections),
            _number(found.clearance, "m"), mph(found.top_speed), "no" if (found.excess or 0.0) <= ROUNDING else f"{found.excess:.2f} m/s",
            _number(found.stop_gap, "m"), f"{found.time:.1f} s",
        )  # fmt: skip
        lines.append("| " + " | ".join(cell.replace("|", "/") for cell in cells) + " |")
    return "\n".join(lines) + "\n"


def _number(value: float | None, unit: str) -> str:
    return "" if value is None else f"{value:.2f} {unit}"


def row_data(row: Row) -> dict[str, Any]:
    """One drive in its stable JSON form; SI."""
    found = row.measures
    return {
        "variant": row.name, "provenance": row.provenance, "expects": row.expects, "as_expected": not row.wrong, "wrong": list(row.wrong),
        "ended": found.ended, "reason": found.reason, "time": found.time, "distance": found.distance,
        "events": [{"name": event.name, "time": event.time, "station": event.station} for event in found.events],
        "states": list(found.states), "sections": list(found.sections), "top_speed": found.top_speed, "excess": found.excess,
        "clearance": found.clearance, "nearest": found.nearest, "stop_gap": found.stop_gap, "waited": found.waited, "zone_speed": found.zone_speed,
        "passes": found.passes, "crosses": found.crosses,
    }  # fmt: skip
