"""A list of a regulation names the same thing twice.

Why:
    The second time it says nothing; often another word was meant.

Fails:
    applies_to: [truck, bus, truck]

Passes:
    applies_to: [truck, bus]

Fix (safe):
    Takes the second one out.
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Fix, Level
from regdb_compiler.driver import Build
from regdb_compiler.lint.edits import delete_item
from regdb_compiler.source import Sequence

CODE, NAME = "R922", "repeated-item"
LEVEL: Level = "warning"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each item that stood there before; states are R447's."""
    for entry in build.corpus.regulations:
        doc = entry.doc
        for key, items in (
            ("exception_to", doc.exception_to),
            ("overrides", doc.overrides),
            ("applies_to", doc.applies_to),
            ("tags", doc.tags),
        ):
            if len(items) < 2 or len(set(items)) == len(items):
                continue
            for position, item in enumerate(items):
                if item in items[:position]:
                    node = entry.field(key)
                    edit = delete_item(node, position) if isinstance(node, Sequence) else None
                    fix = Fix("safe", "take the second one out", (edit,)) if edit else None
                    place = entry.place(key, position)
                    yield Diagnostic(CODE, NAME, LEVEL, f"`{item}` stands here twice", place, law=str(entry.citation), fix=fix)
