"""Fixes applied to text, each whole or not at all, and files replaced in one step."""

import os
import tempfile
from collections import defaultdict
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

from regdb_compiler.diagnostics import Diagnostic, Edit, Fix, FixKind, in_order
from regdb_compiler.tree import Lines

SAFE: tuple[FixKind, ...] = ("safe",)
Span = tuple[int, int, str]
"""Start and end offset in the old text, and the new text between them."""


@dataclass(frozen=True, slots=True)
class Fixed:
    """New texts of the files that change, the findings whose fixes are in them, and those passed over for overlap."""

    texts: Mapping[str, str]
    applied: tuple[Diagnostic, ...]
    skipped: tuple[Diagnostic, ...]


def apply_edits(text: str, edits: Iterable[Edit]) -> str:
    """The text with all edits made. Raises ValueError if two of them overlap."""
    spans = sorted(set(_spans(text, edits)))
    if any(_overlap(one, other) for one, other in pairwise(spans)):
        raise ValueError("edits overlap")
    for start, end, new in reversed(spans):
        text = text[:start] + new + text[end:]
    return text


def apply_fixes(diagnostics: Iterable[Diagnostic], sources: Mapping[str, str], kinds: Collection[FixKind] = SAFE) -> Fixed:
    """Make the fixes of these kinds; `legal` ones never, as only a person may change the law's meaning.

    Of two fixes that overlap the first by place is made, and the other is reported as skipped.
    """
    taken: dict[str, set[Span]] = defaultdict(set)
    applied: list[Diagnostic] = []
    skipped: list[Diagnostic] = []
    for finding in in_order(diagnostics):
        if finding.fix is None or finding.fix.kind not in kinds or finding.fix.kind == "legal":
            continue
        wanted = _wanted(finding.fix, sources)
        if wanted is None or any(_clashes(spans, taken[path]) for path, spans in wanted.items()):
            skipped.append(finding)
            continue
        applied.append(finding)
        for path, spans in wanted.items():
            taken[path] |= spans
    return Fixed(_changed(sources, taken), tuple(applied), tuple(skipped))


def write_beside(path: Path, text: str) -> None:
    """Replace a file in one step: whoever reads it sees the old text or the new, and a crash leaves the old."""
    path = path.resolve()
    handle, name = tempfile.mkstemp(prefix=f".{path.name}.", suffix=".new", dir=path.parent)
    try:
        with os.fdopen(handle, "w", encoding="utf-8", newline="") as file:
            file.write(text)
            file.flush()
            os.fsync(file.fileno())
        Path(name).chmod(path.stat().st_mode & 0o7777 if path.exists() else 0o644)
        Path(name).replace(path)
    except BaseException:
        Path(name).unlink(missing_ok=True)
        raise


def _spans(text: str, edits: Iterable[Edit]) -> list[Span]:
    lines = Lines("", text)
    return [(lines.offset(e.place.line, e.place.column), lines.offset(e.place.end_line, e.place.end_column), e.text) for e in edits]


def _overlap(one: Span, other: Span) -> bool:
    """Whether two edits touch the same characters, or insert at the same place, where the order would be chance."""
    if one[0] == other[0]:
        return True
    first, second = sorted((one, other))
    return second[0] < first[1]


def _clashes(wanted: set[Span], taken: set[Span]) -> bool:
    """The very same edit, asked for by two findings, is no clash."""
    return any(_overlap(one, other) for one in wanted - taken for other in taken)


def _wanted(fix: Fix, sources: Mapping[str, str]) -> dict[str, set[Span]] | None:
    """A fix's edits by file; None if it overlaps itself or speaks of a file whose text is not at hand."""
    by_path: dict[str, list[Edit]] = defaultdict(list)
    for edit in fix.edits:
        by_path[edit.place.path].append(edit)
    if not by_path or not by_path.keys() <= sources.keys():
        return None
    wanted = {path: set(_spans(sources[path], edits)) for path, edits in by_path.items()}
    for spans in wanted.values():
        ordered = sorted(spans)
        if any(_overlap(one, other) for one, other in pairwise(ordered)):
            return None
    return wanted


def _changed(sources: Mapping[str, str], taken: Mapping[str, set[Span]]) -> dict[str, str]:
    texts: dict[str, str] = {}
    for path, spans in sorted(taken.items()):
        text = sources[path]
        for start, end, new in sorted(spans, reverse=True):
            text = text[:start] + new + text[end:]
        if text != sources[path]:
            texts[path] = text
    return texts
