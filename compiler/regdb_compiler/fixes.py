"""Fixes applied to text, each whole or not at all, and files replaced in one step."""

import os
import tempfile
from bisect import bisect_left
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
    spans = sorted(_spans(Lines("", text), edits))
    if any(_overlap(one, other) for one, other in pairwise(spans)):
        raise ValueError("edits overlap")
    return _edited(text, spans)


def apply_fixes(diagnostics: Iterable[Diagnostic], sources: Mapping[str, str], kinds: Collection[FixKind] = SAFE) -> Fixed:
    """Make the fixes of these kinds; `legal` ones never, as only a person may change the law's meaning.

    Of two fixes that overlap the first by place is made, and the other is reported as skipped.
    """
    lines = {path: Lines(path, text) for path, text in sources.items()}
    taken: dict[str, list[Span]] = defaultdict(list)
    applied: list[Diagnostic] = []
    skipped: list[Diagnostic] = []
    for finding in in_order(diagnostics):
        if finding.fix is None or finding.fix.kind not in kinds or finding.fix.kind == "legal":
            continue
        wanted = _wanted(finding.fix, lines)
        if wanted is None or any(_clashes(spans, taken[path]) for path, spans in wanted.items()):
            skipped.append(finding)
            continue
        applied.append(finding)
        for path, spans in wanted.items():
            _take(taken[path], spans)
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


def _spans(lines: Lines, edits: Iterable[Edit]) -> set[Span]:
    return {(lines.offset(e.place.line, e.place.column), lines.offset(e.place.end_line, e.place.end_column), e.text) for e in edits}


def _overlap(one: Span, other: Span) -> bool:
    """Whether two edits touch the same characters, or insert at the same place, where the order would be chance."""
    if one[0] == other[0]:
        return True
    first, second = sorted((one, other))
    return second[0] < first[1]


def _clashes(wanted: set[Span], taken: list[Span]) -> bool:
    """Whether a span overlaps one taken before; only neighbours can. The very same edit, wanted twice, is no clash."""
    for span in wanted:
        at = bisect_left(taken, span)
        near = taken[max(at - 1, 0) : at + 1]
        if span not in near and any(_overlap(span, other) for other in near):
            return True
    return False


def _take(taken: list[Span], spans: set[Span]) -> None:
    """Put spans that clash with none into the sorted list, each once."""
    for span in spans:
        at = bisect_left(taken, span)
        if taken[at : at + 1] != [span]:
            taken.insert(at, span)


def _wanted(fix: Fix, lines: Mapping[str, Lines]) -> dict[str, set[Span]] | None:
    """A fix's edits by file; None if it overlaps itself or speaks of a file whose text is not at hand."""
    by_path: dict[str, list[Edit]] = defaultdict(list)
    for edit in fix.edits:
        by_path[edit.place.path].append(edit)
    if not by_path or not by_path.keys() <= lines.keys():
        return None
    wanted = {path: _spans(lines[path], edits) for path, edits in by_path.items()}
    if any(_overlap(one, other) for spans in wanted.values() for one, other in pairwise(sorted(spans))):
        return None
    return wanted


def _changed(sources: Mapping[str, str], taken: Mapping[str, list[Span]]) -> dict[str, str]:
    texts = {path: _edited(sources[path], spans) for path, spans in sorted(taken.items())}
    return {path: text for path, text in texts.items() if text != sources[path]}


def _edited(text: str, spans: Iterable[Span]) -> str:
    """The text with sorted spans put in."""
    parts, at = [], 0
    for start, end, new in spans:
        parts += [text[at:start], new]
        at = end
    return "".join([*parts, text[at:]])
