"""A build -> its mutants: each regulation, definition and version of the law with one written thing otherwise."""

from __future__ import annotations

import datetime
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field, replace

from regdb.condition import TRUE, Is, Node, OneOf
from regdb.condition_text import show_linear
from regdb.regulation import Limit, Regulation
from regdb_compiler.definitions import DefinitionEntry
from regdb_compiler.diagnostics import Place
from regdb_compiler.driver import Build
from regdb_compiler.entries import RegulationEntry, VersionEntry
from regdb_compiler.law_tests.literal_place import place_of_literal
from regdb_compiler.mutation.change_condition import changes, moved, step
from regdb_compiler.mutation.change_scope import state_changes, target_changes, without_scope
from regdb_compiler.mutation.mutant import Mutant
from regdb_compiler.mutation.templates import Templates
from regdb_compiler.resolve import Resolved

BEFORE_OUR_SOURCES = "1959-09-18"
"""The first day written where a section is older than every source; that it is this day and no other is not law."""

ALL_TEXTS_SINCE = datetime.date(2020, 1, 1)
"""Since when every text that was in force stands in the codes."""

Pair = tuple[Resolved, Regulation]


@dataclass
class _Draft:
    """Mutants of one entry while its rows are gone through: the same change of several rows is one mutant."""

    subject: str
    code: str
    found: dict[tuple[str, str, Place], list[tuple[Regulation, Regulation]]] = field(default_factory=dict)

    def add(self, kind: str, what: str, place: Place, original: Regulation, changed: Regulation) -> None:
        if changed != original:
            self.found.setdefault((kind, what, place), []).append((original, changed))

    def mutants(self) -> Iterator[Mutant]:
        for (kind, what, place), swaps in self.found.items():
            yield Mutant(kind, self.subject, what, place, self.code, tuple(swaps))


def generate(build: Build, wanted: Callable[[str], bool] = lambda _: True) -> tuple[Mutant, ...]:
    """Every mutant of the files whose path is wanted, by path and line."""
    templates = Templates(build)
    rows = {(row.entry, row.regulation.effective): row.regulation for row in build.rows}
    pairs = [(rule, rows[rule.entry, rule.effective]) for rule in build.resolution.rules if rule.sound]
    found = [*_of_entries(build, templates, pairs), *_of_definitions(build, templates, pairs), *_of_versions(pairs)]
    kept = (mutant for mutant in found if wanted(mutant.place.path))
    return tuple(sorted(kept, key=lambda mutant: (mutant.place.path, mutant.place.line, mutant.place.column)))


def _of_entries(build: Build, templates: Templates, pairs: Iterable[Pair]) -> Iterator[Mutant]:
    by_entry: dict[RegulationEntry, list[Pair]] = {}
    for pair in pairs:
        by_entry.setdefault(pair[0].entry, []).append(pair)
    for entry, own in by_entry.items():
        draft = _Draft(str(entry.citation) if entry.citation.subdivision else entry.id, entry.jurisdiction.code)
        for rule, row in own:
            _conditions(draft, templates, rule, row)
            _scope(draft, templates, rule, row)
            _limits(draft, rule, row)
            _outcome(draft, build, rule, row)
        yield from draft.mutants()


def _conditions(draft: _Draft, templates: Templates, rule: Resolved, row: Regulation) -> None:
    entry, doc = rule.entry, rule.entry.doc.condition
    vocabulary, jurisdiction, day = templates.build.corpus.vocabulary, entry.jurisdiction, rule.effective
    for change in changes(templates.read(doc.when, jurisdiction, day), vocabulary):
        changed = replace(row, when=templates.when(rule, change.node))
        draft.add(change.kind, change.what, place_of_literal(entry, "when", change.beside), row, changed)
    if row.unless is None:
        return
    draft.add("unless", f"without its `unless`: {' '.join(doc.unless.split())}", entry.place("condition", "unless"), row, replace(row, unless=None))
    for change in changes(templates.read(doc.unless, jurisdiction, day), vocabulary):
        if change.node != TRUE:  # a whole `unless` that is true or gone is another kind
            changed = replace(row, unless=templates.expand(change.node, jurisdiction, day))
            draft.add(change.kind, change.what, place_of_literal(entry, "unless", change.beside), row, changed)


def _scope(draft: _Draft, templates: Templates, rule: Resolved, row: Regulation) -> None:
    """Without a scope attribute, its required sign, or its vehicle classes."""
    entry, doc = rule.entry, rule.entry.doc
    written = templates.read(doc.condition.when, entry.jurisdiction, rule.effective)
    sign = Is(doc.requires_sign) if doc.requires_sign else TRUE
    classes = OneOf("ego.vehicle_class", tuple(sorted(doc.applies_to))) if doc.applies_to else TRUE

    def lacking(part: Node) -> Regulation:
        return replace(row, when=templates.when(rule, written, without_scope(rule.scope, part)))

    if sign != TRUE:
        draft.add("sign", f"without requires_sign {doc.requires_sign}", entry.place("requires_sign"), row, lacking(sign))
    if classes != TRUE:
        draft.add("class", f"without applies_to {', '.join(doc.applies_to)}", entry.place("applies_to"), row, lacking(classes))
    for name, text in doc.attributes.items():
        attribute = templates.build.corpus.vocabulary.attributes.get(name)
        if attribute is not None and attribute.kind == "scope":
            changed = replace(row, when=templates.when(rule, written, without_scope(rule.scope, attribute.fact)))
            draft.add("scope", f"without {name}: {text}", entry.place("attributes", name), row, changed)


