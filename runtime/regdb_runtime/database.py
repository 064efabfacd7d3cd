"""The compiled database on the vehicle's side: opened read-only, checked, everything read once."""

from __future__ import annotations

import gc
import os
import sqlite3
from collections.abc import Iterable, Iterator, Mapping
from contextlib import closing, contextmanager
from dataclasses import dataclass
from datetime import date
from pathlib import Path

from regdb.content_hash import hash_tables, read_tables, stored_hash
from regdb.interpretation import Interpretation
from regdb.jurisdiction import JurisdictionTree
from regdb.regulation import Regulation
from regdb.schema import APPLICATION_ID, MAJOR
from regdb.situation import Scene
from regdb.states import StateMachine
from regdb.vocabulary import Vocabulary
from regdb_runtime.errors import DatabaseDamaged, DatabaseError, NotADatabase, VersionRefused
from regdb_runtime.index.slots import PreparedScene
from regdb_runtime.legality import BITMAPS_BEYOND, Calendar, Day, View
from regdb_runtime.rows import check_defeat, read_interpretations, read_machine, read_meta, read_regulations, read_tree, read_vocabulary

_MAGIC = b"SQLite format 3\x00"
_Stamp = tuple[int, int, int]


@dataclass(frozen=True, slots=True)
class SectionText:
    """A section's words in one dated version, read on demand."""

    citation: str
    title: str
    text: str
    source: str
    effective: str
    until: str | None


class RegulationDatabase:
    """All law of one file. Immutable: a changed file is a new object (`reopen_if_changed`), so no reader sees a mixture."""

    def __init__(
        self, vocabulary: Vocabulary, machine: StateMachine, tree: JurisdictionTree, regulations: Iterable[Regulation],
        meta: Mapping[str, str] | None = None, path: Path | None = None, threshold: int = BITMAPS_BEYOND,
        interpretations: Mapping[str, Interpretation] | None = None,
    ) -> None:  # fmt: skip
        self.vocabulary, self.machine, self.tree = vocabulary, machine, tree
        self.regulations = tuple(regulations)
        self.meta = dict(meta or {})
        self.interpretations = dict(interpretations or {})
        self.path = path
        check_defeat(self.regulations)
        self._stamp: _Stamp | None = None
        self._calendar = Calendar(vocabulary, machine, tree, self.regulations, self.hash, threshold)

    @classmethod
    def open(cls, path: str | os.PathLike[str]) -> RegulationDatabase:
        """Open a compiled database. Raises NotADatabase, VersionRefused or DatabaseDamaged, each with one sentence."""
        file = Path(path)
        stamp = _stamp(file)
        _check_magic(file)
        with _reading(file) as connection, _collector_off():
            _check_identity(connection, file)
            tables = read_tables(connection)
            meta = read_meta(tables) | {"content_hash": stored_hash(connection)}
            if hash_tables(tables) != meta["content_hash"]:
                raise DatabaseDamaged(f"{file} has been altered since it was compiled: its content hash does not match; compile it again")
            vocabulary = read_vocabulary(tables)
            machine, tree = read_machine(tables), read_tree(tables)
            found = cls(vocabulary, machine, tree, read_regulations(tables, vocabulary), meta, file, interpretations=read_interpretations(tables))
        found._stamp = stamp
        return found

    def __repr__(self) -> str:
        return f"RegulationDatabase({str(self.path) if self.path else 'in memory'!r}, {len(self)} regulations, {self.hash[:12]})"

    def __len__(self) -> int:
        return len(self.regulations)

    @property
    def hash(self) -> str:
        """The content hash, empty when the database was not read from a file."""
        return self.meta.get("content_hash", "")

    def at(self, place: str, date: Day) -> View:
        """The law of a jurisdiction (id or code) on a day (date, ISO text or ordinal). Raises RequestError."""
        return self._calendar.at(place, date)

    def prepare(self, scene: Scene) -> PreparedScene:
        """Encode a scene once, for any view of this database."""
        return self._calendar.table.prepare(scene)

    def reopen_if_changed(self) -> RegulationDatabase:
        """This database, or a new one when its file has been replaced since. Raises as `open` does; this one stays usable."""
        if self.path is None or self._stamp == _stamp(self.path):
            return self
        return RegulationDatabase.open(self.path)

    def section_text(self, regulation: Regulation) -> SectionText:
        """The law's words behind a regulation. Raises DatabaseError when the file is gone or another one."""
        if self.path is None:
            raise DatabaseError("this database was made in memory and holds no section texts")
        if self._stamp != _stamp(self.path):
            raise DatabaseError(f"{self.path} has been replaced since it was opened; open it again")
        with _reading(self.path) as connection:
            row = connection.execute(
                "SELECT s.citation, s.title, v.text, s.source_url, v.effective, v.until FROM regulation r "
                "JOIN section_version v ON v.key = r.section_version JOIN section s ON s.id = v.section "
                "WHERE r.id = ? AND r.effective IS ?",
                (regulation.id, None if regulation.effective is None else date.fromordinal(regulation.effective).isoformat()),
            ).fetchone()
        if row is None:
            raise DatabaseError(f"{self.path} has no text for {regulation.id}")
        return SectionText(*row)


def _stamp(path: Path) -> _Stamp:
    """What changes when a file is replaced or rewritten."""
    try:
        found = path.stat()
    except OSError as error:
        raise NotADatabase(f"{path} cannot be read: {error.strerror}") from error
    return found.st_ino, found.st_size, found.st_mtime_ns


def _check_magic(path: Path) -> None:
    try:
        with path.open("rb") as file:
            head = file.read(len(_MAGIC))
    except OSError as error:
        raise NotADatabase(f"{path} cannot be read: {error.strerror}") from error
    if not head:
        raise NotADatabase(f"{path} is empty; compile a database with `regdb compile`")
    if head != _MAGIC:
        raise NotADatabase(f"{path} is not a SQLite file; compile a database with `regdb compile`")


def _check_identity(connection: sqlite3.Connection, path: Path) -> None:
    if connection.execute("PRAGMA application_id").fetchone()[0] != APPLICATION_ID:
        raise NotADatabase(f"{path} is a SQLite file, but not a regulation database")
    major = connection.execute("PRAGMA user_version").fetchone()[0] // 1000
    if major != MAJOR:
        remedy = "compile it again" if major < MAJOR else "update regdb"
        raise VersionRefused(f"{path} has schema version {major}, this runtime reads version {MAJOR}; {remedy}")


@contextmanager
def _reading(path: Path) -> Iterator[sqlite3.Connection]:
    """A read-only connection; whatever SQLite or a row's content objects to becomes DatabaseDamaged."""
    try:
        with closing(sqlite3.connect(f"{path.absolute().as_uri()}?mode=ro&immutable=1", uri=True)) as connection:
            yield connection
    except DatabaseError:
        raise
    except (sqlite3.Error, ValueError, TypeError, KeyError, AttributeError) as error:
        raise DatabaseDamaged(f"{path} is damaged: {error}") from error


@contextmanager
def _collector_off() -> Iterator[None]:
    """Without the garbage collector, which would walk a growing heap of trees again and again."""
    enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if enabled:
            gc.enable()
