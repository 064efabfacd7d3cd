"""`manifest.json`: what went in, what came out, how the regulations relate, what was warned of. No times, no absolute paths."""

from __future__ import annotations

import json
import sqlite3
from collections import Counter
from collections.abc import Iterable
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from regdb_compiler.diagnostics import Diagnostic
from regdb_compiler.emit.files import FileRecord, record_of
from regdb_compiler.input_files import all_input_files

if TYPE_CHECKING:
    from regdb_compiler.driver import Build

FILE = "manifest.json"
FORM = "urn:regdb:manifest:1.0"


def write_manifest(
    build: Build, connection: sqlite3.Connection, meta: dict[str, str], outputs: Iterable[FileRecord], path: Path
) -> None:
    """Everything about one compilation; input names are relative to the codes folder (of a folder added to the codes they begin
    with its name), output names to the manifest."""
    document = {
        "schema": FORM,
        "regdb_version": meta["regdb_version"],
        "schema_version": meta["schema_version"],
        "content_hash": meta["content_hash"],
        "in_force_on": meta.get("in_force_on"),
        "notice": meta["notice"],
        "inputs": [asdict(record_of(file, name)) for name, file in all_input_files(build.corpus.root, build.corpus.added)],
        "outputs": [asdict(item) for item in outputs],
        "counts": _counts(build, connection, meta),
        "confidence": dict(sorted(Counter(item.doc.source.confidence for item in build.corpus.sections).items())),
        "relations": _relations(connection),
        "warnings": [_finding(item) for item in build.diagnostics],
    }
    path.write_text(json.dumps(document, indent=1, ensure_ascii=False) + "\n", "utf-8", newline="\n")


def _counts(build: Build, connection: sqlite3.Connection, meta: dict[str, str]) -> dict[str, dict[str, int]]:
    """Code -> rows of the database, and the law's own tests and cases."""
    found: dict[str, dict[str, int]] = json.loads(meta["codes"])
    tests = Counter(entry.jurisdiction.code for entry in build.corpus.regulations for _ in entry.doc.tests)
    cases = Counter(case.jurisdiction.code for case in build.corpus.cases)
    for code, item in found.items():
        for table in ("definition", "delegation"):
            query = f"""SELECT count(*) FROM {table} d JOIN section_version v ON v.key = d.section_version
                        JOIN section s ON s.id = v.section JOIN jurisdiction j ON j.id = s.jurisdiction WHERE j.code = ?"""
            item[f"{table}s"] = connection.execute(query, (code,)).fetchone()[0]
        item |= {"tests": tests[code], "cases": cases[code]}
    return found


def _relations(connection: sqlite3.Connection) -> list[dict[str, Any]]:
    """Every displacement: which regulation displaces which, by what word and on what authority, between which days."""
    names = ("regulation", "kind", "target", "authority", "effective", "until")
    rows = connection.execute(
        "SELECT r.id, t.kind, t.target, r.authority, r.effective, r.until FROM regulation_target t "
        "JOIN regulation r ON r.key = t.regulation ORDER BY r.key, t.position"
    )
    return [dict(zip(names, row, strict=True)) for row in rows]


def _finding(item: Diagnostic) -> dict[str, Any]:
    place = item.place
    return {
        "code": item.code, "name": item.name, "level": item.level, "message": item.message,
        "path": place.path, "line": place.line, "column": place.column,
    }  # fmt: skip
