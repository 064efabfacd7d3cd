"""Database -> `regulations.parquet`, only on request: the full table with truth, numbers and dates as such."""

from __future__ import annotations

import datetime
import importlib
from pathlib import Path

from regdb.front import FrontError
from regdb_compiler.emit.table import COLUMNS, Row

FILE = "regulations.parquet"
NEEDED = "Parquet needs {}, which is not installed; type: pip install 'regdb[compiler]'"


def write_parquet(lines: list[Row], path: Path) -> None:
    """The columns of `table.COLUMNS`, lists and objects as JSON text. Raises FrontError when pandas or pyarrow is missing."""
    try:
        import pandas as pd
        importlib.import_module("pyarrow")  # pandas would name its own package in its message
    except ImportError as error:
        raise FrontError(NEEDED.format(error.name or "pyarrow")) from error
    frame = pd.DataFrame(lines, columns=[column.name for column in COLUMNS])
    for column in COLUMNS:
        if column.kind == "boolean":
            frame[column.name] = frame[column.name].astype(bool)
        elif column.kind == "date":
            frame[column.name] = [datetime.date.fromisoformat(text) if isinstance(text, str) else None for text in frame[column.name]]
    frame.to_parquet(path, engine="pyarrow", index=False)
