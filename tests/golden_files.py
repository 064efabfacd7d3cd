"""Files for the golden transcripts that are too large, too binary or too broken to stand in one."""

from __future__ import annotations

import sqlite3
from collections.abc import Callable
from contextlib import closing
from pathlib import Path

from regdb_compiler.driver import build
from regdb_compiler.emit.to_sqlite import write_database

LAUGHS = 12
"""Levels of the billion laughs: each names the one before ten times."""


def _deep_nesting(path: Path) -> None:
    """Ten megabytes of opening brackets."""
    path.write_text("section: " + "[" * 10_000_000)


def _nested_lists(path: Path) -> None:
    """Brackets deeper than any law, in a file that is not too large."""
    path.write_text("section: " + "[" * 500_000 + "]" * 500_000 + "\n")


def _five_megabytes(path: Path) -> None:
    path.write_text('section: "1"\ntitle: ' + "x" * 5_000_000 + "\n")


def _billion_laughs(path: Path) -> None:
    lines = ["a0: &a0 [ha, ha, ha, ha, ha, ha, ha, ha, ha, ha]"]
    lines += [f"a{n}: &a{n} [{', '.join([f'*a{n - 1}'] * 10)}]" for n in range(1, LAUGHS)]
    path.write_text("\n".join(lines) + "\n")


def _laughing_scene(path: Path) -> None:
    """A fact whose value would be written out as a terabyte."""
    _billion_laughs(path)
    lines = path.read_text().splitlines()
    path.write_text("scene:\n" + "".join(f"  {line}\n" for line in lines) + f"  signal.color: *a{LAUGHS - 1}\n")


def _nested_scene(path: Path) -> None:
    path.write_text("scene: " + "[" * 100_000)


def _nested_json(path: Path) -> None:
    path.write_text("[" * 100_000)


def _many_parentheses(path: Path) -> None:
    """A section whose condition is three thousand parentheses deep, each with an `and` or an `or` in it."""
    deep = "(sign.stop and (ego.stopped_at_line or " * 1500 + "sign.stop" + "))" * 1500
    path.write_text(path.read_text().replace("when: signal.color == red", f"when: {deep}"))


def _many_nots(path: Path) -> None:
    text = path.read_text().replace("when: signal.color == red", f"when: {'not ' * 20_000}sign.stop")
    path.write_text(text)


def _binary(path: Path) -> None:
    path.write_bytes(bytes(range(256)) * 4)


def _utf_16(path: Path) -> None:
    path.write_bytes('section: "1"\n'.encode("utf-16"))


def _latin_1(path: Path) -> None:
    path.write_bytes(path.read_text().replace("Red light", "Feu rouge allumé").encode("latin-1"))


def _folder(path: Path) -> None:
    path.mkdir(parents=True)


def _empty(path: Path) -> None:
    path.write_bytes(b"")


def _database(path: Path) -> None:
    found = build(path.parent / "codes")
    assert not found.has_errors
    write_database(found, path)


def _truncated_database(path: Path) -> None:
    _database(path)
    data = path.read_bytes()
    path.write_bytes(data[: len(data) // 2])


def _other_database(path: Path) -> None:
    with closing(sqlite3.connect(path)) as connection:
        connection.execute("CREATE TABLE songs (title TEXT)")
        connection.commit()


def _newer_database(path: Path) -> None:
    _database(path)
    with closing(sqlite3.connect(path)) as connection:
        connection.execute("PRAGMA user_version = 99000")
        connection.commit()


def _altered_database(path: Path) -> None:
    """A row changed by hand, so that the content hash no longer fits."""
    _database(path)
    with closing(sqlite3.connect(path)) as connection:
        connection.execute("UPDATE section SET title = 'Green light' WHERE id = 'cvc-100'")
        connection.commit()


RECIPES: dict[str, Callable[[Path], None]] = {
    "deep-nesting": _deep_nesting,
    "nested-lists": _nested_lists,
    "five-megabytes": _five_megabytes,
    "billion-laughs": _billion_laughs,
    "laughing-scene": _laughing_scene,
    "nested-scene": _nested_scene,
    "nested-json": _nested_json,
    "many-parentheses": _many_parentheses,
    "many-nots": _many_nots,
    "binary": _binary,
    "utf-16": _utf_16,
    "latin-1": _latin_1,
    "folder": _folder,
    "empty": _empty,
    "database": _database,
    "truncated-database": _truncated_database,
    "other-database": _other_database,
    "newer-database": _newer_database,
    "altered-database": _altered_database,
}
"""Name of a recipe -> what makes the file at a path."""
