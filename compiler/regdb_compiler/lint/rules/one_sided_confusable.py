"""A fact names another as confusable, but that one does not name it back.

Why:
    Two things that look alike are alike from both sides. Perception that is asked about the second is not warned of the first.

Fails:
    facts: {sign.crossing: {type: boolean, source: perception, meaning: A sign., confusables: [sign.school]}}

Passes:
    facts:
      sign.crossing: {type: boolean, source: perception, meaning: A sign., confusables: [sign.crossing_ahead]}
      sign.crossing_ahead: {type: boolean, source: perception, meaning: A sign ahead., confusables: [sign.crossing]}
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build
from regdb_compiler.lint.view import view_of
from regdb_compiler.lint.vocabulary_nodes import confusables

CODE, NAME = "R436", "one-sided-confusable"
LEVEL: Level = "info"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each pair declared from one side only."""
    vocabulary, view = build.corpus.vocabulary, view_of(build)
    for fact, text, node in confusables(build.corpus):
        other = vocabulary.facts.get(text.partition("=")[0].strip())
        if other is not None and other.name != fact.name and fact.name not in {t.partition("=")[0].strip() for t in other.confusables}:
            message = f"`{other.name}` does not name `{fact.name}` as confusable"
            related = ((view.fact_place(other.name), "declared here"),)
            yield Diagnostic(CODE, NAME, LEVEL, message, node.place, related=related)
