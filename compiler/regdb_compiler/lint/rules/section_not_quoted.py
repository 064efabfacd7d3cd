"""The section's number is written without quotes.

Why:
    Other YAML readers take `22349.10` for a number and drop the last digit: 22349.1 is another section.

Fails:
    file: |
      section: 100
      title: Children beside the road
      location: [Division 1]
      topic: children
      source: {checked: 2026-01-02, confidence: recalled}
      versions: [{effective: 2000-01-01, text: (a) Nothing.}]

Passes:
    section: "100"

Fix (safe):
    Puts the number in quotes.
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Edit, Fix, Level
from regdb_compiler.driver import Build
from regdb_compiler.source import Scalar

CODE, NAME = "R020", "section-not-quoted"
LEVEL: Level = "warning"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each number that stands plain."""
    for section in build.corpus.sections:
        node = section.field("section")
        if isinstance(node, Scalar) and node.plain:
            fix = Fix("safe", "put the number in quotes", (Edit(node.place, f'"{node.text}"'),))
            message = f"the section's number {node.text} stands without quotes"
            yield Diagnostic(CODE, NAME, LEVEL, message, node.place, law=str(section.citation), fix=fix)
