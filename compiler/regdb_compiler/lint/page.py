"""A rule's page out of its module's docstring: the offence in one sentence, why, what fails, what passes, how it is fixed."""

from __future__ import annotations

import re
import textwrap
from dataclasses import dataclass

_HEADING = re.compile(r"(Why|Fails|Passes|Fix)(?: \((safe|unsafe|legal)\))?:\Z")


@dataclass(frozen=True, slots=True)
class Page:
    """The parts of a page; `fails` and `passes` are YAML that `example` puts into a clean codes folder."""

    summary: str
    why: str = ""
    fails: str = ""
    passes: str = ""
    fix: str = ""
    fix_kind: str = ""


def read_page(docstring: str) -> Page:
    """A page from its text. Sections that are missing are empty; what stands before the first one is the summary."""
    parts: dict[str, list[str]] = {"Summary": []}
    held, kind = "Summary", ""
    for line in docstring.expandtabs().splitlines():
        heading = _HEADING.match(line)
        if heading:
            held = heading[1]
            kind = heading[2] or kind
            parts[held] = []
        else:
            parts[held].append(line)
    text = {name: textwrap.dedent("\n".join(lines)).strip("\n") for name, lines in parts.items()}
    return Page(
        " ".join(text["Summary"].split()), text.get("Why", ""), text.get("Fails", ""), text.get("Passes", ""), text.get("Fix", ""), kind
    )
