"""Options that mean the same in every command of the author's side, and how a day is asked for."""

from __future__ import annotations

import datetime
import os
import sys
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from regdb import completion


class Format(StrEnum):
    """How a result is written."""

    text = "text"
    json = "json"


Codes = Annotated[Path | None, typer.Option("--codes", metavar="DIR", help="Folder of codes; default: codes/ here, else the shipped ones.")]
On = Annotated[str, typer.Option("--on", metavar="DATE", help="The law of this day, 2026-03-02; default: today.")]
In = Annotated[
    str,
    typer.Option("--in", metavar="JURISDICTION", help="Only law that governs there.", autocompletion=completion.jurisdictions),
]
Output = Annotated[Format, typer.Option("--format", help="text, or json, which is stable.")]


@dataclass(frozen=True, slots=True)
class AskedDay:
    """A day as ISO text, and whether somebody named it."""

    iso: str
    given: bool

    @property
    def number(self) -> int:
        return datetime.date.fromisoformat(self.iso).toordinal()

    def __str__(self) -> str:
        return self.iso if self.given else f"{self.iso} (today)"


def asked_day(on: str) -> AskedDay:
    """The day `--on` names, else today. Raises typer.BadParameter."""
    if not on:
        return AskedDay(datetime.date.today().isoformat(), given=False)
    try:
        if len(on) != 10:
            raise ValueError
        return AskedDay(datetime.date.fromisoformat(on).isoformat(), given=True)
    except ValueError:
        raise typer.BadParameter(f"{on!r} is no date; write it as 2026-03-02", param_hint="--on") from None


def has_color() -> bool:
    """Whether the result may be coloured: on a terminal, unless NO_COLOR is set."""
    return sys.stdout.isatty() and not os.environ.get("NO_COLOR")
