"""The observer's report: as text of 80 columns, and as plain data for JSON."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from regdb_runtime.drive.observed.findings import Finding, Observed

SCHEMA = "regdb-drive-observe/1"
WIDTH = 80
LISTED = 15
"""Rules of which text lists what is unknown; the data has them all."""


@dataclass(frozen=True)
class About:
    """What was judged, by what: the recording's id and length (s), the place with its name, the day and time, and what was taken for known.

    `model`: only a model code answers there, which binds nobody. `notes`: a sentence each, for people.
    """

    recording: str
    seconds: float
    place: str
    name: str
    start: str
    eye: str
    interpretation: str
    database: str
    model: bool = False
    notes: tuple[str, ...] = ()


NOTES: tuple[str, ...] = (
    "light phases and turn signals are not in the recording: unknown",
    "a rule counts as broken only where it is for every place and speed within the errors of the recording and its map",
)


def text(about: About, found: Sequence[Observed]) -> str:
    """The whole report."""
    lines = [*_wrapped(_headline(about, found), "")]
    for note in about.notes:
        lines += _wrapped(f"- {note}", "", "  ")
    lines += ["", f"{'vehicle':<16}{'recorded, s':>14}{'LEGAL':>10}{'ILLEGAL':>10}{'UNKNOWN':>10}"]
    for item in found:
        times = "".join(f"{item.seconds(word):>9.1f}s" for word in ("legal", "illegal", "unknown"))
        span = f"{item.start:.1f}-{item.end:.1f}"
        lines.append(f"{item.vehicle + ' ' + item.kind:<16}{span:>14}{times}{'  off the map' if item.unmatched else ''}")
        for broken in item.broken:
            lines += _wrapped(f"ILLEGAL {_told(broken)}", "  ", "          ")
    lines += ["", *_open(found)]
    return "\n".join(lines)


def _headline(about: About, found: Sequence[Observed]) -> str:
    law = f"{about.name}, a model code that binds nobody" if about.model else about.name
    return (
        f"{about.recording}: {about.seconds:.1f} s recorded, {len(found)} vehicles judged by {law}, on {about.start}; "
        f"perception: {about.eye}; interpretation: {about.interpretation}."
    )


def _told(item: Finding) -> str:
    states = ", ".join(dict.fromkeys(state.partition(".")[2].replace("_", " ") for state in item.states))
    force = "" if item.said.force in ("", "absolute") else f" ({item.said.force.replace('_', ' ')})"
    lanes = ", ".join(item.lanes)
    return (
        f"{item.said.citation}{force}: {item.said.because}; {item.start:.1f}-{item.end:.1f} s ({item.seconds:.1f} s), lane {lanes}, "
        f"at ({item.place[0]:.1f}, {item.place[1]:.1f}), {states}"
    )


def _open(found: Sequence[Observed]) -> list[str]:
    """What is not known, rule by rule, with what would settle it; the rules of which it is longest unknown first."""
    rows = open_rules(found)
    if not rows:
        return ["Nothing is unknown."]
    lines = ["Unknown, by rule: vehicles, seconds, and the facts that would settle it."]
    for row in rows[:LISTED]:
        head = f"  {row['citation']:<20}{len(row['vehicles']):>4}{row['seconds']:>8.1f}s  "
        lines += _wrapped(", ".join(row["missing"]) or "-", head, " " * len(head))
    if len(rows) > LISTED:
        lines.append(f"  ... and {len(rows) - LISTED} more rules: observed.json has all of them")
    return lines


def open_rules(found: Iterable[Observed]) -> list[dict[str, Any]]:
    """Citation -> vehicles, seconds and missing facts of what is unknown, longest first."""
    rows: dict[str, dict[str, Any]] = {}
    times: dict[tuple[str, str], list[tuple[float, float]]] = {}
    for vehicle in found:
        for item in vehicle.open:
            row = rows.setdefault(item.said.citation, {"citation": item.said.citation, "vehicles": [], "seconds": 0.0, "missing": []})
            times.setdefault((item.said.citation, vehicle.vehicle), []).append((item.start, item.end))
            row["vehicles"] = list(dict.fromkeys((*row["vehicles"], vehicle.vehicle)))
            row["missing"] = list(dict.fromkeys((*row["missing"], *item.said.missing)))
    for (citation, _), spans in times.items():
        rows[citation]["seconds"] = round(rows[citation]["seconds"] + _covered(spans), 6)
    return sorted(rows.values(), key=lambda row: (-row["seconds"], row["citation"]))


def _covered(spans: Iterable[tuple[float, float]]) -> float:
    """Seconds covered by spans that may overlap: several rules of one section may be open at once."""
    total, until = 0.0, float("-inf")
    for start, end in sorted(spans):
        total += max(end - max(start, until), 0.0)
        until = max(until, end)
    return total


def _wrapped(line: str, head: str, following: str = "") -> list[str]:
    return textwrap.wrap(line, WIDTH, initial_indent=head, subsequent_indent=following or head, break_on_hyphens=False)


def data(about: About, found: Sequence[Observed]) -> dict[str, Any]:
    """Everything, for JSON; times in seconds of the recording, measured values in SI with their unit."""
    return {
        "schema": SCHEMA,
        "recording": about.recording, "seconds": about.seconds, "place": about.place, "model": about.model, "start": about.start,
        "perception": about.eye, "lights": "unknown", "interpretation": about.interpretation, "database": about.database,
        "vehicles": [_vehicle(item) for item in found],
        "unknown": open_rules(found),
    }  # fmt: skip


def _vehicle(item: Observed) -> dict[str, Any]:
    return {
        "id": item.vehicle, "kind": item.kind, "start": _time(item.start), "end": _time(item.end), "off_map": _time(item.unmatched),
        "seconds": {word: _time(item.seconds(word)) for word in ("legal", "illegal", "unknown")},
        "intervals": [
            {"verdict": part.word, "start": _time(part.start), "end": _time(part.end), "states": list(part.states)} for part in item.intervals
        ],
        "broken": [_finding(part) for part in item.broken],
        "unknown": [_finding(part) for part in item.open],
    }  # fmt: skip


def _finding(item: Finding) -> dict[str, Any]:
    said = item.said
    return {
        "rule": said.rule, "citation": said.citation, "force": said.force, "start": _time(item.start), "end": _time(item.end),
        "lanes": list(item.lanes), "x": round(item.place[0], 3), "y": round(item.place[1], 3), "states": list(item.states),
        "measured": said.measured, "bound": said.bound, "unit": said.unit, "because": said.because, "missing": list(said.missing),
    }  # fmt: skip


def _time(seconds: float) -> float:
    return round(seconds, 6) + 0.0
