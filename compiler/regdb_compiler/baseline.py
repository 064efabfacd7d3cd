"""Findings known and put up with for now: a JSON file of fingerprints with counts, which can only shrink."""

import json
from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from regdb_compiler.diagnostics import Diagnostic, Place, RegdbInputError, RuleText, fingerprints, in_order
from regdb_compiler.fixes import write_beside
from regdb_compiler.suppression import can_be_allowed

VERSION = 1
BASELINE_RULES: tuple[RuleText, ...] = (
    ("R903", "stale-baseline-entry", "The baseline holds a finding that no longer occurs."),
    ("R905", "unreadable-baseline", "The baseline file cannot be read."),
)


@dataclass(frozen=True, slots=True)
class Entry:
    """A finding put up with: how often, and what it was when it was written down, for readers."""

    count: int
    code: str
    path: str
    message: str


@dataclass(frozen=True, slots=True)
class Baseline:
    """Entries by fingerprint, and the line of the file on which each stands."""

    path: str
    entries: Mapping[str, Entry]
    lines: Mapping[str, int]


def write(path: Path, diagnostics: Iterable[Diagnostic], sources: Mapping[str, str]) -> int:
    """Write the findings down as known, save for errors of the file itself. Returns how many."""
    known = [finding for finding in diagnostics if can_be_allowed(finding)]
    names = fingerprints(known, sources)
    counts = Counter(names)
    entries = {
        name: {"count": counts[name], "code": d.code, "path": d.place.path, "message": d.message}
        for name, d in zip(names, known, strict=True)
    }
    ordered = dict(sorted(entries.items(), key=lambda item: (str(item[1]["path"]), str(item[1]["code"]), item[0])))
    text = json.dumps({"regdb_baseline": VERSION, "findings": ordered}, indent=1, ensure_ascii=False)
    write_beside(path, text + "\n")
    return len(known)


def read(path: Path) -> Baseline:
    """The baseline of a file. Raises RegdbInputError if it is none."""
    try:
        text = path.read_text("utf-8")
        data = json.loads(text)
        if data["regdb_baseline"] != VERSION:
            raise ValueError(f"it is of version {data['regdb_baseline']}; this is {VERSION}")
        entries = {str(name): _entry(told) for name, told in data["findings"].items()}
    except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        raise RegdbInputError(_unreadable(path, error)) from error
    return Baseline(path.as_posix(), entries, _lines(text, entries))


def apply(baseline: Baseline, diagnostics: Iterable[Diagnostic], sources: Mapping[str, str]) -> tuple[Diagnostic, ...]:
    """The findings that are not known, and one for each known one that no longer occurs as often."""
    left = Counter({name: entry.count for name, entry in baseline.entries.items()})
    findings = tuple(diagnostics)
    kept: list[Diagnostic] = []
    for name, finding in zip(fingerprints(findings, sources), findings, strict=True):
        if left[name] > 0 and can_be_allowed(finding):
            left[name] -= 1
        else:
            kept.append(finding)
    return in_order([*kept, *(_stale(baseline, name, count) for name, count in left.items() if count > 0)])


def _entry(told: Any) -> Entry:
    count = told["count"]
    if not isinstance(count, int) or count < 1:
        raise ValueError(f"the count {count!r} is not a positive number")
    return Entry(count, str(told.get("code", "")), str(told.get("path", "")), str(told.get("message", "")))


def _stale(baseline: Baseline, name: str, count: int) -> Diagnostic:
    entry = baseline.entries[name]
    line = baseline.lines.get(name, 1)
    times = f", {count} of {entry.count} times" if entry.count > 1 else ""
    message = f"{entry.code} in {entry.path} no longer occurs{times}: {entry.message}"
    place = Place(baseline.path, line, 1, line, 1)
    return Diagnostic("R903", "stale-baseline-entry", "info", message, place, help="write the baseline anew")


def _lines(text: str, entries: Mapping[str, Entry]) -> dict[str, int]:
    found: dict[str, int] = {}
    for number, line in enumerate(text.split("\n"), start=1):
        name = line.strip().partition(":")[0].strip('"')
        if name in entries:
            found[name] = number
    return found


def _unreadable(path: Path, error: Exception) -> Diagnostic:
    reason = error.strerror if isinstance(error, OSError) and error.strerror else f"{type(error).__name__}: {error}"
    place = Place(path.as_posix(), 1, 1, 1, 1)
    return Diagnostic("R905", "unreadable-baseline", "error", f"this is not a baseline of regdb: {reason}", place)
