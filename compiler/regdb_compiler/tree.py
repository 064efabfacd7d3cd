"""The nodes of a read YAML file: text, sequences and mappings, each of which knows its place."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property

from regdb_compiler.diagnostics import Place
from regdb_compiler.tree_offsets import raw_offsets

# The node classes are not frozen because that doubles the cost of making one; nobody writes to them after reading.


class Lines:
    """A file's path and text, and where its lines begin; turns offsets into places."""

    def __init__(self, path: str, text: str) -> None:
        self.path = path
        self.text = text

    @cached_property
    def starts(self) -> list[int]:
        """Offset of the first character of every line."""
        starts, at = [0], self.text.find("\n")
        while at >= 0:
            starts.append(at + 1)
            at = self.text.find("\n", at + 1)
        return starts

    def line(self, offset: int) -> int:
        """The line, from 1, on which `offset` stands."""
        return bisect_right(self.starts, offset)

    def place(self, start: int, end: int) -> Place:
        """The place between two offsets."""
        first, last = self.line(start), self.line(max(end, start))
        starts = self.starts
        return Place(self.path, first, start - starts[first - 1] + 1, last, max(end, start) - starts[last - 1] + 1)

    def offset(self, line: int, column: int) -> int:
        """The offset at a line and column, both from 1, kept inside the text and inside the line."""
        starts = self.starts
        if line > len(starts):
            return len(self.text)
        end = starts[line] - 1 if line < len(starts) else len(self.text)
        return max(0, min(starts[line - 1] + column - 1, end))


@dataclass(slots=True, eq=False)
class Scalar:
    """A piece of text, whatever it may look like: `22349.10`, `7:00`, `no` and `0500` stay what was typed."""

    text: str
    plain: bool
    lines: Lines = field(repr=False)
    start: int = field(repr=False)
    end: int = field(repr=False)

    @property
    def is_block(self) -> bool:
        """Written after `|` or `>`."""
        return not self.plain and self.lines.text[self.start : self.start + 1] in ("|", ">")

    @property
    def place(self) -> Place:
        """Where it is written, quotes included; of a block, from its `|` to the end of its last line of words."""
        return self.lines.place(self.start, self.content_end)

    @property
    def content_end(self) -> int:
        """Offset after the last character that is not white space."""
        raw = self.lines.text[self.start : self.end]
        return self.start + len(raw.rstrip()) if raw else self.end

    def place_of(self, start: int, end: int) -> Place:
        """Where `text[start:end]` stands in the file, through quotes, escapes and folded lines."""
        raw = self.lines.text[self.start : self.end]
        offsets = raw_offsets(self.text, raw, plain=self.plain)
        if offsets is None or not 0 <= start <= end <= len(self.text):
            return self.place
        last = offsets[end - 1] + 1 if end > start else offsets[start]
        return self.lines.place(self.start + offsets[start], self.start + last)


@dataclass(slots=True, eq=False)
class Sequence:
    """A list of nodes; `flow` if it is written in brackets."""

    items: tuple[Node, ...]
    flow: bool
    lines: Lines = field(repr=False)
    start: int = field(repr=False)
    end: int = field(repr=False)

    @property
    def place(self) -> Place:
        """From the first item's dash or the bracket to the end of the last item or bracket."""
        return self.lines.place(self.start, self.content_end)

    @property
    def content_end(self) -> int:
        """Offset after the last character; libyaml lets a block run on to the next token."""
        if self.flow or not self.items:
            return self.end
        return max(self.items[-1].content_end, self.start)

    def __iter__(self) -> Iterator[Node]:
        return iter(self.items)

    def __len__(self) -> int:
        return len(self.items)


@dataclass(slots=True, eq=False)
class Mapping:
    """Keys and values in the order written; of a key written twice only the first entry is kept."""

    entries: tuple[tuple[Scalar, Node], ...]
    index: dict[str, Node] = field(repr=False)
    flow: bool
    lines: Lines = field(repr=False)
    start: int = field(repr=False)
    end: int = field(repr=False)

    @property
    def place(self) -> Place:
        """From the first key or the brace to the end of the last value or brace."""
        return self.lines.place(self.start, self.content_end)

    @property
    def content_end(self) -> int:
        """Offset after the last character; libyaml lets a block run on to the next token."""
        if self.flow or not self.entries:
            return self.end
        key, value = self.entries[-1]
        return max(key.content_end, value.content_end)

    def get(self, key: str) -> Node | None:
        """The value of `key`, or None if the key is not written."""
        return self.index.get(key)

    def key_place(self, key: str) -> Place:
        """Where `key` is written; the mapping's own place if it is not."""
        return next((name.place for name, _ in self.entries if name.text == key), self.place)

    def __contains__(self, key: object) -> bool:
        return key in self.index

    def __iter__(self) -> Iterator[str]:
        return iter(self.index)

    def __len__(self) -> int:
        return len(self.entries)


Node = Scalar | Sequence | Mapping
