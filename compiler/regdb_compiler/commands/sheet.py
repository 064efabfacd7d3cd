"""Labelled text for people: headings, fields and paragraphs that stay within 80 columns."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable

WIDTH = 80
LABEL = 16
"""Columns of the labels' column, its indent included."""

_BOLD, _PLAIN = "\033[1m", "\033[0m"


class Sheet:
    """Collects lines; a field or paragraph without words leaves none."""

    def __init__(self, *, color: bool = False) -> None:
        self._lines: list[str] = []
        self._color = color

    def heading(self, text: str) -> None:
        """A line of its own, bold on a terminal; an empty line before it unless it is the first."""
        self.gap()
        self._lines += [self._bold(line) for line in textwrap.wrap(text, WIDTH)]

    def line(self, text: str) -> None:
        """A line broken at 80 columns, its indent kept."""
        indent = " " * (len(text) - len(text.lstrip()))
        self._lines += [indent + part for part in wrapped(text.strip(), WIDTH - len(indent))]

    def verbatim(self, lines: Iterable[str]) -> None:
        """Lines as they are."""
        self._lines += lines

    def gap(self) -> None:
        """One empty line, never two."""
        if self._lines and self._lines[-1]:
            self._lines.append("")

    def field(self, label: str, text: str) -> None:
        """A label in the margin with its words beside it."""
        if text:
            first = f"  {label}".ljust(LABEL)
            gap = "" if len(first) <= LABEL and first.endswith(" ") else " "
            lines = wrapped(text, WIDTH - LABEL)
            self._lines += [first + gap + lines[0], *(" " * LABEL + line for line in lines[1:])]

    def items(self, label: str, texts: Iterable[str]) -> None:
        """A field with one item to a line."""
        for position, text in enumerate(texts):
            self.field("" if position else label, text)

    def passage(self, text: str) -> None:
        """A text in its own lines, indented, long ones broken."""
        for line in text.strip("\n").split("\n"):
            self._lines += [f"    {part}".rstrip() for part in wrapped(line, WIDTH - 4)]

    def render(self) -> str:
        """The sheet, ending in a line feed."""
        return "\n".join(self._lines) + "\n"

    def _bold(self, text: str) -> str:
        return f"{_BOLD}{text}{_PLAIN}" if self._color else text


def wrapped(text: str, width: int) -> list[str]:
    """Lines of at most `width` columns; a word longer than that (an address) stays whole."""
    return textwrap.wrap(text, width, break_long_words=False, break_on_hyphens=False) or [""]
