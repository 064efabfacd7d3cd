r"""The last line of a file does not end with a line feed.

Why:
    The next line that somebody adds would change this one as well, in every comparison.

Fails:
    append: "# the end"

Passes:
    append: "# the end\n"

Fix (safe):
    Ends the line.
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Edit, Fix, Level
from regdb_compiler.driver import Build
from regdb_compiler.tree import Lines

CODE, NAME = "R918", "no-final-line-feed"
LEVEL: Level = "info"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each such file."""
    for path, file in build.corpus.files.items():
        if file.text and not file.text.endswith("\n"):
            place = Lines(path, file.text).place(len(file.text), len(file.text))
            fix = Fix("safe", "end the line", (Edit(place, "\n"),))
            yield Diagnostic(CODE, NAME, LEVEL, "the file does not end with a line feed", place, fix=fix)
