"""What a database says of itself: versions, sources, licence, counts; nothing that differs between two builds of the same law."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from regdb.schema import LICENCE, MAJOR, MINOR, NOTICE
from regdb.version import VERSION
from regdb_compiler.emit.rows import Day, Line, Tables, compact, iso

if TYPE_CHECKING:
    from regdb_compiler.driver import Build

SCHEMA_VERSION = f"{MAJOR}.{MINOR}"


def meta_rows(build: Build, tables: Tables, day: Day) -> list[Line]:
    """Key and value of every entry but the content hash, in order. `in_force_on` is there in a database narrowed to a day."""
    found: dict[str, str] = {
        "schema_version": SCHEMA_VERSION,
        "regdb_version": VERSION,
        "sources": compact(sources_of(build)),
        "licence": LICENCE,
        "notice": NOTICE,
        "codes": compact(counts_by_code(build, tables)),
        "regulations": str(len(tables["regulation"])),
    }
    narrowed = iso(day.number)
    if narrowed is not None:
        found["in_force_on"] = narrowed
    return sorted(found.items())


def sources_of(build: Build) -> dict[str, dict[str, str]]:
    """Code -> where it is published, and the newest day on which a section of it was checked."""
    newest: dict[str, str] = {}
    for section in build.corpus.sections:
        code, checked = section.jurisdiction.code, section.doc.source.checked.isoformat()
        newest[code] = max(newest.get(code, ""), checked)
    return {
        item.code: {"jurisdiction": item.name, "source": item.source, "checked": newest[item.code]}
        for item in sorted(build.corpus.tree, key=lambda item: item.code)
        if item.code in newest
    }


def counts_by_code(build: Build, tables: Tables) -> dict[str, dict[str, int]]:
    """Code -> how many sections and regulation rows of it are in the tables."""
    codes = {item.id: item.code for item in build.corpus.tree}
    found: dict[str, dict[str, int]] = {}
    for table, place in (("section", 1), ("regulation", 3)):
        for line in tables[table]:
            counted: Any = found.setdefault(codes[str(line[place])], {"section": 0, "regulation": 0})
            counted[table] += 1
    return {code: {"sections": item["section"], "regulations": item["regulation"]} for code, item in sorted(found.items())}
