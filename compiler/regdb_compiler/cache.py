"""Compiled databases kept between commands: found again by a hash of everything that went into them."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from regdb.completion import names_file
from regdb.front import FrontError, added_codes
from regdb.schema import APPLICATION_ID, USER_VERSION
from regdb.version import VERSION
from regdb_compiler.emit.in_place import folder_beside, move_in
from regdb_compiler.input_files import all_input_files

if TYPE_CHECKING:
    from regdb_compiler.driver import Build

KEPT = 8
"""Databases kept in the cache; the least recently used go first."""

ERRORS_SHOWN = 5
_HEADER_BYTES = 100


def cached_database(codes: Path, cache: Path) -> Path:
    """The database of a codes folder, compiled into the cache folder unless it is there already.

    Two processes at once may both compile; each moves a whole file in, and the files are equal. Raises FrontError with the
    first errors when the codes have errors, or when the cache cannot be written.
    """
    path = cache / f"{input_hash(codes)[:32]}.sqlite"
    if _is_whole(path):
        _mark_used(path)
        return path
    try:
        _keep_names(_compile(codes, path), names_file(codes, cache))
    except OSError as error:
        raise FrontError(f"the cache {cache} cannot be written: {error.strerror}; set XDG_CACHE_HOME to a folder that can") from error
    _prune(cache, path)
    return path


def input_hash(codes: Path) -> str:
    """Hex SHA-256 of the names and bytes of all input files, the versions of regdb and its schema, and the compiler's own files."""
    digest = hashlib.sha256(f"regdb {VERSION} schema {USER_VERSION}\n".encode())
    for name, path in all_input_files(codes, added_codes()):
        try:
            data = path.read_bytes()
        except OSError as error:
            data = f"unreadable: {error.strerror}".encode()
        digest.update(f"{name}\0{len(data)}\0".encode("utf-8", "surrogateescape") + data)
    for line in _own_files():
        digest.update(line.encode("utf-8", "surrogateescape"))
    return digest.hexdigest()


def _own_files() -> Iterator[str]:
    """Names, sizes and times of the modules that compile, so that a checkout under change never answers from an old compiler."""
    import regdb

    roots = (Path(__file__).parent, Path(regdb.__file__).parent)
    for root in roots:
        for path in sorted([*root.glob("*.py"), *root.glob("*.lark"), *root.glob("emit/*.py"), *root.glob("documents/*.py")]):
            state = path.stat()
            yield f"{path.name} {state.st_size} {state.st_mtime_ns}\n"


def _is_whole(path: Path) -> bool:
    """Whether the file is there, is ours, and as long as its header says."""
    try:
        with path.open("rb") as file:
            head = file.read(_HEADER_BYTES)
        size = path.stat().st_size
    except OSError:
        return False
    pages, page_size = int.from_bytes(head[28:32], "big"), int.from_bytes(head[16:18], "big")
    return len(head) == _HEADER_BYTES and head[68:72] == APPLICATION_ID.to_bytes(4, "big") and size == pages * page_size


def _compile(codes: Path, path: Path) -> Build:
    from regdb_compiler.diagnostics import RegdbInputError
    from regdb_compiler.driver import build
    from regdb_compiler.emit.to_sqlite import write_database
    from regdb_compiler.source import collector_paused

    try:
        with collector_paused():  # what reading has made is still needed when the rows are written
            found = build(codes)
            write_database(found, path)
    except RegdbInputError as error:
        shown = [f"{d.place} {d.code} {d.message}" for d in error.diagnostics[:ERRORS_SHOWN]]
        more = len(error.diagnostics) - len(shown)
        lines = "\n  ".join([*shown, *([f"and {more} more"] if more else [])])
        raise FrontError(f"the codes in {codes} have errors:\n  {lines}\nrun `regdb lint` to see them all") from error
    return found


def _keep_names(build: Build, path: Path) -> None:
    """Leave the names for the shell's completion (see `regdb.completion`)."""
    corpus = build.corpus
    machine = corpus.machine
    names = {
        "regulation": list(dict.fromkeys(rule.id for rule in build.regulations)),
        "section": [section.id for section in corpus.sections],
        "fact": sorted(corpus.vocabulary.facts),
        "attribute": sorted(corpus.vocabulary.attributes),
        "state": sorted(machine.names),
        "jurisdiction": sorted(item.id for item in corpus.tree),
        "topic": sorted({section.doc.topic for section in corpus.sections}),
    }
    with folder_beside(path) as folder:
        file = folder / path.name
        file.write_text(json.dumps(names, separators=(",", ":")), "utf-8")
        move_in(file, path)


def _mark_used(path: Path) -> None:
    try:
        os.utime(path)
    except OSError:
        return  # a cache that may only be read still serves


def _prune(cache: Path, keep: Path) -> None:
    """Drop the least recently used databases and name lists; one that another process has just dropped is no matter."""
    for pattern in ("*.sqlite", "names-*.json"):
        aged = []
        for path in cache.glob(pattern):
            try:
                aged.append((path.stat().st_mtime_ns, path))
            except OSError:
                continue
        for _, path in sorted(aged, reverse=True)[KEPT:]:
            if path != keep:
                path.unlink(missing_ok=True)
