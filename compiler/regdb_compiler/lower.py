"""Law in force -> rows: resolved regulations with their targets and authority as the runtime's regulation rows."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from regdb.condition import all_of
from regdb.regulation import Regulation
from regdb_compiler.authority import Authority
from regdb_compiler.entries import RegulationEntry
from regdb_compiler.precedence import Targets
from regdb_compiler.resolve import Resolution, Resolved


@dataclass(frozen=True, slots=True)
class Row:
    """A regulation row with the entry it came from."""

    regulation: Regulation
    entry: RegulationEntry
    kinds: tuple[tuple[str, str], ...]


def lower(resolution: Resolution, targets: Targets, authority: Authority) -> tuple[Row, ...]:
    """Sound regulations as rows, sorted by citation, then id, then date: the order of the database."""
    rows = [_row(rule, targets, authority) for rule in resolution.rules if rule.sound]
    return tuple(sorted(rows, key=lambda row: (row.entry.citation.sort_key, row.regulation.id, row.regulation.effective or 0)))


def _row(rule: Resolved, targets: Targets, authority: Authority) -> Row:
    entry, doc = rule.entry, rule.entry.doc
    pairs = targets.of.get(entry, ())
    regulation = Regulation(
        id=entry.id,
        citation=str(entry.citation),
        jurisdiction=entry.jurisdiction.id,
        legality=doc.legality,
        effective=rule.effective,
        until=rule.until,
        when=all_of(rule.scope, authority.added_condition(rule), rule.when),
        unless=rule.unless,
        limits=rule.limits,
        force=doc.force or ("absolute" if rule.limits else ""),
        current=rule.current,
        next=rule.next,
        targets=tuple(target for target, _ in pairs),
        overrides=tuple(target for target, kind in pairs if kind == "overrides"),
        authority=doc.authority,
        title=entry.section.doc.title,
        topic=entry.topic,
        tags=doc.tags,
        condition=" ".join(doc.condition.text.split()),
        result=" ".join(doc.result.split()),
        quote=doc.quote,
        vagueness=doc.vagueness.score,
        vague_because=doc.vagueness.because,
        confidence=entry.section.doc.source.confidence,
    )
    return Row(regulation, entry, pairs)


def regulations(rows: Iterable[Row]) -> tuple[Regulation, ...]:
    """The rows without where they came from."""
    return tuple(row.regulation for row in rows)
