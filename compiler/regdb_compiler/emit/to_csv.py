"""Database -> CSV: the paper's Table I, and the full table; RFC 4180, UTF-8, every cell the exact text.

A cell is never changed to please a spreadsheet: one that begins with `=` stays as the law has it, so open these files as text.
"""

from __future__ import annotations

import csv
import sqlite3
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from regdb.schema import PAPER_COLUMNS
from regdb_compiler.emit.table import COLUMNS, Row

PAPER_FILE, FULL_FILE = "paper.csv", "regulations.csv"


def write_paper_csv(connection: sqlite3.Connection, path: Path) -> None:
    """Table I: the view `paper_table`, its eight columns in the paper's order."""
    chosen = ", ".join(f'"{name}"' for name in PAPER_COLUMNS)
    _write(path, PAPER_COLUMNS, connection.execute(f"SELECT {chosen} FROM paper_table"))


def write_full_csv(lines: Iterable[Row], path: Path) -> None:
    """Every column of `table.COLUMNS`; truth as TRUE and FALSE, lists and objects as JSON, open dates empty."""
    cells = ([_cell(column.kind, value) for column, value in zip(COLUMNS, line, strict=True)] for line in lines)
    _write(path, [column.name for column in COLUMNS], cells)


def _cell(kind: str, value: Any) -> Any:
    if kind == "boolean":
        return "TRUE" if value else "FALSE"
    return "" if value is None else value


def _write(path: Path, names: Sequence[str], lines: Iterable[Sequence[Any]]) -> None:
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\r\n")
        writer.writerow(names)
        writer.writerows(lines)
