r"""A tab stands in the file.

Why:
    How wide a tab is depends on the editor, and YAML forbids it in indentation.

Fails:
    append: "#\ta note\n"

Passes:
    append: "# a note\n"

Fix (safe):
    Writes a space for it.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Edit, Fix, Level
from regdb_compiler.driver import Build
from regdb_compiler.tree import Lines

CODE, NAME = "R911", "tab-character"
LEVEL: Level = "warning"
_TABS = re.compile(r"\t+(?=[^\s])")


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each run of tabs before a word; those at a line's end are R910's."""
    for path, file in build.corpus.files.items():
        if "\t" not in file.text:
            continue
        lines = Lines(path, file.text)
        for match in _TABS.finditer(file.text):
            place = lines.place(match.start(), match.end())
            fix = Fix("safe", "write a space", (Edit(place, " "),))
            yield Diagnostic(CODE, NAME, LEVEL, "a tab", place, fix=fix)
