"""How wide characters stand on a terminal, and which part of a long line to show."""

import unicodedata
from dataclasses import dataclass

TAB = "    "
CUT = "..."
HARMLESS_FORMAT = "\u00ad\u200b\u200c\u200d\u2060\ufeff"


@dataclass(frozen=True, slots=True)
class Shown:
    """A line as printed, with the columns, from 0, where the marked range starts and ends in it."""

    text: str
    start: int
    end: int


def width(char: str) -> int:
    """Columns that a visible character takes: 2 for wide East Asian ones and most emoji, 0 for combining ones."""
    if unicodedata.combining(char) or unicodedata.category(char) in ("Mn", "Me") or char in HARMLESS_FORMAT:
        return 0
    return 2 if unicodedata.east_asian_width(char) in "WF" else 1


def total_width(text: str) -> int:
    """Columns that a text takes."""
    return len(text) if text.isascii() else sum(map(width, text))


def visible(text: str) -> str:
    """Text that cannot move the cursor, colour the terminal or turn the reading direction: such characters show as `?`."""
    if text.isprintable():
        return text
    return "".join(_visible_char(char) for char in text)


def fit(line: str, start: int, end: int, room: int) -> Shown:
    """Cut a line so that it takes at most `room` columns and shows where characters `start` to `end` begin."""
    if len(line) > 8 * room:
        aside = max(start - 2 * room, 0)
        line, start, end = line[aside : start + 4 * room], start - aside, end - aside
    cells = [visible(char) for char in line]
    starts = [0]
    for cell in cells:
        starts.append(starts[-1] + total_width(cell))
    start, end = min(start, len(line)), min(max(end, start), len(line))
    if starts[-1] <= room:
        return Shown("".join(cells), starts[start], starts[end])
    first, last = _window(starts, start, end, room)
    head, tail = CUT if first else "", CUT if last < len(cells) else ""
    text = head + "".join(cells[first:last]) + tail
    shift = len(head) - starts[first]
    return Shown(text, starts[start] + shift, min(starts[end] + shift, total_width(text)))


def _visible_char(char: str) -> str:
    if char == "\t":
        return TAB
    category = unicodedata.category(char)
    return "?" if (category[0] == "C" and char not in HARMLESS_FORMAT) or category in ("Zl", "Zp") else char


def _window(starts: list[int], start: int, end: int, room: int) -> tuple[int, int]:
    """The characters to show: the marked ones in the middle, or from their beginning if they are too many."""
    marked = starts[end] - starts[start]
    before = max((room - min(marked, room)) // 2, min(room // 4, 10))
    limit = len(starts) - 1
    first = start
    while first > 0 and starts[start] - starts[first - 1] <= before - len(CUT):
        first -= 1
    space = room - (len(CUT) if first else 0)
    if starts[limit] - starts[first] <= space:
        while first > 0 and starts[limit] - starts[first - 1] <= room - len(CUT):
            first -= 1
        return first, limit
    last = first
    while last < limit and starts[last + 1] - starts[first] <= space - len(CUT):
        last += 1
    return first, last
