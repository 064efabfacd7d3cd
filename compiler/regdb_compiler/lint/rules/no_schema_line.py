"""A section's file does not name its schema in its first line.

Why:
    With that line any editor with a YAML language server completes and checks the file while it is written, offline.

Fails:
    id: a

Passes:
    file: |
      # yaml-language-server: $schema=../../schema/section.json
      section: "100"
      title: Children beside the road
      location: [Division 1]
      topic: children
      source: {checked: 2026-01-02, confidence: recalled}
      versions: [{effective: 2000-01-01, text: (a) Nothing.}]

Fix (safe):
    Writes the line.
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Edit, Fix, Level, Place
from regdb_compiler.driver import Build

CODE, NAME = "R923", "no-schema-line"
LEVEL: Level = "info"
LINE = "# yaml-language-server: $schema=../../schema/section.json"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each section's file without such a comment anywhere before its first key."""
    for section in build.corpus.sections:
        if "yaml-language-server:" not in section.file.text[: section.node.start]:
            top = Place(section.file.path, 1, 1, 1, 1)
            fix = Fix("safe", "write the line", (Edit(top, LINE + "\n"),))
            yield Diagnostic(CODE, NAME, LEVEL, "the file names no schema", top, law=str(section.citation), fix=fix)
