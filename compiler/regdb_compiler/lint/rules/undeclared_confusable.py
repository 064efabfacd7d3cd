"""A phrase of a sign or signal lies within a phrase of another, and neither fact names the other as confusable.

Why:
    The longest phrase settles what a whole text says. A text cut off, or a sign half read, says the shorter one: `stop here on red` read
    as `stop`. Facts that can be taken for one another are asked about in a closed choice, which needs them declared.

Fails:
    facts:
      sign.crossing: {type: boolean, source: perception, meaning: A sign., phrases: [crossing sign]}
      sign.horses: {type: boolean, source: perception, meaning: Another sign., phrases: [horse crossing sign]}

Passes:
    facts:
      sign.crossing: {type: boolean, source: perception, meaning: A sign., phrases: [crossing sign], confusables: [sign.horses]}
      sign.horses: {type: boolean, source: perception, meaning: Another sign., phrases: [horse crossing sign], confusables: [sign.crossing]}
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from regdb.vocabulary import Fact
from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build
from regdb_compiler.lint.phrases import Spoken, names, spoken
from regdb_compiler.lint.view import view_of

CODE, NAME = "R443", "undeclared-confusable"
LEVEL: Level = "info"
ROLES = ("sign", "signal", "lane_signal")
"""Roles whose facts a reader of signs tells apart; elsewhere a longer phrase says more, not something else."""


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each pair of facts, at the one whose phrase is the longer."""
    view = view_of(build)
    told: dict[tuple[str, ...], dict[str, Spoken]] = {}
    items = [item for item in spoken(build.corpus.vocabulary) if item.fact.name.partition(".")[0] in ROLES]
    for item in items:
        told.setdefault(item.words, {})[item.fact.name] = item
    seen: set[tuple[str, str]] = set()
    for item in items:
        for inner in _within(item, told):
            pair = inner.fact.name, item.fact.name
            if pair not in seen and not _related(inner.fact, item.fact):
                seen.add(pair)
                where = f"`{inner.text}` of `{inner.fact.name}` lies within `{item.text}` of `{item.fact.name}`"
                message = f"{where}; neither names the other as confusable"
                yield Diagnostic(CODE, NAME, LEVEL, message, view.fact_place(item.fact.name), help="declare them `confusables` of each other")


def _within(item: Spoken, told: Mapping[tuple[str, ...], Mapping[str, Spoken]]) -> Iterator[Spoken]:
    """Phrases of other facts that are a part of this one, and not also of its own fact."""
    words = item.words
    for size in range(1, len(words)):
        for start in range(len(words) - size + 1):
            inner = told.get(words[start : start + size], {})
            if item.fact.name not in inner:
                yield from inner.values()


def _related(one: Fact, other: Fact) -> bool:
    return names(one, other) or one.name in other.entails or other.name in one.entails
