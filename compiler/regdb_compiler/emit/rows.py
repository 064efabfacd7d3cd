"""What every table's rows are made of: plain tuples in the order of `schema.TABLES`, JSON where a column holds several values."""

from __future__ import annotations

import datetime
import json
from dataclasses import dataclass
from typing import Any

Cell = str | int | float | None
Line = tuple[Cell, ...]
Tables = dict[str, list[Line]]
"""Table -> rows, each row a value per column."""


@dataclass(frozen=True, slots=True)
class Day:
    """The day to which a database is narrowed; None keeps every version."""

    number: int | None = None

    def keeps(self, effective: int | None, until: int | None) -> bool:
        """Whether something in force from `effective` until before `until` belongs in."""
        day = self.number
        return day is None or ((effective is None or effective <= day) and (until is None or day < until))


_encode = json.JSONEncoder(separators=(",", ":"), ensure_ascii=False).encode


def compact(data: Any) -> str:
    """JSON on one line, in the order given, letters as they are."""
    return _encode(data)


def iso(day: int | None) -> str | None:
    """A day number as ISO text; None stays open."""
    return None if day is None else datetime.date.fromordinal(day).isoformat()
