"""Regulations read a fact, or a value of one, that perception should report and that no phrase reveals.

Why:
    What a model says of a frame becomes facts by the phrases of the vocabulary. A condition on a fact without them never becomes true
    by itself: no phrase, map, sensor or clock can ever say it.

Fails:
    facts: {sign.crossing: {type: boolean, source: perception, meaning: A sign., phrases: []}}
    condition: {when: sign.crossing}

Passes:
    facts: {sign.crossing: {type: boolean, source: perception, meaning: A sign., phrases: [crossing sign]}}
    condition: {when: sign.crossing}
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from regdb.condition import Has, OneOf
from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build
from regdb_compiler.lint.view import View, view_of

CODE, NAME = "R448", "unspoken-fact"
LEVEL: Level = "info"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each such fact; of an enumeration also for the values that rules ask for and nothing says."""
    view = view_of(build)
    seen = [fact for fact in build.corpus.vocabulary if fact.source == "perception" and fact.name in view.read_facts]
    if not view.whole or 2 * sum(bool(fact.phrases) for fact in seen) < len(seen):  # a vocabulary not meant for texts
        return
    asked = _asked(view)
    for fact in seen:
        if not fact.phrases:
            message = f"rules read `{fact.name}`, which perception should report, and no phrase reveals it"
            yield Diagnostic(CODE, NAME, LEVEL, message, view.fact_place(fact.name), help="give it `phrases`, or the source that tells it")
            continue
        mute = sorted(asked.get(fact.name, set()) - set(fact.phrases) - {"none"})
        if mute:
            message = f"rules ask whether `{fact.name}` is {' or '.join(mute)}, which no phrase reveals"
            yield Diagnostic(CODE, NAME, LEVEL, message, view.fact_place(fact.name), help="give the value `phrases`")


def _asked(view: View) -> Mapping[str, set[str]]:
    """Enumeration or set -> the words conditions ask for."""
    found: dict[str, set[str]] = {}
    for rule in view.rules:
        for literal in view.rule_literals(rule):
            if isinstance(literal, OneOf):
                found.setdefault(literal.fact, set()).update(literal.words)
            elif isinstance(literal, Has):
                found.setdefault(literal.fact, set()).add(literal.word)
    return found
