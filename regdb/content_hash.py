"""The hash of a database's content: one SHA-256 over every row both sides rely on, however the file lays them out."""

from __future__ import annotations

import hashlib
import json
import sqlite3
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from regdb.schema import MAJOR, SINCE_MINOR, TABLES

_META, _OWN_KEY = "regdb_meta", "content_hash"


@dataclass(frozen=True, slots=True)
class Table:
    """A table read whole, column by column, its rows in the order of the primary key."""

    columns: dict[str, tuple[Any, ...]]

    def __getitem__(self, column: str) -> tuple[Any, ...]:
        """The values of one column. Raises KeyError."""
        return self.columns[column]

    def select(self, *columns: str) -> Iterator[tuple[Any, ...]]:
        """These columns of every row. Raises KeyError for one that is not there."""
        return zip(*[self.columns[column] for column in columns], strict=True)


def read_tables(connection: sqlite3.Connection) -> dict[str, Table]:
    """Every table of the schema that a file of its version has. Raises sqlite3.Error where one is missing or unreadable."""
    minor = connection.execute("PRAGMA user_version").fetchone()[0] % 1000
    return {name: _read(connection, name) for name in TABLES if SINCE_MINOR.get(name, 0) <= minor}


def _read(connection: sqlite3.Connection, name: str) -> Table:
    info = connection.execute(f'PRAGMA table_info("{name}")').fetchall()
    if not info:
        raise sqlite3.DatabaseError(f"no such table: {name}")
    keys = [f'"{column}"' for _, column in sorted((row[5], row[1]) for row in info if row[5])] or ["rowid"]
    names = [row[1] for row in info]
    where = f" WHERE key <> '{_OWN_KEY}'" if name == _META else ""
    chosen = ", ".join(f'"{column}"' for column in names)
    rows = connection.execute(f'SELECT {chosen} FROM "{name}"{where} ORDER BY {", ".join(keys)}').fetchall()
    return Table(dict(zip(names, zip(*rows, strict=True) if rows else [()] * len(names), strict=True)))


def hash_tables(tables: Mapping[str, Table]) -> str:
    """Hex SHA-256 over the major version and every table and column by name: texts joined by NUL, others as JSON with shortest floats.

    The hash itself (in `regdb_meta`) is left out by `read_tables`; search tables, views and indexes are derived and do not count.
    """
    digest = hashlib.sha256(f"regdb {MAJOR * 1000}\n".encode())
    for name, table in tables.items():
        for column, values in table.columns.items():
            kind, content = _content(values)
            digest.update(f"\n{name}.{column} {kind} {len(values)} {len(content)}\n".encode())
            digest.update(content)
    return digest.hexdigest()


def _content(values: tuple[Any, ...]) -> tuple[str, bytes]:
    """A column as bytes that stand for no other column."""
    try:
        joined = "\0".join(values)
        if joined.count("\0") == max(len(values) - 1, 0):
            return "text", joined.encode("utf-8", "surrogatepass")
    except TypeError:
        pass
    return "json", json.dumps(values, ensure_ascii=True, separators=(",", ":")).encode("ascii")


def content_hash(connection: sqlite3.Connection) -> str:
    """The hash of an open database (see `hash_tables`). Raises sqlite3.Error."""
    return hash_tables(read_tables(connection))


def stored_hash(connection: sqlite3.Connection) -> str:
    """The hash the database carries, empty where it carries none. Raises sqlite3.Error."""
    row = connection.execute(f"SELECT value FROM {_META} WHERE key = '{_OWN_KEY}'").fetchone()
    return str(row[0]) if row else ""
