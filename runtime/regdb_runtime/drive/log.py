"""The log of a drive: JSON Lines, one object for the run, one for every tick, one for the end; the same bytes for a seed."""

from __future__ import annotations

import json
import math
import os
import tempfile
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TextIO

from regdb_runtime.errors import LogError

SCHEMA = "regdb-drive/1"
"""Name and version of the form; a reader refuses another one."""
DIGITS = 6
"""Decimals kept of every number: a micrometre, a microsecond."""

Record = dict[str, Any]


@dataclass(frozen=True)
class Log:
    """A drive as it was written: what was run, every tick in order, and how it ended."""

    run: Record
    ticks: tuple[Record, ...]
    end: Record


class LogWriter:
    """Writes records to an open file, one line each."""

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream

    def write(self, record: Mapping[str, Any]) -> None:
        """One plain record (see `plain`) as one line."""
        self._stream.write(line_of(record) + "\n")


def line_of(record: Mapping[str, Any]) -> str:
    """A plain record as its line, without the end of line."""
    return json.dumps(record, ensure_ascii=False, separators=(",", ":"), allow_nan=False)


def plain(value: Any) -> Any:
    """A value as JSON holds it: numbers rounded to DIGITS, sets sorted, numpy's numbers as Python's, infinities as None."""
    kind = value.__class__
    if kind is float:
        return round(value, DIGITS) + 0.0 if math.isfinite(value) else None  # adding zero makes -0.0 and 0.0 the same bytes
    if kind in _AS_THEY_ARE:
        return value
    if kind is dict or isinstance(value, Mapping):
        return {key: plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    if isinstance(value, frozenset | set):
        return sorted(plain(item) for item in value)
    return plain(value.item())  # numpy's


_AS_THEY_ARE = frozenset((str, bool, int, type(None)))


@contextmanager
def writing(path: Path) -> Iterator[LogWriter]:
    """A writer whose file takes its place when all is written; nothing is left behind when something fails. Raises LogError."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(prefix=".regdb-", suffix=".jsonl", dir=path.parent)
    except OSError as error:
        raise LogError(f"{path} cannot be written: {error.strerror}") from error
    beside = Path(name)
    try:
        with os.fdopen(handle, "w", encoding="utf-8", newline="\n") as stream:
            yield LogWriter(stream)
            stream.flush()
            os.fsync(stream.fileno())
        beside.chmod(0o644)
        beside.replace(path)
    finally:
        beside.unlink(missing_ok=True)


def read_log(path: Path) -> Log:
    """A log from its file. Raises LogError when it is none, is cut off, or has another version."""
    try:
        lines = path.read_text("utf-8").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise LogError(f"{path} cannot be read: {getattr(error, 'strerror', None) or 'it is not UTF-8 text'}") from error
    try:
        records = [json.loads(line) for line in lines]
    except json.JSONDecodeError as error:
        raise LogError(f"{path} is no log of a drive: {error.msg}") from error
    return log_of(records, str(path))


def log_of(records: Iterable[Record], name: str = "the log") -> Log:
    """Records in order as a log. Raises LogError when the first, the last or the form is not as it should be."""
    found = list(records)
    if not found or not isinstance(found[0], dict) or found[0].get("kind") != "run":
        raise LogError(f"{name} is no log of a drive: it does not begin with the run")
    if found[0].get("schema") != SCHEMA:
        raise LogError(f"{name} has the form {found[0].get('schema')!r}; this program reads {SCHEMA!r}")
    if found[-1].get("kind") != "end":
        raise LogError(f"{name} is cut off: its last line is not the end of the drive")
    return Log(found[0], tuple(found[1:-1]), found[-1])
