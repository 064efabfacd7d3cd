"""Attached texts beside the annotation: which text speaks for which version of a section, what changed, what is missing."""

from __future__ import annotations

import datetime
import difflib
import re
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from regdb_compiler.driver import Build
from regdb_compiler.entries import SectionEntry, VersionEntry
from regdb_compiler.official.comparing import normal
from regdb_compiler.official.shelf import Attached, Shelf, read_shelf, texts_folder


@dataclass(frozen=True, slots=True)
class Change:
    """A section whose text is no longer the one accepted: the new text, the day of acceptance, the first words that differ."""

    text: Attached
    accepted: str
    before: str
    after: str


class AttachedTexts:
    """The texts attached for a build, looked up by version; empty where nothing is attached."""

    def __init__(self, build: Build, shelf: Shelf) -> None:
        self.build, self.shelf = build, shelf
        self._words: dict[str, str] = {}

    def __bool__(self) -> bool:
        return bool(self.shelf.texts)

    def words(self, item: Attached) -> str:
        """The words of a text, read once."""
        found = self._words.get(item.file)
        if found is None:
            found = self._words[item.file] = self.shelf.words(item)
        return found

    def of(self, section: SectionEntry) -> tuple[Attached, ...]:
        return self._by_section.get((section.jurisdiction.code, section.doc.section), ())

    def speaking_for(self, version: VersionEntry) -> Attached | None:
        """The text that shows this version: the one whose day (as it says, else the day it was attached) the version was in force."""
        found = [item for item in self.of(version.section) if _shown(version.section, item) is version]
        return max(found, key=lambda item: item.version, default=None)

    def change(self, section: SectionEntry) -> Change | None:
        """How the section's text differs from what was accepted; None if it does not, or nothing was accepted."""
        code, number = section.jurisdiction.code, section.doc.section
        accepted = self.shelf.accepted_of(code, number)
        known = {item.sha256 for item in accepted}
        new = next((item for item in self.of(section) if item.sha256 not in known), None)
        if not accepted or new is None:
            return None
        before, after = _difference(self.shelf.words(accepted[-1]), self.words(new))
        return Change(new, max(item.on for item in accepted), before, after)

    def gap(self, section: SectionEntry) -> str:
        """The source that prints sections on both sides of this one, but not this one; empty if there is none."""
        if self.of(section):
            return ""
        place = number_key(section.doc.section)
        for source, (first, last) in self._reach.get(section.jurisdiction.code, {}).items():
            if first < place < last:
                return source
        return ""

    @cached_property
    def _by_section(self) -> dict[tuple[str, str], tuple[Attached, ...]]:
        found: dict[tuple[str, str], tuple[Attached, ...]] = {}
        for item in self.shelf.texts:
            key = (item.code, item.section)
            found[key] = (*found.get(key, ()), item)
        return found

    @cached_property
    def _reach(self) -> dict[str, dict[str, tuple[tuple[int, ...], tuple[int, ...]]]]:
        """Code -> source -> its first and last section."""
        found: dict[str, dict[str, tuple[tuple[int, ...], tuple[int, ...]]]] = {}
        for item in self.shelf.texts:
            place, sources = number_key(item.section), found.setdefault(item.code, {})
            first, last = sources.get(item.source, (place, place))
            sources[item.source] = (min(first, place), max(last, place))
        return found


def number_key(section: str) -> tuple[int, ...]:
    """A section's number as something that sorts: 21453 < 21453.5 < 21454."""
    return tuple(int(part) for part in re.findall(r"\d+", section))


def _shown(section: SectionEntry, item: Attached) -> VersionEntry | None:
    for text in (item.version, item.attached):
        day = datetime.date.fromisoformat(text).toordinal() if text else None
        if day is not None:
            for version in section.versions:
                if version.effective <= day and (version.until is None or day < version.until):
                    return version
    return section.versions[-1] if section.versions else None


def _difference(before: str, after: str) -> tuple[str, str]:
    """The first stretch of words that differs, a few words around it, as it was and as it is."""
    old, new = normal(before).split(" "), normal(after).split(" ")
    codes = (item for item in difflib.SequenceMatcher(None, old, new, autojunk=False).get_opcodes() if item[0] != "equal")
    _, first, end, other, other_end = next(codes, ("", 0, 0, 0, 0))
    return _around(old, first, end), _around(new, other, other_end)


def _around(words: list[str], start: int, end: int, margin: int = 2, most: int = 12) -> str:
    shown = words[max(0, start - margin) : min(end + margin, start + most)]
    return " ".join(shown)


def texts_of(build: Build, folder: Path | None = None) -> AttachedTexts:
    """The texts attached for a build, read once and kept with it; `folder` is where to look when not beside the codes.

    Raises FrontError for an index or a text that cannot be read.
    """
    held = build.__dict__.get("attached_texts")
    if isinstance(held, AttachedTexts) and folder is None:
        return held
    found = AttachedTexts(build, read_shelf(texts_folder(build.corpus.root, folder)))
    build.__dict__["attached_texts"] = found
    return found
