"""Fixes made on a codes folder, round by round, without touching the files: what would change, and the difference as text."""

from __future__ import annotations

import difflib
import shutil
import tempfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from regdb_compiler.diagnostics import Diagnostic, FixKind
from regdb_compiler.driver import Build, build
from regdb_compiler.fixes import apply_fixes

ROUNDS = 5
"""One fix may uncover another, or overlap one; more rounds than this would mean that two fixes undo each other."""


@dataclass(frozen=True)
class Mended:
    """Path -> new text of the files that change, their old texts, and how many fixes were made and passed over."""

    texts: Mapping[str, str] = field(default_factory=dict)
    before: Mapping[str, str] = field(default_factory=dict)
    applied: int = 0
    skipped: int = 0


def mend(codes: Path, findings: Callable[[Build], tuple[Diagnostic, ...]], kinds: tuple[FixKind, ...]) -> Mended:
    """The texts after all fixes of these kinds; the folder itself stays as it is. Folders added to the codes are not mended."""
    found = build(codes)
    before = found.corpus.texts
    result = apply_fixes(_own(findings(found), found), before, kinds)
    texts, applied, skipped = dict(result.texts), len(result.applied), len(result.skipped)
    if not texts:
        return Mended(skipped=skipped)
    with tempfile.TemporaryDirectory(prefix="regdb-") as folder:
        copy = Path(folder) / codes.resolve().name
        shutil.copytree(codes, copy)
        for _ in range(ROUNDS):
            for path, text in result.texts.items():
                (copy.parent / path).write_text(text, "utf-8", newline="")
            found = build(copy)
            result = apply_fixes(_own(findings(found), found), found.corpus.texts, kinds)
            if not result.texts:
                break
            texts.update(result.texts)
            applied += len(result.applied)
    return Mended({path: text for path, text in texts.items() if text != before[path]}, before, applied, skipped)


def _own(findings: tuple[Diagnostic, ...], found: Build) -> tuple[Diagnostic, ...]:
    return tuple(item for item in findings if item.place.path.startswith(f"{found.corpus.root.name}/"))


def unified_diff(mended: Mended) -> str:
    """What would change, as `diff -u` shows it."""
    parts: list[str] = []
    for path, text in sorted(mended.texts.items()):
        old, new = mended.before[path].splitlines(keepends=True), text.splitlines(keepends=True)
        lines = difflib.unified_diff(old, new, f"a/{path}", f"b/{path}")
        parts += [line if line.endswith("\n") else f"{line}\n\\ No newline at end of file\n" for line in lines]
    return "".join(parts)
