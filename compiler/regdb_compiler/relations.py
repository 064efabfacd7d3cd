"""Who displaces whom: the tree of exceptions and overrides around a regulation, upwards and downwards."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from regdb_compiler.library import Library

_COLUMNS = "r.id, r.citation, r.jurisdiction, r.legality, r.result, r.authority, r.effective, r.until"


@dataclass(frozen=True, slots=True)
class Link:
    """A regulation in the tree: how it hangs on the one before it (empty at the root), and those that hang on it.

    `seen` says that it has been shown above, with what hangs on it.
    """

    id: str
    kind: str
    citation: str
    jurisdiction: str
    legality: bool
    result: str
    authority: str
    effective: str | None
    until: str | None
    seen: bool = False
    links: tuple[Link, ...] = ()


def displaced_by(library: Library, name: str, day: str) -> Link:
    """What displaces a regulation on a day, and what displaces that, to the end."""
    query = f"""SELECT {_COLUMNS}, t.kind FROM regulation_target t JOIN regulation r ON r.key = t.regulation
                WHERE t.target = :name AND {_in_force('r')} ORDER BY r.key"""
    return _tree(library, query, name, day)


def displaces(library: Library, name: str, day: str) -> Link:
    """What a regulation displaces on a day, and what that displaces."""
    query = f"""SELECT {_COLUMNS}, t.kind FROM regulation_target t JOIN regulation o ON o.key = t.regulation
                JOIN regulation r ON r.id = t.target WHERE o.id = :name AND {_in_force('r')} AND {_in_force('o')}
                ORDER BY t.position, r.key"""
    return _tree(library, query, name, day)


def _in_force(table: str) -> str:
    return f"coalesce({table}.effective, '') <= :day AND ({table}.until IS NULL OR :day < {table}.until)"


def _tree(library: Library, query: str, name: str, day: str) -> Link:
    first = f"SELECT {_COLUMNS}, '' FROM regulation r WHERE id = :name ORDER BY ({_in_force('r')}) DESC, key DESC"
    root = library.connection.execute(first, {"name": name, "day": day}).fetchone()
    return _grown(library, query, root, day, set())


def _grown(library: Library, query: str, row: tuple[Any, ...], day: str, shown: set[str]) -> Link:
    """The link of a row with everything that hangs on it; what was shown before is not shown again."""
    name, citation, jurisdiction, legality, result, authority, effective, until, kind = row
    seen = name in shown
    shown.add(name)
    rows = [] if seen else library.connection.execute(query, {"name": name, "day": day}).fetchall()
    links = tuple(_grown(library, query, item, day, shown) for item in rows if item[2] in library.governing)
    return Link(name, kind, citation, jurisdiction, bool(legality), result, authority, effective, until, seen, links)
