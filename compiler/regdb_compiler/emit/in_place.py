"""Files that appear whole or not at all: written beside their place under a name of their own, then moved in."""

from __future__ import annotations

import os
import shutil
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

_MARK = ".regdb-"
_FORGOTTEN_AFTER_S = 3600.0
"""What a killed process left beside is swept away by a later one, once nobody can still be writing it."""


@contextmanager
def folder_beside(target: Path) -> Iterator[Path]:
    """An empty folder next to `target` on the same disk, gone afterwards; makes the folder that `target` is to stand in."""
    target.parent.mkdir(parents=True, exist_ok=True)
    _sweep(target.parent)
    folder = Path(tempfile.mkdtemp(prefix=_MARK, dir=target.parent))
    try:
        yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def move_in(file: Path, target: Path) -> None:
    """Put a finished file in its place in one step, after its bytes have reached the disk."""
    with file.open("rb") as stream:
        os.fsync(stream.fileno())
    file.chmod(0o666 & ~_umask())
    file.replace(target)


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask


def _sweep(folder: Path) -> None:
    limit = time.time() - _FORGOTTEN_AFTER_S
    for left in folder.glob(f"{_MARK}*"):
        try:
            if left.is_dir() and left.stat().st_mtime < limit:
                shutil.rmtree(left, ignore_errors=True)
        except OSError:
            continue
