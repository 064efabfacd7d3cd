"""HTML -> blocks of text, each with the tags, ids and classes around it; what is no text of the page is left out."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from html.parser import HTMLParser

BLOCKS = frozenset(
    ("address", "article", "aside", "blockquote", "body", "center", "dd", "div", "dl", "dt", "fieldset", "figure", "form", "h1", "h2",
     "h3", "h4", "h5", "h6", "hr", "html", "li", "main", "ol", "p", "pre", "section", "table", "tbody", "td", "th", "thead", "tr", "ul")
)  # fmt: skip
SKIPPED = frozenset(
    ("script", "style", "head", "nav", "header", "footer", "noscript", "select", "button", "template", "svg", "iframe", "textarea")
)
EMPTY = frozenset(("area", "base", "br", "col", "embed", "hr", "img", "input", "link", "meta", "param", "source", "track", "wbr"))
HEADINGS = frozenset(("h1", "h2", "h3", "h4", "h5", "h6"))
DEEPEST = 400
"""Open elements beyond which no more are told apart: no page of law is nested like that."""


@dataclass(frozen=True, slots=True)
class Block:
    """A run of text between two borders of blocks. `marks` are the tags, `#id`s and `.class`es of every element around it."""

    text: str
    marks: frozenset[str]

    @property
    def is_heading(self) -> bool:
        return not HEADINGS.isdisjoint(self.marks)


class _Reader(HTMLParser):
    """Collects blocks; elements left open are closed with what is around them."""

    def __init__(self) -> None:
        super().__init__(convert_charrefs=True)
        self.found: list[Block] = []
        self._open: list[tuple[str, frozenset[str]]] = []
        self._words: list[str] = []
        self._skipping = 0

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        if tag == "br":
            self._words.append(" ")
        if tag in SKIPPED:
            self._skipping += 1
        if tag == "body":  # a head that was never closed
            self._skipping = 0
        if tag in BLOCKS:
            self.end_block()
            if tag in ("p", "li") and self._open and self._open[-1][0] == tag:
                self._open.pop()
        if tag not in EMPTY and len(self._open) < DEEPEST:
            self._open.append((tag, frozenset(_marks(tag, attrs))))

    def handle_endtag(self, tag: str) -> None:
        if tag in SKIPPED and self._skipping:
            self._skipping -= 1
        if tag in BLOCKS:
            self.end_block()
        if any(tag == name for name, _ in self._open):
            while self._open.pop()[0] != tag:
                pass

    def handle_data(self, data: str) -> None:
        if not self._skipping:
            self._words.append(data)

    def end_block(self) -> None:
        text = re.sub(r"\s+", " ", "".join(self._words).replace("\u00a0", " ")).strip()
        self._words.clear()
        if text:
            self.found.append(Block(text, frozenset().union(*(marks for _, marks in self._open))))


def _marks(tag: str, attributes: list[tuple[str, str | None]]) -> Iterator[str]:
    yield tag
    for name, value in attributes:
        if name == "id" and value:
            yield f"#{value}"
        if name == "class" and value:
            yield from (f".{word}" for word in value.split())


def read_blocks(page: str) -> tuple[Block, ...]:
    """The page's blocks in order. Broken HTML gives whatever text there is."""
    reader = _Reader()
    reader.feed(page)
    reader.close()
    reader.end_block()
    return tuple(reader.found)
