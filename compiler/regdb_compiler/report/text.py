"""Findings for people: the place in the file with a caret, the way out, and the place in the law."""

import textwrap
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial

from regdb_compiler.diagnostics import Diagnostic, Level, Place, in_order, split_lines
from regdb_compiler.report.columns import Shown, fit, total_width, visible
from regdb_compiler.report.summary import summarize

WIDTH = 80
NARROWEST_NOTE = 24
COLORS: dict[Level, str] = {"error": "31", "warning": "33", "info": "36"}
BOLD, BLUE = "1", "34"


@dataclass(frozen=True, slots=True)
class Style:
    """How wide the output may be, and whether it is coloured."""

    width: int
    color: bool

    def paint(self, text: str, *codes: str) -> str:
        """The text in a colour, if there are colours."""
        return f"\033[{';'.join(codes)}m{text}\033[0m" if self.color and text else text


def render(diagnostics: Sequence[Diagnostic], sources: Mapping[str, str], *, color: bool = False, width: int = WIDTH) -> str:
    """The findings as frames, in order, and a closing line that counts them. No line of a frame is over `width`."""
    lines = {path: split_lines(text) for path, text in sources.items()}
    style = Style(max(width, 40), color)
    frames = ["\n".join(_finding(d, lines, style)) + "\n\n" for d in in_order(diagnostics)]
    return "".join(frames) + f"{summarize(diagnostics)}\n"


def _finding(d: Diagnostic, lines: Mapping[str, list[str]], style: Style) -> Iterator[str]:
    digits = max(len(str(place.end_line)) for place in (d.place, *(place for place, _ in d.related)))
    head = f"{d.level}[{d.code}]"
    first, *more = _wrapped(f"{head} {d.name}: {visible(' '.join(d.message.split()))}", style.width, "    ")
    yield style.paint(head, BOLD, COLORS[d.level]) + first.removeprefix(head)
    yield from more
    yield from _frame(d.place, d.note, "^", COLORS[d.level], digits, lines, style)
    for place, note in d.related:
        yield from _frame(place, note, "-", BLUE, digits, lines, style)
    bar = style.paint(" " * (digits + 1) + "|", BLUE)
    if d.help or d.law or d.fix:
        yield bar
    equals = " " * (digits + 1) + style.paint("=", BLUE)
    fix = f"   [fix: {d.fix.kind}]" if d.fix else ""
    if d.help or d.fix:
        yield from _told(equals, f"help: {visible(d.help or (d.fix.title if d.fix else ''))}{fix}", digits, style)
    if d.law:
        yield from _told(equals, f"law:  {visible(d.law)}", digits, style)


def _told(equals: str, text: str, digits: int, style: Style) -> Iterator[str]:
    """A line under the frame, broken under its own words."""
    first, *more = _wrapped(text, style.width - digits - 3, " " * len("help: "))
    yield f"{equals} {first}"
    yield from (f"{' ' * (digits + 3)}{line}" for line in more)


def _wrapped(text: str, width: int, indent: str) -> list[str]:
    """Lines of at most `width` columns, the later ones indented; spaces inside them stay as they are."""
    if total_width(text) <= width:
        return [text]
    return textwrap.wrap(text, width, subsequent_indent=indent, break_on_hyphens=False, drop_whitespace=True)


def _frame(place: Place, note: str, mark: str, color: str, digits: int, lines: Mapping[str, list[str]], style: Style) -> Iterator[str]:
    """The place, and the lines that it marks; only the place if the text has no such line."""
    yield f"{' ' * digits}{style.paint('-->', BLUE)} {visible(str(place))}"
    source = lines.get(place.path, [])
    if place.line > len(source) or not (source[place.line - 1].strip() or place.end_line > place.line):
        return
    gutter = partial(_gutter, digits, style)
    room = style.width - digits - 3
    yield gutter("")
    last_line = min(place.end_line, len(source))
    shown = _shown(source[place.line - 1], place.column, place.end_column if last_line == place.line else None, room)
    yield gutter(str(place.line), shown.text)
    if last_line > place.line:
        yield gutter("", style.paint(_carets(shown, mark), BOLD, color))
        if last_line > place.line + 1:
            yield gutter("...")
        line = source[last_line - 1]
        shown = _shown(line, len(line) - len(line.lstrip()) + 1, place.end_column, room)
        yield gutter(str(last_line), shown.text)
    for under in _marked(shown, mark, visible(" ".join(note.split())), room):
        yield gutter("", style.paint(under, BOLD, color))


def _gutter(digits: int, style: Style, number: str, text: str = "") -> str:
    """A line of a frame: the line number, the bar, the text."""
    if number == "...":
        return style.paint("...", BLUE)
    bar = style.paint(f"{number:>{digits}} |", BLUE)
    return f"{bar} {text}" if text else bar


def _shown(line: str, column: int, end_column: int | None, room: int) -> Shown:
    """The part of a line to show; without `end_column` the mark goes on to the end of the line."""
    end = len(line.rstrip()) if end_column is None else end_column - 1
    return fit(line, column - 1, end, room)


def _carets(shown: Shown, mark: str) -> str:
    return " " * shown.start + mark * max(shown.end - shown.start, 1)


def _marked(shown: Shown, mark: str, note: str, room: int) -> list[str]:
    """The caret line with its note; a note that does not fit goes under the carets, broken into lines."""
    carets = _carets(shown, mark)
    if not note or total_width(carets) + 1 + total_width(note) <= room:
        return [f"{carets} {note}".rstrip()]
    indent = min(shown.start, max(room - NARROWEST_NOTE, 0))
    wrapped = textwrap.wrap(note, max(room - indent, NARROWEST_NOTE))
    return [carets, *(" " * indent + line for line in wrapped)]
