"""Full-text search over a compiled database: the words people type, ranked hits with the passage that matched."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from regdb.schema import SEARCH_COLUMNS, SEARCH_TABLE
from regdb_compiler.library import Library

_WEIGHTS = "10.0, 10.0, 5.0, 4.0, 4.0, 1.0"
"""How much a word in id, citation, title, condition, result and text counts for a hit's rank."""

_SNIPPET_WORDS = 20
_PASSAGES = tuple(SEARCH_COLUMNS.index(name) for name in ("condition", "result", "text"))
_WORD = re.compile(r"\w+")
OPEN, CLOSE = "\x02", "\x03"
"""Mark the words that matched in a passage."""


@dataclass(frozen=True, slots=True)
class Hit:
    """One regulation that matched, best first; `passage` has the matched words between OPEN and CLOSE."""

    id: str
    citation: str
    title: str
    jurisdiction: str
    effective: str | None
    until: str | None
    passage: str


def search(library: Library, words: str, day: str, limit: int) -> tuple[Hit, ...]:
    """Regulations in force on the day with all the words, in any form (turn, turning); else with words that begin so; else with any.

    Whatever is typed is taken as words, never as search syntax.
    """
    typed = _WORD.findall(words)
    if not typed:
        return ()
    quoted = [f'"{word}"' for word in typed]
    for query in (" ".join(quoted), " ".join(f"{word}*" for word in quoted), " OR ".join(f"{word}*" for word in quoted)):
        hits = _ask(library, query, day, limit)
        if hits:
            return hits
    return ()


def _ask(library: Library, query: str, day: str, limit: int) -> tuple[Hit, ...]:
    marks = ", ".join("?" * len(library.governing))
    passages = ", ".join(f"snippet({SEARCH_TABLE}, {at}, '{OPEN}', '{CLOSE}', '...', {_SNIPPET_WORDS})" for at in _PASSAGES)
    rows = library.connection.execute(
        f"SELECT r.id, r.citation, r.title, r.jurisdiction, r.effective, r.until, {passages} "
        f"FROM {SEARCH_TABLE} f JOIN regulation r ON r.key = f.rowid WHERE {SEARCH_TABLE} MATCH ? "
        f"AND coalesce(r.effective, '') <= ? AND (r.until IS NULL OR ? < r.until) AND r.jurisdiction IN ({marks}) "
        f"ORDER BY bm25({SEARCH_TABLE}, {_WEIGHTS}), r.key LIMIT ?",
        (query, day, day, *sorted(library.governing), limit),
    )
    return tuple(_hit(row) for row in rows)


def _hit(row: tuple[Any, ...]) -> Hit:
    name, citation, title, jurisdiction, effective, until, *passages = row
    return Hit(name, citation, title, jurisdiction, effective, until, _telling(passages))


def _telling(passages: Sequence[str]) -> str:
    """The first passage with a word that matched; where only id, citation or title matched, the condition."""
    return next((passage for passage in passages if OPEN in passage), passages[0])
