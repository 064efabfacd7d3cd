"""A confusable names no fact, or a value that the fact cannot have.

Why:
    Confusable facts are asked about together in a closed choice. A name that is not there is never asked.

Fails:
    facts: {sign.crossing: {type: boolean, source: perception, meaning: A sign., confusables: [sign.schol]}}

Passes:
    facts: {sign.crossing: {type: boolean, source: perception, meaning: A sign., confusables: [signal.color=red]}}

Fix (unsafe):
    Writes the nearest fact there is.
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Edit, Fix, Level
from regdb_compiler.driver import Build
from regdb_compiler.lint.vocabulary_nodes import confusables

CODE, NAME = "R435", "unknown-confusable"
LEVEL: Level = "warning"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each such name."""
    vocabulary = build.corpus.vocabulary
    for fact, text, node in confusables(build.corpus):
        name, _, value = text.partition("=")
        other = vocabulary.facts.get(name.strip())
        if other is None:
            near = vocabulary.nearest(name.strip())
            fix = Fix("unsafe", f"write {near}", (Edit(node.place, near),)) if near and not value else None
            message = f"`{fact.name}` is confused with `{name}`, which is no fact"
            yield Diagnostic(CODE, NAME, LEVEL, message, node.place, note=f"did you mean {near}?" if near else "", fix=fix)
        elif value and value.strip() not in (*other.values, "true", "false"):
            yield Diagnostic(CODE, NAME, LEVEL, f"`{other.name}` is never `{value.strip()}`", node.place, note=", ".join(other.values))
