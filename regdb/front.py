"""Where the front door finds codes and databases: the working directory's codes, else the shipped ones."""

from __future__ import annotations

import importlib
import importlib.util
import os
import re
import textwrap
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

CODES_GROUP = "regdb.codes"
"""Entry point group of packages that add jurisdictions: each names a package whose folder holds them."""

ADDED_CODES = "REGDB_ADDED_CODES"
"""Environment variable of folders that add jurisdictions, separated as in PATH."""


class FrontError(Exception):
    """Something a person can put right: a missing extra, a folder that is not there. The message says how."""


WIDTH = 80
"""Columns of everything that commands say."""


def told(message: str) -> str:
    """A message as people read it: lines of at most 80 columns, and paths from the working directory on where they lie in it."""
    near = message.replace(f"{Path.cwd()}{os.sep}", "")
    whole = _TYPED.sub(lambda found: found[0].replace(" ", "\0"), near)
    broken = [textwrap.wrap(line, WIDTH, subsequent_indent="  ", **_WHOLE_WORDS) or [""] for line in whole.split("\n")]
    return "\n".join(part for lines in broken for part in lines).replace("\0", " ")


_TYPED = re.compile(r"`[^`\n]*`|pip install .*")
"""What somebody may copy into a terminal, which stays on one line."""

_WHOLE_WORDS: Any = {"break_long_words": False, "break_on_hyphens": False, "drop_whitespace": True}


def shipped_codes() -> Path:
    """The codes that came with the package: inside it when installed, beside it in a checkout."""
    inside = Path(__file__).parent / "codes"
    return inside if inside.is_dir() else Path(__file__).parents[1] / "codes"


def codes_folder(codes: Path | None) -> Path:
    """The codes a command works on: the ones named, else `codes/` here, else the shipped ones. Raises FrontError."""
    if codes is not None:
        if not codes.is_dir():
            raise FrontError(f"{codes} is no folder of codes; name one with `--codes DIR`")
        return codes
    here = Path("codes")
    return here if (here / "jurisdictions.yaml").is_file() else shipped_codes()


def added_codes(points: Iterable[EntryPoint] | None = None) -> tuple[Path, ...]:
    """Folders that add to whatever codes are read: those ADDED_CODES names, then those of installed packages. Raises FrontError.

    No code of a package is run to find its folder.
    """
    if points is None:
        from importlib.metadata import entry_points

        points = entry_points(group=CODES_GROUP)
    named = [Path(part) for part in os.environ.get(ADDED_CODES, "").split(os.pathsep) if part]
    for folder in named:
        if not folder.is_dir():
            raise FrontError(f"{ADDED_CODES} names {folder}, which is no folder")
    return (*named, *(_package_folder(point) for point in sorted(points, key=lambda item: (item.name, item.value))))


def _package_folder(point: EntryPoint) -> Path:
    try:
        found = importlib.util.find_spec(point.value)
    except (ImportError, ValueError):
        found = None
    folders = [] if found is None else list(found.submodule_search_locations or ())
    if not folders:
        raise FrontError(f"the codes of entry point `{point.name}` cannot be found: {point.value} is no package")
    return Path(folders[0])


def author_side(module: str) -> Any:
    """A module of the compiler, loaded when first needed. Raises FrontError with what to install when it is missing."""
    return _load(f"regdb_compiler.{module}", "compiler")


def vehicle_side(module: str) -> Any:
    """A module of the runtime, loaded when first needed. Raises FrontError with what to install when it is missing."""
    return _load(f"regdb_runtime.{module}", "")


def _load(name: str, extra: str) -> Any:
    try:
        return importlib.import_module(name)
    except ModuleNotFoundError as error:
        if error.name is None or error.name.partition(".")[0].startswith("regdb"):
            raise
        package = f"'regdb[{extra}]'" if extra else "regdb"
        raise FrontError(f"this needs the package {error.name}, which is not installed; type: pip install {package}") from error


def cache_folder() -> Path:
    """Where compiled databases of codes folders are kept between commands."""
    base = os.environ.get("XDG_CACHE_HOME")
    return (Path(base) if base else Path.home() / ".cache") / "regdb"


def database(codes: Path | None = None) -> Path:
    """The database compiled from a codes folder, from the cache when nothing changed since. Raises FrontError when the codes have errors."""
    path: Path = author_side("cache").cached_database(codes_folder(codes), cache_folder())
    return path
