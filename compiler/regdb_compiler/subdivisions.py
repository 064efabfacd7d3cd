"""Which subdivisions a version's text has, and which of them nothing carries: no regulation cites them, nothing omits them."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping

from regdb_compiler.entries import VersionEntry

_HEAD = re.compile(
    r"(?:^[ \t]*|(?<=[.;:)] ))(?P<marks>\([a-z]\)(?:[ \t]*(?:,|and|to|-|\u2013|)[ \t]*\([a-z]\))*)", re.MULTILINE
)
_MARK = re.compile(r"(?P<joint>to|-|\u2013|)[ \t]*\((?P<letter>[a-z])\)")


def marked(text: str) -> Mapping[str, tuple[int, int]]:
    """Letters that open a line or a sentence, as (a), (b) and (c), or (d) to (f), with the place of their mark.

    Letters ascend: one that does not is a reference, as in "(a) and (b) do not apply".
    """
    found: dict[str, tuple[int, int]] = {}
    last = ""
    for head in _HEAD.finditer(text):
        before = ""
        for mark in _MARK.finditer(head["marks"]):
            letter, joined = mark["letter"], bool(before and mark["joint"])
            if letter <= last:
                break
            place = (head.start("marks") + mark.start("letter") - 1, head.start("marks") + mark.end())
            for code in range(ord(before) + 1 if joined else ord(letter), ord(letter) + 1):
                found[chr(code)] = place
            before = last = letter
    return found


def carried(version: VersionEntry) -> frozenset[str]:
    """Letters that a regulation of the version cites, or that it omits with a reason; all of them if it omits itself."""
    cited = {part for entry in version.regulations for part in entry.citation.parts[:1]}
    return frozenset(cited | set(_omitted(version)))


def _omitted(version: VersionEntry) -> Iterator[str]:
    for item in version.doc.omitted:
        if not item.subdivision:
            yield from marked(version.doc.text)
        for name in item.subdivision:
            levels = name.strip("()").split(")(")
            if len(levels) == 1:
                yield levels[0]


def gaps(version: VersionEntry) -> tuple[str, ...]:
    """Subdivisions of the text that nothing carries, in order."""
    held = carried(version)
    return tuple(letter for letter in marked(version.doc.text) if letter not in held)
