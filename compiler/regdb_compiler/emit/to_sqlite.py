"""Build -> the SQLite file: every table, index, view and the full-text index of `regdb.schema`, the same bytes each time.

Rows go in by executemany in one transaction, indexes after them. sqlite-utils is not used here: its import alone takes 0.15 s
(0.65 s where pandas is installed), more than all of this for 1,000 regulations, and each of its calls would replace one statement.
"""

from __future__ import annotations

import sqlite3
from collections.abc import Mapping
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from regdb.content_hash import content_hash
from regdb.schema import APPLICATION_ID, INDEXES, SEARCH_COLUMNS, SEARCH_TABLE, TABLES, USER_VERSION, VIEWS
from regdb_compiler.diagnostics import RegdbInputError
from regdb_compiler.emit.in_place import folder_beside, move_in
from regdb_compiler.emit.interpretation_rows import interpretation_rows
from regdb_compiler.emit.language_rows import language_rows
from regdb_compiler.emit.law_rows import law_rows
from regdb_compiler.emit.meta import meta_rows
from regdb_compiler.emit.rows import Day, Tables

if TYPE_CHECKING:
    from regdb_compiler.driver import Build

PAGE_SIZE = 4096
"""Bytes per page, fixed so that a file does not depend on how SQLite was built."""


@dataclass(frozen=True, slots=True)
class Summary:
    """What was written: where, how many bytes, rows per table, and the content hash."""

    path: Path
    size: int
    rows: Mapping[str, int]
    content_hash: str


def write_database(build: Build, path: Path, on: int | None = None) -> Summary:
    """Write the database beside `path`, check it, and move it into place; `on` is a day number to narrow the law to.

    Raises RegdbInputError with the errors of a build that has some; then, as after any other failure, `path` is as it was.
    """
    errors = [item for item in build.diagnostics if item.level == "error"]
    if errors:
        raise RegdbInputError(*errors)
    tables = collect(build, Day(on))
    with folder_beside(path) as folder:
        file = folder / path.name
        digest = write_tables(tables, file)
        size = file.stat().st_size
        move_in(file, path)
    return Summary(path, size, {name: len(lines) for name, lines in tables.items()}, digest)


def collect(build: Build, day: Day | None = None) -> Tables:
    """The rows of every table, without the content hash, which only the finished tables have."""
    corpus, day = build.corpus, day or Day()
    tables: Tables = {**language_rows(corpus.tree, corpus.machine, corpus.vocabulary), **law_rows(build, day)}
    tables.update(interpretation_rows(corpus.interpretations))
    tables["regdb_meta"] = meta_rows(build, tables, day)
    return {name: tables[name] for name in TABLES}


def write_tables(tables: Tables, file: Path) -> str:
    """Write a new database file from rows; its content hash. Raises sqlite3.Error for rows the schema refuses."""
    with closing(sqlite3.connect(":memory:", isolation_level=None)) as connection:
        _open(connection)
        connection.execute("BEGIN")
        for name, lines in tables.items():
            _fill(connection, name, lines)
        for name, columns in INDEXES.items():
            connection.execute(f"CREATE INDEX {name} ON {columns}")
        for name, query in VIEWS.items():
            connection.execute(f"CREATE VIEW {name} AS {query.strip()}")
        _index_words(connection)
        digest = content_hash(connection)
        connection.execute("INSERT INTO regdb_meta VALUES ('content_hash', ?)", (digest,))
        connection.execute("COMMIT")
        _check(connection)
        connection.execute("VACUUM INTO ?", (str(file),))
    return digest


def _open(connection: sqlite3.Connection) -> None:
    """The file's identity and layout, before there is anything in it."""
    for pragma, value in (
        ("page_size", PAGE_SIZE), ("auto_vacuum", 0), ("encoding", "'UTF-8'"), ("foreign_keys", 1),
        ("application_id", APPLICATION_ID), ("user_version", USER_VERSION),
    ):  # fmt: skip
        connection.execute(f"PRAGMA {pragma} = {value}")


def _fill(connection: sqlite3.Connection, name: str, lines: list[tuple[str | int | float | None, ...]]) -> None:
    connection.execute(f"CREATE TABLE {name} (\n  " + ",\n  ".join(TABLES[name]) + "\n)")
    if lines:
        marks = ", ".join("?" * len(lines[0]))
        connection.executemany(f"INSERT INTO {name} VALUES ({marks})", lines)


def _index_words(connection: sqlite3.Connection) -> None:
    """The full-text index over the words of every regulation; merged into one segment, whose bytes depend on the words alone."""
    columns = ", ".join(SEARCH_COLUMNS)
    connection.execute(
        f"CREATE VIRTUAL TABLE {SEARCH_TABLE} USING fts5({columns}, content='search_source', content_rowid='key', "
        "tokenize='porter unicode61')"
    )
    connection.execute(f"INSERT INTO {SEARCH_TABLE} (rowid, {columns}) SELECT key, {columns} FROM search_source ORDER BY key")
    connection.execute(f"INSERT INTO {SEARCH_TABLE} ({SEARCH_TABLE}) VALUES ('optimize')")


def _check(connection: sqlite3.Connection) -> None:
    """Refuse a database whose rows name rows that are not there."""
    broken = connection.execute("PRAGMA foreign_key_check").fetchall()
    if broken:
        table, row, parent, _ = broken[0]
        raise sqlite3.IntegrityError(f"{len(broken)} rows name what is not there; the first: row {row} of {table} names no {parent}")
