"""A delegation's bound cannot be read, has the wrong unit, or its least lies above its most.

Why:
    A bound that is not understood bounds nothing: whatever the local authority writes then passes.

Fails:
    delegates: [{to: [city], attribute: max_speed, bounds: {min: 15, max: 25 mph}}]

Passes:
    delegates: [{to: [city], attribute: max_speed, bounds: {min: 15 mph, max: 25 mph}}]
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb.units import UnitError, parse_quantity
from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build
from regdb_compiler.entries import VersionEntry

CODE, NAME = "R630", "unreadable-bounds"
LEVEL: Level = "error"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each such bound."""
    vocabulary = build.corpus.vocabulary
    for version in build.corpus.versions:
        for position, doc in enumerate(version.doc.delegates):
            attribute = vocabulary.attributes.get(doc.attribute)
            fact = vocabulary.facts.get(attribute.fact) if attribute else None
            dimension = fact.dimension if fact else ""
            written: list[tuple[tuple[str | int, ...], str]] = [(("bounds", "min"), doc.bounds.min), (("bounds", "max"), doc.bounds.max)]
            written += [(("values", at), text) for at, text in enumerate(doc.values)]
            for path, text in written:
                problem = _problem(text, dimension) if text else ""
                if problem:
                    yield _finding(version, (position, *path), problem)
            if not any(_problem(t, dimension) for t in (doc.bounds.min, doc.bounds.max)) and _is_reversed(doc.bounds.min, doc.bounds.max):
                yield _finding(version, (position, "bounds", "min"), f"{doc.bounds.min} lies above {doc.bounds.max}")


def _problem(text: str, dimension: str) -> str:
    if not text:
        return ""
    try:
        found = parse_quantity(text).dimension
    except UnitError as error:
        return str(error)
    return f"{text} is a {found}, not a {dimension}" if dimension and found != dimension else ""


def _is_reversed(least: str, most: str) -> bool:
    return bool(least and most) and parse_quantity(least).si > parse_quantity(most).si


def _finding(version: VersionEntry, path: tuple[str | int, ...], message: str) -> Diagnostic:
    return Diagnostic(CODE, NAME, LEVEL, message, version.place("delegates", *path), law=str(version.section.citation))
