"""Dates that cannot be: versions that overlap, intervals without a day, regulations outside their version, ids in force twice."""

from __future__ import annotations

import datetime
from collections.abc import Iterator

from regdb_compiler.corpus import Corpus
from regdb_compiler.diagnostics import Diagnostic, Place
from regdb_compiler.entries import RegulationEntry, SectionEntry, VersionEntry

TIMELINE_RULES = (
    ("R501", "version-overlap", "Two versions of one section are in force on the same day."),
    ("R502", "empty-interval", "`until` is not after `effective`, so there is no day on which this is in force."),
    ("R503", "outside-version", "A regulation's own dates reach outside the version that it stands in."),
    ("R504", "regulation-twice", "Two regulations with one id are in force on the same day."),
    ("R505", "version-gap", "Between two versions there are days without any text; say so by a version without regulations."),
    ("R506", "versions-out-of-order", "Versions stand oldest first."),
)


def check_timeline(corpus: Corpus) -> Iterator[Diagnostic]:
    """Everything about dates that makes the law of a day ambiguous."""
    for section in corpus.sections:
        yield from _versions(section)
    for entry in corpus.regulations:
        yield from _regulation(entry)
    for entries in corpus.by_id.values():
        yield from _twice(entries)


def _versions(section: SectionEntry) -> Iterator[Diagnostic]:
    law = str(section.citation)
    for version in section.versions:
        if version.until is not None and version.until <= version.effective:
            yield _empty(version.place("until"), law)
    for earlier, later in zip(section.versions, section.versions[1:], strict=False):
        place, related = later.place("effective"), ((_end_place(earlier), "the version before"),)
        if later.effective < earlier.effective:
            message = "this version is older than the one before it"
            yield Diagnostic("R506", "versions-out-of-order", "error", message, place, related=related, law=law)
        elif earlier.until is None or later.effective < earlier.until:
            end = "never ends" if earlier.until is None else f"ends on {_iso(earlier.until)}"
            message = f"this version begins while the one before is in force (it {end})"
            note = f"write `until: {_iso(later.effective)}` there"
            yield Diagnostic("R501", "version-overlap", "error", message, place, note=note, related=related, law=law)
        elif later.effective > earlier.until:
            message = f"from {_iso(earlier.until)} to {_iso(later.effective)} no text of this section is in force"
            yield Diagnostic("R505", "version-gap", "warning", message, place, related=related, law=law)


def _end_place(version: VersionEntry) -> Place:
    return version.place("until") if version.doc.until is not None else version.place("effective")


def _regulation(entry: RegulationEntry) -> Iterator[Diagnostic]:
    law, version = str(entry.citation), entry.version
    if entry.until is not None and entry.until <= entry.effective and (entry.doc.until or entry.doc.effective):
        yield _empty(entry.place("until" if entry.doc.until else "effective"), law)
    early = entry.effective < version.effective
    late = version.until is not None and (entry.until is None or entry.until > version.until)
    if early or late:
        span = f"{_iso(version.effective)} to {_iso(version.until) if version.until else 'now'}"
        place = entry.place("effective" if early else "until")
        yield Diagnostic("R503", "outside-version", "error", "these dates reach outside the version", place, note=f"it runs {span}", law=law)


def _twice(entries: tuple[RegulationEntry, ...]) -> Iterator[Diagnostic]:
    for position, entry in enumerate(entries):
        for earlier in entries[:position]:
            same_or_fine = entry.version is earlier.version or entry.version.section is not earlier.version.section
            if entry.overlaps(earlier) and (same_or_fine or entry.doc.effective or entry.doc.until):
                related = ((earlier.place("id"), "in force at the same time"),)
                message = f"{entry.id} is in force twice on {_iso(max(entry.effective, earlier.effective))}"
                yield Diagnostic("R504", "regulation-twice", "error", message, entry.place("id"), related=related, law=str(entry.citation))


def _empty(place: Place, law: str) -> Diagnostic:
    return Diagnostic("R502", "empty-interval", "error", "`until` is not after `effective`: there is no such day", place, law=law)


def _iso(day: int) -> str:
    return datetime.date.fromordinal(day).isoformat()
