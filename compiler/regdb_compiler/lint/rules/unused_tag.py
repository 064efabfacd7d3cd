"""No exception, override or delegation names this tag.

Why:
    A tag is a group that another rule displaces as one (`tag:device`). One that nobody names groups nothing, or is misspelt.

Fails:
    tags: [child]

Passes:
    tags: [child]
    text: "(a) Children. Local authorities may alter it."
    delegates: [{to: [city], of: ["tag:child"]}]
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build
from regdb_compiler.lint.view import view_of

CODE, NAME = "R914", "unused-tag"
LEVEL: Level = "info"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each tag nobody names, at its first use; none while a file could not be read."""
    view = view_of(build)
    told: set[str] = set()
    for entry in build.corpus.regulations if view.whole else ():
        for position, tag in enumerate(entry.doc.tags):
            if tag not in view.named_tags and tag not in told:
                told.add(tag)
                message = f"nothing names `tag:{tag}`"
                yield Diagnostic(CODE, NAME, LEVEL, message, entry.place("tags", position), law=str(entry.citation))
