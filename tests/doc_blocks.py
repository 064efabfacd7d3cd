"""The fenced blocks of a documentation page: what stands in them, what is to be done with each, and how outputs are compared.

A comment on the line above a block says what it is for:

    <!-- file: PATH -->      the block is written to PATH
    <!-- append: PATH -->    the block is added to the end of PATH
    <!-- edit: PATH -->      a `diff` block: lines with `-` are replaced by the lines with `+` that follow them
    <!-- output -->          what the `python` block above prints
    <!-- not run: WHY -->    shown only

Without one, `console` blocks are commands (`$ `) with their outputs, `python` and `sql` blocks are run, others are shown only.
In an output `...` stands for anything: as a line for any lines, inside a line for any words. Line numbers and seconds may differ.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path

_BLOCK = re.compile(r"(?:^<!-- (?P<note>[^\n]*) -->\n)?^```(?P<language>\w+)\n(?P<text>.*?)^```$", re.MULTILINE | re.DOTALL)
_VARYING = (
    (re.compile(r"^(\s*)\d+( \|)"), r"\1#\2"),
    (re.compile(r"(--> \S+?):\d+:\d+$"), r"\1:#"),
    (re.compile(r"^(FAILED \S+?):\d+$"), r"\1:#"),
    (re.compile(r"\b\d+\.\d+ s\b"), "# s"),
)


@dataclass(frozen=True)
class Block:
    """A block: its line in the page, language, the note above it, its text, and where the text stands in the page."""

    line: int
    language: str
    note: str
    text: str
    start: int

    @property
    def task(self) -> tuple[str, str]:
        """The note's first word and what follows its colon."""
        word, _, rest = self.note.partition(":")
        return word.strip(), rest.strip()


@dataclass(frozen=True)
class Step:
    """A command of a console block, and the output shown under it."""

    command: str
    shown: str


def read_blocks(page: str) -> tuple[Block, ...]:
    """The blocks of a page, in order."""
    return tuple(
        Block(page.count("\n", 0, match.start("text")), match["language"], match["note"] or "", match["text"], match.start("text"))
        for match in _BLOCK.finditer(page)
    )


def read_steps(text: str) -> Iterator[Step]:
    """The commands of a console block; a command goes on over lines that end in a backslash."""
    command, shown = "", list[str]()
    for line in text.splitlines():
        if command.endswith("\\"):
            command = f"{command}\n{line.removeprefix('> ')}"
        elif line.startswith("$ "):
            if command:
                yield Step(command, "\n".join(shown))
            command, shown = line[2:], []
        else:
            shown.append(line)
    if command:
        yield Step(command, "\n".join(shown))


def edited(text: str, change: str) -> str:
    """A text after a `diff` block's replacements. Raises ValueError when the lines to replace do not stand in it exactly once."""
    marked = [(line[:1], line[1:]) for line in change.splitlines()]
    assert all(mark in {"-", "+"} for mark, _ in marked), "a diff block holds lines with - and + alone"
    runs = [(mark, "".join(f"{line}\n" for _, line in group)) for mark, group in groupby(marked, lambda item: item[0])]
    for (mark, old), (_, new) in zip(runs[::2], runs[1::2], strict=True):
        assert mark == "-", "a diff block begins with what is replaced"
        if text.count(old) != 1:
            raise ValueError(f"these lines stand {text.count(old)} times in the file:\n{old}")
        text = text.replace(old, new)
    return text


def is_shown(shown: str, told: str) -> bool:
    """Whether an output is as the page shows it."""
    lines = [_steady(line) for line in told.strip("\n").splitlines()]
    reached = {0}
    """How many lines of the output may have been accounted for so far."""
    for line in (_steady(line) for line in shown.strip("\n").splitlines()):
        if line == "...":
            reached = set(range(min(reached), len(lines) + 1)) if reached else set()
        else:
            pattern = re.compile(re.escape(line).replace(r"\.\.\.", ".*"))
            reached = {at + 1 for at in reached if at < len(lines) and pattern.fullmatch(lines[at])}
    return len(lines) in reached


def _steady(line: str) -> str:
    line = line.rstrip()
    for pattern, instead in _VARYING:
        line = pattern.sub(instead, line)
    return line


def in_place(text: str, folder: Path) -> str:
    """An output with nothing of the temporary folder in it."""
    return text.replace(f"{folder.resolve()}/", "").replace(f"{folder}/", "").replace(str(folder.resolve()), ".")
