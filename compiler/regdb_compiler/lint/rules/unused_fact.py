"""A fact is declared, but no regulation, definition or attribute reads it.

Why:
    Perception is asked for every fact that rules read. One that none reads is left over, or a rule reads a misspelt other.

Fails:
    facts: {weather.fog: {type: boolean, source: perception, meaning: There is fog.}}

Passes:
    facts: {weather.fog: {type: boolean, source: perception, meaning: There is fog.}}
    condition: {when: weather.fog and children.present}
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build
from regdb_compiler.lint.view import view_of

CODE, NAME = "R430", "unused-fact"
LEVEL: Level = "info"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each fact that nothing reads; none while a file could not be read."""
    view = view_of(build)
    if not view.whole:
        return
    for fact in build.corpus.vocabulary:
        if fact.name not in view.read_facts:
            yield Diagnostic(CODE, NAME, LEVEL, f"no regulation reads `{fact.name}`", view.fact_place(fact.name))
