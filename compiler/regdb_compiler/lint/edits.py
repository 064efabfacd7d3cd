"""Edits that fixes are made of: take out a key or an item, put in a key, write other words; None where the text is too odd for it."""

from __future__ import annotations

from regdb_compiler.diagnostics import Edit
from regdb_compiler.tree import Lines, Mapping, Node, Scalar, Sequence


def delete_key(mapping: Mapping, key: str) -> Edit | None:
    """Take out a key of a block mapping with its value, whole lines. None in braces, and for the first key of a list item."""
    found = next(((name, value) for name, value in mapping.entries if name.text == key), None)
    if mapping.flow or found is None:
        return None
    name, value = found
    lines = name.lines
    start = lines.starts[lines.line(name.start) - 1]
    if lines.text[start : name.start].strip():
        return None
    return Edit(lines.place(start, line_end(lines, max(value.content_end, name.content_end))), "")


def insert_key_after(mapping: Mapping, key: str, text: str) -> Edit | None:
    """Put the line `text` after the entry of `key` in a block mapping, with its indentation."""
    found = next(((name, value) for name, value in mapping.entries if name.text == key), None)
    if mapping.flow or found is None:
        return None
    lines = found[0].lines
    column = mapping.entries[0][0].place.column - 1
    end = line_end(lines, found[1].content_end)
    new = " " * column + text + "\n"
    return Edit(lines.place(end, end), new if lines.text[end - 1 : end] == "\n" else "\n" + new)


def delete_item(sequence: Sequence, position: int) -> Edit | None:
    """Take out an item of a list; of one in brackets with the comma before it, so never the first."""
    item = sequence.items[position]
    lines = sequence.lines
    if sequence.flow:
        return Edit(lines.place(sequence.items[position - 1].content_end, item.content_end), "") if position else None
    start = lines.starts[lines.line(item.start) - 1]
    return Edit(lines.place(start, line_end(lines, item.content_end)), "")


def replace_words(node: Node, start: int, end: int, text: str) -> Edit | None:
    """Write other words for `text[start:end]` of a scalar that stands on one line. None for any other node."""
    if not isinstance(node, Scalar) or node.place.line != node.place.end_line:
        return None
    return Edit(node.place_of(start, end), text)


def line_end(lines: Lines, offset: int) -> int:
    """The offset after the line feed that ends the line of `offset`; the text's end where there is none."""
    end = lines.text.find("\n", max(offset - 1, 0) if lines.text[offset - 1 : offset] == "\n" else offset)
    return len(lines.text) if end < 0 else end + 1
