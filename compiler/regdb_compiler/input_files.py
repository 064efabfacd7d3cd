"""Which files of a codes folder go into what is compiled from it."""

from collections.abc import Iterable, Iterator
from pathlib import Path


def input_files(codes: Path) -> Iterator[tuple[str, Path]]:
    """Every YAML file of a codes folder with its name in it, in order of the names; hidden ones are no input."""
    found = sorted((path.relative_to(codes).as_posix(), path) for path in codes.rglob("*.yaml"))
    return ((name, path) for name, path in found if not any(part.startswith(".") for part in name.split("/")))


def all_input_files(codes: Path, added: Iterable[Path]) -> Iterator[tuple[str, Path]]:
    """The files of the codes, then those of the folders added to them, whose names begin with their folder's."""
    yield from input_files(codes)
    for folder in added:
        yield from ((f"{folder.resolve().name}/{name}", path) for name, path in input_files(folder))
