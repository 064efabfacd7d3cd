"""The CSV files' metadata after Frictionless: every field with its type and meaning, the licence, the sources."""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from regdb.schema import PAPER_COLUMNS
from regdb_compiler.emit.files import FileRecord
from regdb_compiler.emit.table import COLUMNS, Column
from regdb_compiler.emit.to_csv import FULL_FILE, PAPER_FILE

FILE = "datapackage.json"
_PAPER_MEANINGS = (
    "The section's rule in our own words.", "The condition in words.", "What then follows.",
    "FALSE: unlawful while the condition holds; TRUE: a permission.", "Kind of road the rule is about, as annotated.",
    "Highest speed with its unit, as annotated.", "States from which the transitions start; a super-state's name stands for all its states.",
    "States to which the transitions lead; a super-state's name stands for all its states.",
)  # fmt: skip
_DIALECT = {"delimiter": ",", "lineTerminator": "\r\n", "quoteChar": '"', "doubleQuote": True, "header": True}


def write_datapackage(meta: dict[str, str], files: Iterable[FileRecord], path: Path) -> None:
    """Describe the two CSV files; `meta` is what the database says of itself, `files` what was written."""
    written = {file.name: file for file in files}
    paper = [_paper_field(name, text) for name, text in zip(PAPER_COLUMNS, _PAPER_MEANINGS, strict=True)]
    full = [_field(column) for column in COLUMNS]
    sources = json.loads(meta["sources"])
    package = {
        "profile": "tabular-data-package",
        "name": "regdb",
        "title": "Traffic regulations as annotated rules",
        "description": meta["notice"],
        "version": meta["regdb_version"],
        "licenses": [{"name": meta["licence"]}],
        "sources": [{"title": item["jurisdiction"], "path": item["source"]} for item in sources.values()],
        "resources": [_resource(written[PAPER_FILE], paper), _resource(written[FULL_FILE], full, key=["id", "effective"])],
    }
    path.write_text(json.dumps(package, indent=2, ensure_ascii=False) + "\n", "utf-8", newline="\n")


def _resource(file: FileRecord, fields: list[dict[str, Any]], key: list[str] | None = None) -> dict[str, Any]:
    schema: dict[str, Any] = {"fields": fields, "missingValues": [""]}
    if key:
        schema["primaryKey"] = key
    return {
        "profile": "tabular-data-resource", "name": Path(file.name).stem, "path": file.name, "format": "csv", "mediatype": "text/csv",
        "encoding": "utf-8", "bytes": file.size, "hash": f"sha256:{file.sha256}", "dialect": _DIALECT, "schema": schema,
    }  # fmt: skip


def _paper_field(name: str, meaning: str) -> dict[str, Any]:
    return _field(Column(name, "", "boolean" if name == "Legality" else "string", meaning))


def _field(column: Column) -> dict[str, Any]:
    found: dict[str, Any] = {"name": column.name, "type": column.kind, "description": column.meaning}
    if column.kind == "boolean":
        found |= {"trueValues": ["TRUE"], "falseValues": ["FALSE"]}
    return found
