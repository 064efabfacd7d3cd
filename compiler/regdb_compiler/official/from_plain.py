"""Plain text -> passages: one section or many, each beginning with its number, as `21453. (a) ...` or `SEC. 80.36. TITLE.`."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from regdb_compiler.official.passage import Passage, version_said

NUMBER = r"\d+(?:[.\-]\d+)*"
_HEAD = re.compile(
    rf"\s*(?P<word>(?:SECTIONS?|Sections?|SEC\.?|Sec\.?|\u00a7{{1,2}})\s*)?(?P<number>{NUMBER})(?P<stop>\.?)(?:\s*[-\u2013\u2014:]\s+|\s+|\Z)(?P<rest>.*)\Z",
    re.DOTALL,
)
HISTORY = re.compile(
    r"(?:Added|Amended|Enacted|Repealed|Renumbered|Formerly|Section|Title|Heading|Subsec|Subdiv|Ord|New|Former)\b.*"
    r"(?:Stats\.|Ord\.|Ch\.|Eff\.|\u00a7|Initiative|Proposition)", re.DOTALL,
)  # fmt: skip
_DIVISION = re.compile(r"(?:Division|Title|Part|Chapter|Article)\b", re.IGNORECASE)
_STOPS = ".;:!?)]>\"'\u201d\u2019*_=-"
LEAST_DIGITS = 3
"""Digits that make a bare number at the beginning of a line a section's rather than a list's."""


def head_of(line: str) -> tuple[str, str] | None:
    """Number and what follows it, of a line that begins a section; None for any other."""
    match = _HEAD.match(line)
    if match is None:
        return None
    number, digits = match["number"], sum(letter.isdigit() for letter in match["number"])
    divided = not number.isdigit()
    if match["word"] or (digits >= LEAST_DIGITS and (match["stop"] or (divided and digits > LEAST_DIGITS))):
        return number, match["rest"].strip()
    return None


def read_plain(text: str, name: str = "") -> tuple[Passage, ...]:
    """Every section of a text; the whole text as one where it has no numbers but is named after its section (`21453.txt`)."""
    found = tuple(_passages(text.splitlines()))
    if not found and re.fullmatch(NUMBER, name) and text.strip():
        return (whole_passage(name, "", text.splitlines()),)
    return found


def _passages(lines: Iterable[str]) -> Iterator[Passage]:
    number, body, before = "", list[str](), ""
    for line in lines:
        head = head_of(line) if _ends(before) else None
        before = line.strip()
        if head is None:
            body.append(line)
            continue
        if number:
            yield whole_passage(number, "", body)
        number, body = head[0], [head[1]]
    if number:
        yield whole_passage(number, "", body)


def _ends(line: str) -> bool:
    """Whether a section may begin after this line: a number after `... as in Section`, wrapped there, begins none."""
    return not line or line[-1] in _STOPS or line.isupper() or _DIVISION.match(line) is not None


def whole_passage(number: str, heading: str, lines: Iterable[str], version: str = "", history: Iterable[str] = ()) -> Passage:
    """A passage of a section's lines; history notes among them go to the note, whose latest date is the text's unless one is given."""
    kept: list[str] = []
    notes = list(history)
    for line in (" ".join(part.split()) for part in lines):
        if line:
            (notes if line.startswith(("(", "[")) and HISTORY.match(line.lstrip("([")) else kept).append(line)
    note = " ".join(notes)
    return Passage(number, heading, "\n".join(kept), note, version or version_said(note))
