"""A written file as its manifest knows it: name, size, hash."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True, slots=True)
class FileRecord:
    """A file by its name, its size in bytes and the hex SHA-256 of its bytes."""

    name: str
    size: int
    sha256: str


def record_of(path: Path, name: str = "") -> FileRecord:
    """A file as it is on disk, under its own name or the one given. Raises OSError."""
    data = path.read_bytes()
    return FileRecord(name or path.name, len(data), hashlib.sha256(data).hexdigest())
