"""A section of official text as a source prints it, and what goes wrong when a source cannot be read."""

from __future__ import annotations

import datetime
import re
from dataclasses import dataclass

_MONTHS = (
    "January", "February", "March", "April", "May", "June", "July", "August", "September", "October", "November", "December",
)  # fmt: skip
_SAID = re.compile(rf"\b(?:[Ee]ffective|[Oo]perative)\s+(?:on\s+)?({'|'.join(_MONTHS)})\s+(\d{{1,2}}),\s+(\d{{4}})")
_SHORT = re.compile(r"\bEff\.\s*(\d{1,2})/(\d{1,2})/(\d{4}|\d{2})\b")
CENTURY_TURNS = 50
"""Years of two digits from here on belong to the last century: publishers' history notes begin in the 1930s."""


class UnreadableTextError(Exception):
    """A source that holds no section of law, or cannot be read; the message says why."""


@dataclass(frozen=True, slots=True)
class Passage:
    """One section: its number, its heading, its words line by line, the history note, and the day its text took effect if said (ISO)."""

    section: str
    heading: str
    text: str
    note: str = ""
    version: str = ""


def version_said(note: str) -> str:
    """The latest day in a history note on which the text took effect or became operative, in ISO; empty if it says none."""
    found = [_iso(int(year), _MONTHS.index(month) + 1, int(day)) for month, day, year in _SAID.findall(note)]
    for month, day, year in _SHORT.findall(note):
        whole = int(year) if len(year) == 4 else int(year) + (1900 if int(year) >= CENTURY_TURNS else 2000)
        found.append(_iso(whole, int(month), int(day)))
    return max(found, default="")


def _iso(year: int, month: int, day: int) -> str:
    try:
        return datetime.date(year, month, day).isoformat()
    except ValueError:
        return ""
