"""Findings as values: what is wrong, where, what would be right, and the edit that makes it so."""

import hashlib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Literal

Level = Literal["error", "warning", "info"]
FixKind = Literal["safe", "unsafe", "legal"]
RuleText = tuple[str, str, str]
"""A rule's code, its name, and one sentence that explains it."""


@dataclass(frozen=True, slots=True, order=True)
class Place:
    """A range in a file: lines and columns count characters from 1, `end_column` is exclusive."""

    path: str
    line: int
    column: int
    end_line: int
    end_column: int

    def __str__(self) -> str:
        return f"{self.path}:{self.line}:{self.column}"


@dataclass(frozen=True, slots=True)
class Edit:
    """Put `text` where `place` is; a place without width inserts."""

    place: Place
    text: str


@dataclass(frozen=True, slots=True)
class Fix:
    """Edits that go together. A `legal` fix changes what the law says here and is never applied by itself."""

    kind: FixKind
    title: str
    edits: tuple[Edit, ...]


@dataclass(frozen=True, slots=True)
class Diagnostic:
    """One finding; `note` stands under the caret, `law` is the citation that it rests on."""

    code: str
    name: str
    level: Level
    message: str
    place: Place
    note: str = ""
    help: str = ""
    law: str = ""
    related: tuple[tuple[Place, str], ...] = ()
    fix: Fix | None = None

    @property
    def sort_key(self) -> tuple[Place, str, str]:
        """Order of the findings in every report: by place, then by code."""
        return (self.place, self.code, self.message)

    def __lt__(self, other: "Diagnostic") -> bool:
        return self.sort_key < other.sort_key


class RegdbInputError(Exception):
    """The input is such that work cannot go on; the diagnostics say why."""

    def __init__(self, *diagnostics: Diagnostic) -> None:
        super().__init__("; ".join(f"{d.place}: {d.code} {d.name}: {d.message}" for d in diagnostics))
        self.diagnostics = diagnostics


def in_order(diagnostics: Iterable[Diagnostic]) -> tuple[Diagnostic, ...]:
    """The findings sorted by place, each once."""
    return tuple(sorted(dict.fromkeys(diagnostics)))


def fingerprint(diagnostic: Diagnostic, source_line: str) -> str:
    """Name of a finding that outlives edits elsewhere in its file: rule, path and the words of its lines."""
    words = "\n".join(line.strip() for line in source_line.split("\n"))
    told = "\0".join((diagnostic.code, diagnostic.place.path, words))
    return hashlib.sha256(told.encode("utf-8", "surrogatepass")).hexdigest()[:20]


def split_lines(text: str) -> list[str]:
    """Lines as editors count them: only line feeds end one (`str.splitlines` also breaks at form feeds and U+2028)."""
    return [line.removesuffix("\r") for line in text.split("\n")]


def lines_of(place: Place, text: str) -> str:
    """The whole lines that `place` touches, joined by line feeds; empty if the text has no such lines."""
    return "\n".join(split_lines(text)[place.line - 1 : place.end_line])


def fingerprints(diagnostics: Iterable[Diagnostic], sources: Mapping[str, str]) -> list[str]:
    """One fingerprint for each finding, in order; a file whose text is not at hand counts as empty."""
    lines = {path: split_lines(text) for path, text in sources.items()}
    return [fingerprint(d, "\n".join(lines.get(d.place.path, [])[d.place.line - 1 : d.place.end_line])) for d in diagnostics]
