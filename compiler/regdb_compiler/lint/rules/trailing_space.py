r"""A line ends with spaces.

Why:
    They are seen by nobody and show up in every comparison of two versions.

Fails:
    append: "# a note  \n"

Passes:
    append: "# a note\n"

Fix (safe):
    Takes them away.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Edit, Fix, Level
from regdb_compiler.driver import Build
from regdb_compiler.tree import Lines

CODE, NAME = "R910", "trailing-space"
LEVEL: Level = "info"
_TRAILING = re.compile(r"[ \t]+(?=\r?\n|\Z)")


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each such line."""
    for path, file in build.corpus.files.items():
        if " \n" not in file.text and "\t\n" not in file.text and " \r\n" not in file.text and not file.text.endswith((" ", "\t")):
            continue
        lines = Lines(path, file.text)
        for match in _TRAILING.finditer(file.text):
            place = lines.place(match.start(), match.end())
            fix = Fix("safe", "take the spaces away", (Edit(place, ""),))
            yield Diagnostic(CODE, NAME, LEVEL, "spaces at the end of the line", place, fix=fix)
