"""What a mutant is: the law with one written thing otherwise, as regulation rows that stand in for others."""

from __future__ import annotations

from dataclasses import dataclass

from regdb.regulation import Regulation
from regdb_compiler.diagnostics import Place

KINDS = (
    "operator", "negation", "part", "unless", "word", "bound", "date", "exception", "legality", "state", "class", "sign", "scope", "jurisdiction",
)  # fmt: skip
"""Kinds of change, in the order of reports."""

Swap = tuple[Regulation, Regulation]
"""A row as it is, and what stands in its place."""


@dataclass(frozen=True, slots=True)
class Mutant:
    """One change of the law: `subject` is the regulation, definition or section, `what` the change in words.

    A change of a definition or of a version's date swaps every row that rests on it.
    """

    kind: str
    subject: str
    what: str
    place: Place
    code: str
    swaps: tuple[Swap, ...]

    @property
    def ids(self) -> frozenset[str]:
        """The regulations it touches."""
        return frozenset(original.id for original, _ in self.swaps)

    def __str__(self) -> str:
        return f"{self.subject}: {self.what}"
