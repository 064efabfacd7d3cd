"""Two facts have names that differ by a letter, a point or an underscore.

Why:
    One was meant to be the other. Perception is asked twice, and rules that should agree read different facts.

Fails:
    facts: {children.presents: {type: boolean, source: perception, meaning: Children are there.}}

Passes:
    facts: {adults.present: {type: boolean, source: perception, meaning: Adults are there.}}
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build
from regdb_compiler.lint.view import view_of

CODE, NAME = "R917", "near-duplicate-fact"
LEVEL: Level = "warning"
SHORTEST = 8


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each such name, at the later one; names that differ in a number are let be."""
    view = view_of(build)
    held: dict[str, str] = {}
    for fact in build.corpus.vocabulary:
        bare = fact.name.replace("_", "").replace(".", "").lower()
        forms = {bare} | ({bare[:at] + bare[at + 1 :] for at in range(len(bare)) if not bare[at].isdigit()} if len(bare) > SHORTEST else set())
        near = next((held[form] for form in sorted(forms) if form in held), None)
        if near is not None and near != fact.name:
            related = ((view.fact_place(near), "the other"),)
            yield Diagnostic(CODE, NAME, LEVEL, f"`{fact.name}` is nearly `{near}`", view.fact_place(fact.name), related=related)
        for form in forms:
            held.setdefault(form, fact.name)
