"""An interpretation is silent about a fact that it should speak of.

Why:
    Facts that the law leaves to judgement are decided by an interpretation. What one profile decides, or what a fact's own meaning leaves
    to `the interpretation in use`, every profile speaks of, if only to say `unknown`; silence looks like something forgotten.

Fails:
    interpretations:
      one: {facts: {children.present: unknown}}
      two: {facts: {}}

Passes:
    interpretations:
      one: {facts: {children.present: unknown}}
      two: {facts: {children.present: {formula: unknown, because: it does not say}}}
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build

CODE, NAME = "R704", "fact-without-interpretation"
LEVEL: Level = "warning"
LEFT_TO_IT = "interpretation in use"
"""Words by which a fact's meaning leaves it to the profile."""


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each profile and fact."""
    entries = build.corpus.interpretations
    spoken = {fact: entry.profile.name for entry in entries for fact in entry.profile.decisions}
    left = {fact.name for fact in build.corpus.vocabulary if fact.kind == "boolean" and LEFT_TO_IT in fact.meaning}
    for entry in entries:
        for fact in sorted({*spoken, *left} - set(entry.profile.decisions)):
            message = f"`{entry.profile.name}` says nothing of `{fact}`"
            note = f"`{spoken[fact]}` does" if fact in spoken else "its meaning leaves it to the interpretation in use"
            help_ = "name a formula, or write `unknown` and why"
            yield Diagnostic(CODE, NAME, LEVEL, message, entry.place("facts"), note=note, help=help_)
