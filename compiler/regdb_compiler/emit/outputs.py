"""All outputs of one compilation, written into a folder beside and moved in, the manifest last."""

from __future__ import annotations

import sqlite3
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from regdb_compiler.emit import datapackage, manifest, to_csv, to_json, to_parquet
from regdb_compiler.emit.files import FileRecord, record_of
from regdb_compiler.emit.in_place import folder_beside, move_in
from regdb_compiler.emit.table import read_lines
from regdb_compiler.emit.to_sqlite import Summary, write_database

if TYPE_CHECKING:
    from regdb_compiler.driver import Build

DATABASE = "regulations.sqlite"


@dataclass(frozen=True, slots=True)
class Outputs:
    """The folder, its files in the order written, and the database's summary."""

    folder: Path
    files: tuple[FileRecord, ...]
    database: Summary


def write_outputs(build: Build, folder: Path, on: int | None = None, *, parquet: bool = False) -> Outputs:
    """Write database, CSV, JSON and manifest (and Parquet if asked) into `folder`.

    Raises RegdbInputError when the build has errors and FrontError when Parquet cannot be written; then nothing is changed.
    """
    folder.mkdir(parents=True, exist_ok=True)
    with folder_beside(folder / DATABASE) as beside:
        database = write_database(build, beside / DATABASE, on)
        with closing(sqlite3.connect(f"{database.path.absolute().as_uri()}?mode=ro", uri=True)) as connection:
            files = _write_tables(build, connection, beside, parquet=parquet)
        for file in files:
            move_in(beside / file.name, folder / file.name)
    return Outputs(folder, files, database)


def _write_tables(build: Build, connection: sqlite3.Connection, beside: Path, *, parquet: bool) -> tuple[FileRecord, ...]:
    meta = dict(connection.execute("SELECT key, value FROM regdb_meta"))
    to_csv.write_paper_csv(connection, beside / to_csv.PAPER_FILE)
    lines = read_lines(connection)
    to_csv.write_full_csv(lines, beside / to_csv.FULL_FILE)
    to_json.write_json(lines, meta, beside / to_json.FILE)
    names = [DATABASE, to_csv.PAPER_FILE, to_csv.FULL_FILE, to_json.FILE]
    if parquet:
        to_parquet.write_parquet(lines, beside / to_parquet.FILE)
        names.append(to_parquet.FILE)
    files = [record_of(beside / name) for name in names]
    datapackage.write_datapackage(meta, files, beside / datapackage.FILE)
    files.append(record_of(beside / datapackage.FILE))
    manifest.write_manifest(build, connection, meta, files, beside / manifest.FILE)
    files.append(record_of(beside / manifest.FILE))
    return tuple(files)
