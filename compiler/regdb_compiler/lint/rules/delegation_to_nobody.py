"""A delegation names a kind of jurisdiction, an attribute, a road owner or a regulation that is not there.

Why:
    Nobody can use it, or nothing is bounded by it: an override that relies on it is refused, or allowed more than the law allows.

Fails:
    delegates: [{to: [town], attribute: max_speed}]

Passes:
    delegates: [{to: [city], attribute: max_speed}]
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb.citation import CitationError, parse_citation
from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build
from regdb_compiler.entries import RegulationEntry, VersionEntry
from regdb_compiler.lint.view import View, view_of

CODE, NAME = "R629", "delegation-to-nobody"
LEVEL: Level = "error"
KINDS = ("county", "city", "district")


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each such word."""
    view = view_of(build)
    for version in build.corpus.versions:
        for position, doc in enumerate(version.doc.delegates):
            for at, kind in enumerate(doc.to):
                if kind not in KINDS:
                    yield _finding(version, (position, "to", at), f"`{kind}` is no kind of local authority", ", ".join(KINDS))
            attribute = build.corpus.vocabulary.attributes.get(doc.attribute)
            if doc.attribute and (attribute is None or attribute.kind != "limit"):
                yield _finding(version, (position, "attribute"), f"`{doc.attribute}` is no limit of the vocabulary")
            yield from _owners(view, version, position)
            for at, name in enumerate(doc.of):
                if not _is_there(build, version, name):
                    yield _finding(version, (position, "of", at), f"`{name}` is no regulation, tag, topic or section")


def _owners(view: View, version: VersionEntry, position: int) -> Iterator[Diagnostic]:
    fact = view.fact("road.owner")
    for at, owner in enumerate(version.doc.delegates[position].not_on):
        if fact is not None and owner not in fact.values:
            yield _finding(version, (position, "not_on", at), f"no road belongs to `{owner}`", ", ".join(fact.values))


def _is_there(build: Build, version: VersionEntry, name: str) -> bool:
    group, _, word = name.partition(":")
    own: tuple[RegulationEntry, ...] = version.regulations
    if group == "tag" and word:
        return any(word in entry.doc.tags for entry in build.corpus.regulations)
    if group == "topic" and word:
        return any(word == entry.topic for entry in build.corpus.regulations)
    if name in build.corpus.by_id or any(name in {entry.doc.id, entry.citation.subdivision} for entry in own):
        return True
    try:
        citation = parse_citation(name)
    except CitationError:
        return any(name == section.id for section in build.corpus.sections)
    return (citation.code, citation.section) in build.corpus.by_citation


def _finding(version: VersionEntry, path: tuple[str | int, ...], message: str, note: str = "") -> Diagnostic:
    place = version.place("delegates", *path)
    return Diagnostic(CODE, NAME, LEVEL, message, place, note=note, law=str(version.section.citation))
