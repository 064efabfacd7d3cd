"""The hash of a database's content: one SHA-256 over every row both sides rely on, however the file lays them out."""

from __future__ import annotations

import hashlib
import json
import sqlite3

from regdb.schema import TABLES, USER_VERSION

_BATCH = 2000
_META, _OWN_KEY = "regdb_meta", "content_hash"


def content_hash(connection: sqlite3.Connection) -> str:
    """Hex SHA-256 of all tables of the schema in the order of their primary keys, `regdb_meta` without the hash itself.

    Search tables, views and indexes are derived and do not count. Raises sqlite3.Error where a table is missing or unreadable.
    """
    digest = hashlib.sha256(f"regdb {USER_VERSION}\n".encode())
    for table in TABLES:
        columns, keys = _columns(connection, table)
        digest.update(_line([table, *columns]))
        where = f" WHERE key <> '{_OWN_KEY}'" if table == _META else ""
        chosen = ", ".join(f'"{column}"' for column in columns)
        cursor = connection.execute(f'SELECT {chosen} FROM "{table}"{where} ORDER BY {", ".join(keys)}')
        while rows := cursor.fetchmany(_BATCH):
            digest.update(_line(rows))
    return digest.hexdigest()


def _columns(connection: sqlite3.Connection, table: str) -> tuple[list[str], list[str]]:
    """Column names in order, and the columns of the primary key as SQL, in its order."""
    info = connection.execute(f'PRAGMA table_info("{table}")').fetchall()
    keys = sorted((row[5], row[1]) for row in info if row[5])
    return [row[1] for row in info], [f'"{name}"' for _, name in keys] or ["rowid"]


def _line(rows: object) -> bytes:
    """JSON in ASCII with shortest floats: the same bytes on every Python and every platform."""
    return json.dumps(rows, ensure_ascii=True, separators=(",", ":")).encode("ascii") + b"\n"
