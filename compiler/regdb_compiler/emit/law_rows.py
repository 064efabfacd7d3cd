"""The law's rows: sections with their dated versions, definitions, delegations, and every regulation with what hangs on it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from functools import lru_cache
from typing import TYPE_CHECKING

from regdb.citation import section_key
from regdb.condition import TRUE
from regdb.condition_text import linear_to_data, to_json
from regdb.regulation import Limit
from regdb.units import from_si
from regdb_compiler.emit.rows import Day, Line, Tables, compact, iso
from regdb_compiler.entries import SectionEntry, VersionEntry
from regdb_compiler.lower import Row

if TYPE_CHECKING:
    from regdb_compiler.driver import Build


def law_rows(build: Build, day: Day) -> Tables:
    """Rows of the eight tables that hold the law, in order of citation and date, narrowed to a day if one is given."""
    rows = [row for row in build.rows if day.keeps(row.regulation.effective, row.regulation.until)]
    sections = sorted(build.corpus.sections, key=lambda item: (item.jurisdiction.id, section_key(item.doc.section)))
    versions = [item for section in sections for item in _versions(section) if day.keeps(item.effective, item.until)]
    kept = {item.section for item in versions}
    keys = {item: key for key, item in enumerate(versions, 1)}
    return {
        "section": [_section(item) for item in sections if item in kept],
        "section_version": [_version(item, keys[item]) for item in versions],
        "definition": _numbered(_definitions(build, versions, keys)),
        "delegation": _numbered(_delegations(versions, keys)),
        "regulation": [_regulation(row, key, keys[row.entry.version]) for key, row in enumerate(rows, 1)],
        "regulation_limit": [line for key, row in enumerate(rows, 1) for line in _limits(row.regulation.limits, key)],
        "regulation_state": [line for key, row in enumerate(rows, 1) for line in _state_ids(row, key)],
        "regulation_target": [
            (key, position, target, kind) for key, row in enumerate(rows, 1) for position, (target, kind) in enumerate(row.kinds)
        ],
    }


def _versions(section: SectionEntry) -> list[VersionEntry]:
    return sorted(section.versions, key=lambda item: item.effective)


def _numbered(lines: Iterable[Line]) -> list[Line]:
    return [(key, *line) for key, line in enumerate(lines, 1)]


def _section(item: SectionEntry) -> Line:
    doc, source = item.doc, item.doc.source
    return (
        item.id, item.jurisdiction.id, doc.section, str(item.citation), doc.title, compact(doc.location), doc.topic, source.url,
        compact(source.also), source.checked.isoformat(), source.confidence, source.note,
    )  # fmt: skip


def _version(item: VersionEntry, key: int) -> Line:
    doc = item.doc
    return key, item.section.id, doc.effective.isoformat(), iso(item.until), doc.enacted_by, doc.text


def _definitions(build: Build, versions: Iterable[VersionEntry], keys: Mapping[VersionEntry, int]) -> Iterator[Line]:
    table = build.resolution.definitions
    for version in versions:
        for doc in sorted(version.doc.definitions, key=lambda item: item.name):
            tree = table.tree(doc.name, version.section.jurisdiction, version.effective)
            yield keys[version], doc.name, " ".join(doc.when.split()), to_json(TRUE if tree is None else tree), doc.quote


def _delegations(versions: Iterable[VersionEntry], keys: Mapping[VersionEntry, int]) -> Iterator[Line]:
    """Sorted within their version: the order in which a file names them means nothing."""
    for version in versions:
        yield from sorted(
            (
                keys[version], str(version.section.citation), compact(doc.to), doc.attribute, doc.direction, doc.bounds.min,
                doc.bounds.max, compact(doc.values), compact(doc.of), int(doc.sign), compact(doc.not_on), doc.condition,
            )
            for doc in version.doc.delegates
        )  # fmt: skip


def _regulation(row: Row, key: int, version: int) -> Line:
    rule, doc = row.regulation, row.entry.doc
    return (
        key, rule.id, version, rule.jurisdiction, rule.citation, rule.title, rule.topic, int(rule.legality), iso(rule.effective),
        iso(rule.until), rule.condition, " ".join(doc.condition.when.split()), " ".join(doc.condition.unless.split()),
        to_json(rule.when), None if rule.unless is None else to_json(rule.unless), rule.result, rule.force,
        compact(dict(sorted(doc.attributes.items()))), in_words(doc.states.current), in_words(doc.states.next), rule.authority,
        doc.requires_sign, compact(doc.applies_to), compact(rule.tags), rule.quote, rule.vagueness, rule.vague_because, rule.confidence,
    )  # fmt: skip


@lru_cache(maxsize=4096)
def in_words(states: tuple[str, ...]) -> str:
    """State names in the paper's style, which the state machine reads back: `Car Following; Go Straight; Overtaking`."""
    return "; ".join(name.replace("_", " ").title() for name in states)


def _limits(limits: Iterable[Limit], key: int) -> Iterator[Line]:
    for position, limit in enumerate(limits):
        bound = limit.bound
        si = None if bound.terms else bound.constant
        value = None if si is None else float(from_si(si, limit.unit))
        data = compact(linear_to_data(bound))
        yield key, position, limit.attribute, limit.fact, limit.direction, data, value, limit.unit, si, limit.text


def _state_ids(row: Row, key: int) -> Iterator[Line]:
    for role, states in (("current", row.regulation.current), ("next", row.regulation.next)):
        for state in sorted(states or ()):
            yield key, role, state
