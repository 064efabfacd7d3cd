"""One phrase reveals two values of a fact, or two facts that are declared confusable.

Why:
    A phrase is found once and says all that is written for it. Where the facts exclude or resemble one another, no longer phrase settles
    which of them is meant, and both are asserted.

Fails:
    facts:
      sign.crossing: {type: boolean, source: perception, meaning: A sign., phrases: [crossing sign], confusables: [sign.deer]}
      sign.deer: {type: boolean, source: perception, meaning: Another., phrases: [the crossing sign], confusables: [sign.crossing]}

Passes:
    facts:
      sign.crossing: {type: boolean, source: perception, meaning: A sign., phrases: [crossing sign], confusables: [sign.deer]}
      sign.deer: {type: boolean, source: perception, meaning: Another., phrases: [deer crossing sign], confusables: [sign.crossing]}
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build
from regdb_compiler.lint.phrases import Spoken, names, spoken
from regdb_compiler.lint.view import view_of

CODE, NAME = "R449", "shared-phrase"
LEVEL: Level = "warning"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each such pair, at the later fact."""
    view = view_of(build)
    first: dict[tuple[str, ...], list[Spoken]] = {}
    for item in spoken(build.corpus.vocabulary):
        for other in first.get(item.words, ()):
            if other.fact is item.fact:
                clash = item.fact.kind == "enumeration" and other.value != item.value
            else:
                clash = names(item.fact, other.fact) and not {item.fact.name, other.fact.name} & {*item.fact.entails, *other.fact.entails}
            if clash:
                message = f"`{item.text}` reveals both `{other.name}` and `{item.name}`, which exclude or resemble one another"
                yield Diagnostic(CODE, NAME, LEVEL, message, view.fact_place(item.fact.name), help="leave it with one, or lengthen it")
        first.setdefault(item.words, []).append(item)
