r"""Lines end with a carriage return and a line feed.

Why:
    Mixed line ends make every line differ between two machines.

Fails:
    append: "# one\r\n"

Passes:
    append: "# one\n"

Fix (safe):
    Takes the carriage returns away.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Edit, Fix, Level
from regdb_compiler.driver import Build
from regdb_compiler.tree import Lines

CODE, NAME = "R919", "windows-line-end"
LEVEL: Level = "info"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each file with such lines."""
    for path, file in build.corpus.files.items():
        if "\r\n" not in file.text:
            continue
        lines = Lines(path, file.text)
        edits = tuple(Edit(lines.place(match.start(), match.start() + 1), "") for match in re.finditer(r"\r\n", file.text))
        fix = Fix("safe", "take the carriage returns away", edits)
        message = f"{len(edits)} {'line ends' if len(edits) == 1 else 'lines end'} with a carriage return"
        yield Diagnostic(CODE, NAME, LEVEL, message, edits[0].place, fix=fix)
