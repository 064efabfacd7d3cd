"""What the shell offers after TAB: ids, facts, states and jurisdictions, from a list that compiling leaves in the cache.

Reads one small file and imports nothing of the compiler, so that an answer takes no longer than starting Python.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from regdb.front import FrontError, cache_folder, codes_folder

KINDS = ("regulation", "section", "fact", "attribute", "state", "jurisdiction", "topic")
"""Kinds of names the list holds."""


def names_file(codes: Path, cache: Path) -> Path:
    """Where the names of a codes folder are kept: one file per folder, whatever its content."""
    return cache / f"names-{hashlib.sha256(str(codes.resolve()).encode('utf-8', 'surrogateescape')).hexdigest()[:32]}.json"


def known_names(codes: Path, cache: Path) -> Mapping[str, tuple[str, ...]]:
    """Kind -> names. Before the first compilation only what file and folder names tell: sections and codes. Never raises."""
    try:
        data = json.loads(names_file(codes, cache).read_text("utf-8"))
        return {kind: tuple(map(str, data.get(kind, ()))) for kind in KINDS}
    except (OSError, ValueError, AttributeError):
        return _from_files(codes)


def _from_files(codes: Path) -> Mapping[str, tuple[str, ...]]:
    files = sorted(codes.glob("*/*.yaml"))
    sections = [f"{path.parent.name}-{path.stem}" for path in files if path.stem[:1].isdigit()]
    folders = {path.parent.name for path in files if path.stem[:1].isdigit()}
    return {"section": tuple(sections), "jurisdiction": tuple(sorted(folders))}


def _offer(ctx: Any, incomplete: str, kinds: Iterable[str]) -> list[str]:
    """Names of these kinds that begin with what is typed; nothing at all where there are no codes."""
    try:
        named = ctx.params.get("codes") if ctx is not None else None
        names = known_names(codes_folder(None if named is None else Path(named)), cache_folder())
    except (FrontError, OSError, RuntimeError):
        return []
    return [name for kind in kinds for name in names.get(kind, ()) if name.startswith(incomplete)]


def regulations(ctx: Any, incomplete: str) -> list[str]:
    """Ids of regulations."""
    return _offer(ctx, incomplete, ("regulation",))


def subjects(ctx: Any, incomplete: str) -> list[str]:
    """Everything `regdb show` shows."""
    return list(dict.fromkeys(_offer(ctx, incomplete, KINDS)))


def jurisdictions(ctx: Any, incomplete: str) -> list[str]:
    """Ids of jurisdictions."""
    return _offer(ctx, incomplete, ("jurisdiction",))


def states(ctx: Any, incomplete: str) -> list[str]:
    """States, super-states and their other names."""
    return _offer(ctx, incomplete, ("state",))


def facts(ctx: Any, incomplete: str) -> list[str]:
    """Facts of the vocabulary."""
    return _offer(ctx, incomplete, ("fact",))
