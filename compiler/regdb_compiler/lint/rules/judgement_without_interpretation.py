"""A regulation leaves much to judgement, and no interpretation speaks of any fact it reads.

Why:
    With a vagueness of three or more the verdict hangs on a judgement. Somebody makes it: an interpretation, by a formula that can be
    looked up, or whoever reports the fact, by means that nobody sees.

Fails:
    interpretations: {one: {facts: {scene.dark: unknown}}}
    facts: {scene.dark: {type: boolean, source: perception, meaning: It is dark.}}
    vagueness: {score: 3, because: what counts as beside the road is a judgement}

Passes:
    interpretations: {one: {facts: {children.present: unknown}}}
    vagueness: {score: 3, because: what counts as beside the road is a judgement}
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build
from regdb_compiler.lint.view import view_of

CODE, NAME = "R705", "judgement-without-interpretation"
LEVEL: Level = "info"
MUCH = 3
"""Vagueness from which on a verdict hangs on a judgement."""


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each such regulation; none where there are no interpretations at all."""
    spoken = {fact for entry in build.corpus.interpretations for fact in entry.profile.decisions}
    view = view_of(build)
    for rule in view.first if spoken else ():
        if rule.entry.doc.vagueness.score >= MUCH and spoken.isdisjoint(view.rule_facts(rule)):
            message = f"no interpretation speaks of a fact that {rule.entry.id} reads"
            help_ = "let each profile decide the fact that is a judgement, or say `unknown`"
            law = str(rule.entry.citation)
            yield Diagnostic(CODE, NAME, LEVEL, message, rule.entry.place("vagueness"), help=help_, law=law)
