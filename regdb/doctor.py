"""`regdb doctor`: what is installed, which codes and databases are found, and what is missing."""

from __future__ import annotations

import os
import platform
import re
import sqlite3
import sys
import textwrap
from collections.abc import Iterator
from dataclasses import dataclass
from importlib import metadata
from pathlib import Path

from regdb.front import FrontError, added_codes, cache_folder, codes_folder
from regdb.schema import MAJOR, MINOR
from regdb.version import VERSION

OLDEST_PYTHON = (3, 11)
OLDEST_SQLITE = (3, 27)
"""The first with `VACUUM INTO`."""

_REQUIREMENT = re.compile(r"\s*([A-Za-z0-9][A-Za-z0-9._-]*)(?:\[([^\]]*)\])?\s*([^;]*)(?:;(.*))?")
_EXTRA = re.compile(r"extra\s*==\s*['\"]([^'\"]+)['\"]")


@dataclass(frozen=True, slots=True)
class Line:
    """One thing looked at: a name, what was found, and whether it is fine; None is neither fine nor needed."""

    name: str
    found: str
    fine: bool | None = True


def command() -> int:
    """Print one line per thing; 1 if something that is needed is missing."""
    lines = list(examine())
    for line in lines:
        mark = {True: "ok", False: "MISSING", None: "-"}[line.fine]
        told = f"{mark:<8}{line.name:<22}{line.found}"
        sys.stdout.write(textwrap.fill(told, 80, subsequent_indent=" " * 30, break_long_words=False, break_on_hyphens=False) + "\n")
    return 1 if any(line.fine is False for line in lines) else 0


def examine() -> Iterator[Line]:
    """Everything that is looked at, in order."""
    yield Line("regdb", f"{VERSION}, database schema {MAJOR}.{MINOR}")
    yield Line("Python", f"{platform.python_version()} ({sys.executable})", sys.version_info >= OLDEST_PYTHON)
    yield from _sqlite()
    yield from _packages()
    yield _codes()
    yield from _added()
    yield _cache()


def _sqlite() -> Iterator[Line]:
    fine = sqlite3.sqlite_version_info >= OLDEST_SQLITE
    yield Line("SQLite", sqlite3.sqlite_version + ("" if fine else "; at least 3.27 is needed"), fine)
    connection = sqlite3.connect(":memory:")
    try:
        connection.execute("CREATE VIRTUAL TABLE words USING fts5(text)")
        yield Line("SQLite FTS5", "full-text search works")
    except sqlite3.OperationalError as error:
        yield Line("SQLite FTS5", f"{error}; install a Python whose SQLite has FTS5", fine=False)
    finally:
        connection.close()


def _packages() -> Iterator[Line]:
    """The packages regdb always needs one by one; each extra as complete or not."""
    try:
        requirements = metadata.requires("regdb") or []
    except metadata.PackageNotFoundError:
        yield Line("packages", "regdb is not installed as a package; type: pip install -e .", fine=False)
        return
    extras: dict[str, list[str]] = {}
    for text in requirements:
        name, needs, wanted, marker = _read(text)
        if name == "regdb":
            extras.setdefault(marker, []).extend(needs.split(","))
        elif marker:
            extras.setdefault(marker, []).append(name)
        else:
            yield _package(name, wanted)
    for extra, names in extras.items():
        yield _extra(extra, _spelled_out(names, extras))


def _read(text: str) -> tuple[str, str, str, str]:
    """A requirement's name, extras, versions and the extra of ours that it belongs to."""
    match = _REQUIREMENT.match(text)
    name, needs, wanted, marker = match.groups("") if match else (text, "", "", "")
    extra = _EXTRA.search(marker)
    return name, needs, wanted.strip(), extra[1] if extra else ""


def _spelled_out(names: list[str], extras: dict[str, list[str]]) -> list[str]:
    return [package.strip() for name in names for package in extras.get(name.strip(), [name])]


def _package(name: str, wanted: str) -> Line:
    try:
        return Line(name, metadata.version(name))
    except metadata.PackageNotFoundError:
        return Line(name, f"not installed; type: pip install '{name}{wanted}'", fine=False)


def _extra(extra: str, names: list[str]) -> Line:
    missing = []
    for name in names:
        try:
            metadata.version(name)
        except metadata.PackageNotFoundError:
            missing.append(name)
    found = f"lacks {', '.join(missing)}; type: pip install 'regdb[{extra}]'" if missing else "complete"
    return Line(f"extra [{extra}]", found, None if missing else True)


def _codes() -> Line:
    try:
        folder = codes_folder(None)
    except FrontError as error:
        return Line("codes", str(error), fine=False)
    sections = sum(1 for path in folder.glob("*/*.yaml") if path.stem[:1].isdigit())
    fine = (folder / "jurisdictions.yaml").is_file() and sections > 0
    return Line("codes", f"{folder} ({sections} sections)" if fine else f"{folder} holds no codes", fine)


def _added() -> Iterator[Line]:
    """The folders that add to the codes, if there are any."""
    try:
        for folder in added_codes():
            yield Line("codes added", str(folder))
    except FrontError as error:
        yield Line("codes added", str(error), fine=False)


def _cache() -> Line:
    try:
        folder = cache_folder()
        kept = list(folder.glob("*.sqlite"))
        size = sum(path.stat().st_size for path in kept)
    except (OSError, RuntimeError) as error:
        return Line("cache", f"cannot be read: {error}; set XDG_CACHE_HOME", fine=False)
    writable = _is_writable(folder)
    said = f"{folder} ({len(kept)} databases, {size / 1e6:.1f} MB)"
    return Line("cache", said if writable else f"{folder} cannot be written; set XDG_CACHE_HOME", writable)


def _is_writable(folder: Path) -> bool:
    """Whether files can be made in a folder, or the folder itself where it is not there yet."""
    while not folder.exists() and folder != folder.parent:
        folder = folder.parent
    return os.access(folder, os.W_OK)
