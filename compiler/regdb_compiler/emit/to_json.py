"""Database -> `regulations.json`: every regulation version as an object, with the version of this form."""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import Path

from regdb_compiler.emit.table import Row, typed

FILE = "regulations.json"
FORM = "urn:regdb:regulations:1.0"
"""Names this form: the fields of `table.COLUMNS`. Its major changes when a field changes meaning or goes."""


def write_json(lines: Iterable[Row], meta: dict[str, str], path: Path) -> None:
    """`{schema, content_hash, notice, regulations}`; dates ISO or null, lists and objects as such, in the database's order."""
    document = {
        "schema": FORM,
        "content_hash": meta["content_hash"],
        "notice": meta["notice"],
        "licence": meta["licence"],
        "regulations": [typed(line) for line in lines],
    }
    path.write_text(json.dumps(document, indent=1, ensure_ascii=False) + "\n", "utf-8", newline="\n")
