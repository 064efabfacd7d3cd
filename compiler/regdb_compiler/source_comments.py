"""Comments that allow a finding: `# regdb: allow <rules> -- <reason>` and `# regdb: allow-file <rules> -- <reason>`."""

import re
from bisect import bisect_right
from collections.abc import Iterator
from dataclasses import dataclass

from regdb_compiler.diagnostics import Place
from regdb_compiler.tree import Lines, Mapping, Node, Scalar, Sequence

MARK = re.compile(r"(?:^|(?<=\s))#[ \t]*regdb:[^\n]*", re.MULTILINE)
ALLOW = re.compile(
    r"#[ \t]*regdb:[ \t]*(?P<verb>allow|allow-file)[ \t]+(?P<rules>\w[\w-]*(?:[ \t]*,[ \t]*\w[\w-]*)*)[ \t]*"
    r"(?:--[ \t]*(?P<reason>.*))?"
)


@dataclass(frozen=True, slots=True)
class Suppression:
    """Rules allowed, by code or name, on lines `first_line` to `last_line`; without rules, a comment not understood."""

    rules: tuple[str, ...]
    reason: str
    place: Place
    first_line: int
    last_line: int


def read_suppressions(lines: Lines, root: Node | None) -> tuple[Suppression, ...]:
    """The suppression comments of a file; a `#` inside quotes or a block of text is no comment."""
    found = [match for match in MARK.finditer(lines.text)] if "regdb:" in lines.text else []  # noqa: C416
    if not found:
        return ()
    spans = sorted(_text_spans(root)) if root else []
    starts = [start for start, _ in spans]
    items = _items_by_line(lines, root) if root else {}
    return tuple(
        _suppression(lines, match, items)
        for match in found
        if (at := bisect_right(starts, match.start()) - 1) < 0 or match.start() >= spans[at][1]
    )


def _suppression(lines: Lines, match: re.Match[str], items: dict[int, int]) -> Suppression:
    comment = match[0].rstrip()
    place = lines.place(match.start(), match.start() + len(comment))
    told = ALLOW.fullmatch(comment)
    if not told:
        return Suppression((), "", place, place.line, place.line)
    first, last = place.line, place.line
    if told["verb"] == "allow-file":
        first, last = 1, len(lines.starts)
    elif not lines.text[lines.starts[place.line - 1] : match.start()].strip():
        first = _next_line(lines, place.line)
        last = items.get(first, first)
    rules = tuple(rule.strip() for rule in told["rules"].split(","))
    return Suppression(rules, (told["reason"] or "").strip(), place, first, last)


def _next_line(lines: Lines, after: int) -> int:
    """The first line after `after` that holds more than a comment; `after` itself at the end of the file."""
    for line in range(after, len(lines.starts)):
        words = lines.text[lines.starts[line] :].split("\n", 1)[0].strip()
        if words and not words.startswith("#"):
            return line + 1
    return after


def _nodes(root: Node) -> Iterator[Node]:
    waiting = [root]
    while waiting:
        node = waiting.pop()
        yield node
        if isinstance(node, Mapping):
            waiting.extend(part for entry in node.entries for part in entry)
        elif isinstance(node, Sequence):
            waiting.extend(node.items)


def _text_spans(root: Node) -> Iterator[tuple[int, int]]:
    """Offsets between which a `#` is text: all scalars, of a block only what stands under its header line."""
    for node in _nodes(root):
        if isinstance(node, Scalar) and node.is_block:
            yield node.lines.text.find("\n", node.start) + 1, node.end
        elif isinstance(node, Scalar):
            yield node.start, node.end


def _items_by_line(lines: Lines, root: Node) -> dict[int, int]:
    """Last line of the outermost mapping entry or list item that begins on a line."""
    last: dict[int, int] = {}
    for node in _nodes(root):
        if isinstance(node, Mapping):
            parts = [(key.start, value.content_end) for key, value in node.entries]
        elif isinstance(node, Sequence):
            parts = [(item.start, item.content_end) for item in node.items]
        else:
            continue
        for start, end in parts:
            line = lines.line(start)
            last[line] = max(last.get(line, 0), lines.line(end))
    return last
