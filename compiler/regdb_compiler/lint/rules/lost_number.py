"""A quantity that the quote or the condition's words name is in no condition and no attribute.

Why:
    A number that stays in words binds nobody: the plan is never measured against it. A fact whose meaning names the same number counts,
    and so does a rule that this one is an exception to.

Fails:
    quote: at a distance of less than three feet

Passes:
    quote: at a distance of less than three feet
    attributes: {min_clearance: 3 ft}
    force: absolute
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb.units import unit_named
from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build
from regdb_compiler.entries import RegulationEntry
from regdb_compiler.lint.spoken_numbers import Spoken, spoken_numbers
from regdb_compiler.lint.view import View, numbers, view_of
from regdb_compiler.resolve import Resolved

CODE, NAME = "R202", "lost-number"
LEVEL: Level = "warning"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each quantity in words that is nowhere in the annotation."""
    view = view_of(build)
    for rule in view.first:
        doc = rule.entry.doc
        for path, text in ((("quote",), doc.quote), (("condition", "text"), doc.condition.text)):
            for spoken in spoken_numbers(text):
                if not any(_holds(view, other, spoken) for other in _about(build, rule)):
                    yield _lost(rule.entry, path, spoken)


def _lost(entry: RegulationEntry, path: tuple[str, ...], spoken: Spoken) -> Diagnostic:
    message = f"`{spoken.words}` is said here, but no condition or attribute has {spoken.shown}"
    help_ = "a bound on the plan goes to `attributes`, a bound on the scene to `when`"
    place = entry.text_place(spoken.start, spoken.end, *path)
    return Diagnostic(CODE, NAME, LEVEL, message, place, help=help_, law=str(entry.citation))


def _about(build: Build, rule: Resolved) -> Iterator[Resolved]:
    """The regulation and what it is an exception to or overrides."""
    yield rule
    for target, _ in build.targets.of.get(rule.entry, ()):
        yield from build.resolution.by_id.get(target, ())


def _holds(view: View, rule: Resolved, spoken: Spoken) -> bool:
    dimension = unit_named(spoken.unit).dimension
    found = [limit.bound.constant for limit in rule.limits]
    found += [number for literal in view.rule_literals(rule) for number in numbers(literal)]
    if any(abs(abs(number) - spoken.si) <= 1e-6 * max(1.0, spoken.si) for number in found):
        return True
    meanings = (fact.meaning for name in view.rule_facts(rule) if (fact := view.fact(name)) is not None)
    return any(other.si == spoken.si for text in meanings for other in spoken_numbers(text) if unit_named(other.unit).dimension == dimension)
