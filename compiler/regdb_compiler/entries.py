"""A document with its nodes: sections, versions, regulations and cases as written, each of whose fields has a place."""

from __future__ import annotations

import datetime
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

from regdb.citation import Citation
from regdb.jurisdiction import Jurisdiction
from regdb_compiler import documents
from regdb_compiler.diagnostics import Place
from regdb_compiler.parse import node_at
from regdb_compiler.source import Mapping, Node, Scalar, SourceFile


def day(date: datetime.date | None) -> int | None:
    """The day number of a date; None stays open."""
    return None if date is None else date.toordinal()


class Written:
    """Something that stands in a file."""

    node: Mapping
    file: SourceFile

    def __repr__(self) -> str:
        return f"<{type(self).__name__} at {self.node.place}>"

    def field(self, *path: str | int) -> Node:
        """The node of a field, or of the nearest thing around it that is written."""
        return node_at(self.node, path)

    def place(self, *path: str | int) -> Place:
        """Where a field's value is written; of one with several lines its first key."""
        node = self.field(*path)
        place = node.place
        if place.end_line != place.line and isinstance(node, Mapping) and node.entries:
            return node.entries[0][0].place
        if place.end_line != place.line:
            return Place(place.path, place.line, place.column, place.line, place.column + 1)
        return place

    def key_place(self, *path: str) -> Place:
        """Where a field's key is written."""
        inside = node_at(self.node, path[:-1])
        return inside.key_place(path[-1]) if isinstance(inside, Mapping) else inside.place

    def text_place(self, start: int, end: int, *path: str | int) -> Place:
        """Where characters start..end of a text field stand."""
        node = self.field(*path)
        return node.place_of(start, end) if isinstance(node, Scalar) else node.place


@dataclass(frozen=True, eq=False, repr=False)
class SectionEntry(Written):
    """One section's file."""

    doc: documents.Section
    node: Mapping
    file: SourceFile
    jurisdiction: Jurisdiction

    @property
    def id(self) -> str:
        """`cvc-21453`."""
        return f"{self.jurisdiction.code}-{self.doc.section}"

    @property
    def citation(self) -> Citation:
        return Citation(self.jurisdiction.short, self.doc.section)

    @cached_property
    def versions(self) -> tuple[VersionEntry, ...]:
        """Its dated versions in the order written."""
        nodes = self.field("versions")
        return tuple(
            VersionEntry(doc, node, self.file, self, position)
            for position, (doc, node) in enumerate(zip(self.doc.versions, nodes, strict=True))  # type: ignore[arg-type]
            if isinstance(node, Mapping)
        )


@dataclass(frozen=True, eq=False, repr=False)
class VersionEntry(Written):
    """One dated version of a section."""

    doc: documents.Version
    node: Mapping
    file: SourceFile
    section: SectionEntry
    position: int

    @property
    def effective(self) -> int:
        return self.doc.effective.toordinal()

    @property
    def until(self) -> int | None:
        return day(self.doc.until)

    @cached_property
    def regulations(self) -> tuple[RegulationEntry, ...]:
        """Its regulations in the order written."""
        nodes = self.field("regulations") if self.doc.regulations else ()
        return tuple(
            RegulationEntry(doc, node, self.file, self)
            for doc, node in zip(self.doc.regulations, nodes, strict=True)  # type: ignore[arg-type]
            if isinstance(node, Mapping)
        )


@dataclass(frozen=True, eq=False, repr=False)
class RegulationEntry(Written):
    """One regulation as annotated, in its version."""

    doc: documents.Regulation
    node: Mapping
    file: SourceFile
    version: VersionEntry

    @property
    def section(self) -> SectionEntry:
        return self.version.section

    @property
    def jurisdiction(self) -> Jurisdiction:
        return self.version.section.jurisdiction

    @cached_property
    def id(self) -> str:
        """`cvc-21453-a`, the same in every version."""
        return f"{self.section.id}-{self.doc.id}"

    @cached_property
    def citation(self) -> Citation:
        """As cited: CVC 21453(b)."""
        section = self.section.citation
        return Citation(section.code, section.section, subdivision_of(self.doc))

    @property
    def effective(self) -> int:
        """First day in force."""
        own = day(self.doc.effective)
        return self.version.effective if own is None else own

    @property
    def until(self) -> int | None:
        """First day no longer in force; None while open."""
        own = day(self.doc.until)
        return self.version.until if own is None else own

    @property
    def topic(self) -> str:
        return self.doc.topic or self.section.doc.topic

    def in_force(self, on: int) -> bool:
        return self.effective <= on and (self.until is None or on < self.until)

    def overlaps(self, other: RegulationEntry) -> bool:
        """Whether there is a day on which both are in force."""
        first = max(self.effective, other.effective)
        return self.in_force(first) and other.in_force(first)

    @property
    def default_day(self) -> int:
        """The day its tests are judged on: when the source was checked, or its first day once that text has ended."""
        checked = self.section.doc.source.checked.toordinal()
        return checked if self.in_force(checked) else self.effective


@dataclass(frozen=True, eq=False, repr=False)
class CaseEntry(Written):
    """A scene that involves several sections."""

    doc: documents.Case
    node: Mapping
    file: SourceFile
    jurisdiction: Jurisdiction


@dataclass(frozen=True, eq=False, repr=False)
class OutlineEntry(Written):
    """A code's outline."""

    doc: documents.Outline
    node: Mapping
    file: SourceFile
    jurisdiction: Jurisdiction


def subdivision_of(doc: documents.Regulation) -> str:
    """The subdivision as cited; from the id where it is not written: a -> (a), a-1-bus -> (a)(1), b-right -> (b)."""
    return doc.subdivision if doc.subdivision is not None else "".join(f"({part})" for part in _levels(doc.id))


def _levels(name: str) -> Iterator[str]:
    """Leading words of an id that look like a subdivision's levels: a letter, then numbers, then a capital."""
    for position, part in enumerate(name.split("-")):
        if (position == 0 and len(part) == 1 and part.isalpha()) or (position == 1 and part.isdigit()):
            yield part
        elif position == 2 and len(part) == 1 and part.isalpha():
            yield part.upper()
        else:
            return
