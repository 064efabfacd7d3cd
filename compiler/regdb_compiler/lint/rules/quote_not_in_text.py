"""A quote is not in the attached text of its version.

Why:
    A quote is what a number or a condition rests on; words that the law does not have carry nothing. Quotes are compared with the user's
    own copy of the official text (`regdb text attach`), spacing, quotation marks, hyphens and section signs aside.

Fails:
    texts: {"100": "(a) A driver shall not change-lanes while children are beside the road."}

Passes:
    texts: {"100": "(a) A driver shall not change lanes while children are beside the road."}

Fix (safe):
    Writes the words as the text has them, where only spacing, hyphens or punctuation differ.
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Fix, Level
from regdb_compiler.driver import Build
from regdb_compiler.entries import RegulationEntry, VersionEntry
from regdb_compiler.lint.edits import replace_words
from regdb_compiler.official.annotated import texts_of
from regdb_compiler.official.comparing import Match, contains, nearest
from regdb_compiler.tree import Scalar

CODE, NAME = "R204", "quote-not-in-text"
LEVEL: Level = "error"
Found = tuple[str, RegulationEntry | VersionEntry, tuple[str | int, ...], str]


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each quote that the text showing its version does not have."""
    texts = texts_of(build)
    for version in build.corpus.versions if texts else ():
        item = texts.speaking_for(version)
        for quote, entry, path, law in _quotes(version) if item is not None else ():
            assert item is not None
            words = f"{item.heading}\n{texts.words(item)}"
            if not contains(words, quote):
                yield _missing(entry, path, quote, nearest(words, quote), law)


def _quotes(version: VersionEntry) -> Iterator[Found]:
    for entry in version.regulations:
        if entry.doc.quote:
            yield entry.doc.quote, entry, ("quote",), str(entry.citation)
    for position, definition in enumerate(version.doc.definitions):
        if definition.quote:
            yield definition.quote, version, ("definitions", position, "quote"), str(version.section.citation)


def _missing(entry: RegulationEntry | VersionEntry, path: tuple[str | int, ...], quote: str, near: Match | None, law: str) -> Diagnostic:
    message = "these words are not in the attached text of this version"
    note = f'nearest passage: "{near.words}"' if near is not None else "the text has nothing like them"
    help_ = "quote the law word for word; the number belongs in `attributes`"
    return Diagnostic(CODE, NAME, LEVEL, message, entry.place(*path), note=note, help=help_, law=law, fix=_fix(entry, path, quote, near))


def _fix(entry: RegulationEntry | VersionEntry, path: tuple[str | int, ...], quote: str, near: Match | None) -> Fix | None:
    """Only for a plain scalar on one line in which the words stay what they are: YAML gives meaning to some signs."""
    node = entry.field(*path)
    if near is None or not near.typographic or not isinstance(node, Scalar) or any(sign in near.words for sign in "\"'\\:#{}[]"):
        return None
    edit = replace_words(node, 0, len(quote), near.words)
    return None if edit is None else Fix("safe", "write the words as the text has them", (edit,))