def _limits(draft: _Draft, rule: Resolved, row: Regulation) -> None:
    for position, limit in enumerate(row.limits):
        if limit.bound.constant or not limit.bound.terms:
            size = step(limit.bound.constant, "quantity", limit.unit)
            for by in (size, -size):
                new = _moved_limit(limit, by)
                changed = replace(row, limits=(*row.limits[:position], new, *row.limits[position + 1 :]))
                draft.add("bound", f"{limit.attribute} {limit.text} -> {new.text}", rule.entry.place("attributes", limit.attribute), row, changed)


def _moved_limit(limit: Limit, by: float) -> Limit:
    bound = moved(limit.bound, by)
    return replace(limit, bound=bound, text=show_linear(bound, "quantity", limit.unit))


def _outcome(draft: _Draft, build: Build, rule: Resolved, row: Regulation) -> None:
    entry = rule.entry
    word = "a permission" if not row.legality else "a prohibition"
    draft.add("legality", f"{word} instead of the contrary", entry.place("legality"), row, replace(row, legality=not row.legality))
    for what, place, changed in (*target_changes(build, entry, row), *state_changes(build.corpus.machine, entry, row)):
        draft.add("state" if changed.targets == row.targets else "exception", what, place, row, changed)
    for other in _other_jurisdictions(build, row):
        draft.add("jurisdiction", f"law of {other} instead of {row.jurisdiction}", entry.place("id"), row, replace(row, jurisdiction=other))
    for key, by in (("effective", 1), ("effective", -1), ("until", 1), ("until", -1)):
        own = getattr(entry.doc, key)
        if own is not None and getattr(row, key) == own.toordinal():
            draft.add("date", _date_words(key, own, by), entry.place(key), row, _shifted(row, key, by))


def _other_jurisdictions(build: Build, row: Regulation) -> Iterator[str]:
    """The one above, and one beside or below."""
    tree = build.corpus.tree
    own = tree.get(row.jurisdiction)
    if own.parent is not None:
        yield own.parent
    near = [item.id for item in tree if item.id != own.id and (item.parent == own.parent or item.parent == own.id) and item.id != own.parent]
    yield from near[:1]


def _date_words(key: str, date: object, by: int) -> str:
    return f"{key} {date} a day {'later' if by > 0 else 'earlier'}"


def _shifted(row: Regulation, key: str, by: int) -> Regulation:
    day = getattr(row, key)
    return row if day is None else replace(row, **{key: day + by})


def _of_definitions(build: Build, templates: Templates, pairs: Iterable[Pair]) -> Iterator[Mutant]:
    """A definition's condition changed, in every row that rests on it."""
    users: dict[DefinitionEntry, list[Pair]] = {}
    for rule, row in pairs:
        for used in templates.uses(rule):
            users.setdefault(used, []).append((rule, row))
    for entry, own in users.items():
        version = entry.version
        draft = _Draft(f"{version.section.citation} {entry.doc.name}", version.section.jurisdiction.code)
        place = version.place("definitions", entry.position, "when")
        for change in changes(templates.of_definition(entry), build.corpus.vocabulary):
            for rule, row in own:
                draft.add(change.kind, change.what, place, row, _with_definition(templates, rule, row, {entry: change.node}))
        yield from draft.mutants()


def _with_definition(templates: Templates, rule: Resolved, row: Regulation, replaced: dict[DefinitionEntry, Node]) -> Regulation:
    doc, jurisdiction, day = rule.entry.doc.condition, rule.entry.jurisdiction, rule.effective
    when = templates.when(rule, templates.read(doc.when, jurisdiction, day), replaced=replaced)
    if row.unless is None:
        return replace(row, when=when)
    return replace(row, when=when, unless=templates.expand(templates.read(doc.unless, jurisdiction, day), jurisdiction, day, replaced))


def _of_versions(pairs: Iterable[Pair]) -> Iterator[Mutant]:
    """A version's first or last day moved, for all its rows that have no date of their own."""
    by_version: dict[VersionEntry, list[Pair]] = {}
    for pair in pairs:
        by_version.setdefault(pair[0].entry.version, []).append(pair)
    for version, own in by_version.items():
        draft = _Draft(str(version.section.citation), version.section.jurisdiction.code)
        for key, by in _date_moves(version):
            date = getattr(version.doc, key)
            for rule, row in own:
                if getattr(rule.entry.doc, key) is None and getattr(row, key) == date.toordinal():
                    draft.add("date", _date_words(key, date, by), version.place(key), row, _shifted(row, key, by))
        yield from draft.mutants()


def _date_moves(version: VersionEntry) -> Iterator[tuple[str, int]]:
    """Which of a version's dates are law that can be moved, and by how much.

    A model is never in force, so that the date of its edition is no law. Of a text older than all texts are kept, its first day is
    the last change we know of: that it was law on that day is told, that it was none on the day before is not.
    """
    if version.section.jurisdiction.status == "model":
        return
    if version.doc.effective.isoformat() != BEFORE_OUR_SOURCES:
        yield "effective", 1
        follows = any(other.until == version.effective for other in version.section.versions)
        if follows or version.effective >= ALL_TEXTS_SINCE.toordinal():
            yield "effective", -1
    if version.doc.until is not None:
        yield from (("until", by) for by in (1, -1))


