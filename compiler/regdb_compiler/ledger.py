"""The ledger: how every section that an outline lists stands, and why; what has a file and is listed nowhere."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

from regdb.jurisdiction import Jurisdiction
from regdb_compiler import documents
from regdb_compiler.corpus import Corpus
from regdb_compiler.diagnostics import Place
from regdb_compiler.entries import OutlineEntry, SectionEntry
from regdb_compiler.subdivisions import gaps

Status = Literal["encoded", "partial", "not_for_ads", "not_expressible", "unaccounted"]
STATUSES: tuple[Status, ...] = ("encoded", "partial", "not_for_ads", "not_expressible", "unaccounted")
MEANINGS: Mapping[Status, str] = {
    "encoded": "encoded",
    "partial": "partly encoded",
    "not_for_ads": "not for a driving ADS",
    "not_expressible": "not expressible",
    "unaccounted": "not accounted for",
}
Group = tuple[str, str]
"""Chapter and article; the article is empty for sections right under their chapter."""


@dataclass(frozen=True)
class Account:
    """How one section (or one range that is not listed one by one) stands. `entry` is its file, `claimed` what the outline says."""

    jurisdiction: Jurisdiction
    group: Group
    section: str
    heading: str
    status: Status
    why: str
    place: Place
    entry: SectionEntry | None = None
    claimed: str = ""
    listed: bool = True

    @property
    def is_range(self) -> bool:
        """Whether it stands for sections that are not listed one by one."""
        return " " in self.section


@dataclass(frozen=True)
class CodeLedger:
    """One code's ledger; without an outline all that it has is unlisted."""

    jurisdiction: Jurisdiction
    outline: documents.Outline | None
    accounts: tuple[Account, ...]

    @cached_property
    def groups(self) -> dict[Group, tuple[Account, ...]]:
        """Accounts by chapter and article, in the order of the outline."""
        found: dict[Group, list[Account]] = {}
        for item in self.accounts:
            found.setdefault(item.group, []).append(item)
        return {group: tuple(items) for group, items in found.items()}


def ledgers(corpus: Corpus) -> tuple[CodeLedger, ...]:
    """The ledger of every code that has sections or an outline, in the order of the jurisdictions."""
    outlines = {item.jurisdiction.id: item for item in corpus.outlines}
    found = []
    for jurisdiction in corpus.tree:
        files = {item.doc.section: item for item in corpus.sections if item.jurisdiction is jurisdiction}
        outline = outlines.get(jurisdiction.id)
        if not files and outline is None:
            continue
        listed = () if outline is None else tuple(_listed(outline, files))
        known = {item.section for item in listed}
        rest = tuple(_unlisted(entry) for number, entry in files.items() if number not in known)
        found.append(CodeLedger(jurisdiction, None if outline is None else outline.doc, (*listed, *rest)))
    return tuple(found)


def count(accounts: tuple[Account, ...]) -> Counter[Status]:
    """How many stand how; each range counts as one."""
    return Counter(item.status for item in accounts)


def percent(part: int, whole: int) -> int:
    """Rounded down, so that 100 means all."""
    return 100 * part // whole if whole else 100


def _listed(outline: OutlineEntry, files: Mapping[str, SectionEntry]) -> Iterator[Account]:
    for position, chapter in enumerate(outline.doc.outline):
        path = ("outline", position)
        yield from _group(outline, (chapter.chapter, ""), chapter.sections, chapter.all, (*path, "sections"), files)
        for number, article in enumerate(chapter.articles):
            inner = (*path, "articles", number, "sections")
            yield from _group(outline, (chapter.chapter, article.article), article.sections, article.all or chapter.all, inner, files)


def _group(
    outline: OutlineEntry,
    group: Group,
    sections: documents.Sections,
    common: documents.Account | None,
    path: tuple[str | int, ...],
    files: Mapping[str, SectionEntry],
) -> Iterator[Account]:
    for number, item in sections.items():
        entry = files.get(number)
        own = (item.status, item.why) if item.status is not None else (common.status, common.why) if common and entry is None else None
        status, why = _standing(entry, own)
        place = outline.place(*path, number)
        yield Account(outline.jurisdiction, group, number, item.heading, status, why, place, entry, item.status or "")


def _standing(entry: SectionEntry | None, own: tuple[Status, str] | None) -> tuple[Status, str]:
    """What the outline says; but what a file carries, the outline can only call partial."""
    if entry is None or (own is not None and (own[0] == "partial" or not carries(entry))):
        return own or (("unaccounted", "") if entry is None else shown_by(entry))
    return shown_by(entry)


def carries(entry: SectionEntry) -> bool:
    """Whether a section's file says by itself how the section stands: by rules, delegations, definitions, or what it omits."""
    return any(v.regulations or v.doc.delegates or v.doc.definitions or v.doc.omitted for v in entry.versions)


def shown_by(entry: SectionEntry) -> tuple[Status, str]:
    """How a section stands by its file alone. Encoded is one that lacks nothing that prescribes and carries something."""
    lacks = dict.fromkeys(_lacking(entry))
    reasons = [item for version in entry.versions for item in version.doc.omitted]
    has_rules = any(v.regulations or v.doc.delegates or v.doc.definitions for v in entry.versions)
    if has_rules or any(item.status == "elsewhere" for item in reasons):
        return ("partial", "; ".join(lacks)) if lacks else ("encoded", "")
    for status in ("not_expressible", "not_for_ads"):
        if why := [item.why for item in reasons if item.status == status]:
            return status, "; ".join(dict.fromkeys(why))
    return "unaccounted", ""


def _lacking(entry: SectionEntry) -> Iterator[str]:
    for version in entry.versions:
        for letter in gaps(version):
            yield f"({letter}) is neither cited nor omitted"
        for item in version.doc.omitted:
            if item.status == "not_expressible":
                yield f"{', '.join(item.subdivision)}: {item.why}".removeprefix(": ")


def _unlisted(entry: SectionEntry) -> Account:
    status, why = shown_by(entry)
    group = (", ".join(entry.doc.location), "")
    return Account(entry.jurisdiction, group, entry.doc.section, entry.doc.title, status, why, entry.place("section"), entry, listed=False)
