"""Authority before anything else: what a local regulation may do is what a delegation in force lets it, and no more."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from regdb.citation import Citation, CitationError, parse_citation
from regdb.condition import TRUE, Compare, Linear, Node, Not, OneOf, Or, all_of
from regdb.condition_text import to_json
from regdb.regulation import Limit
from regdb.units import UnitError, parse_quantity
from regdb_compiler import documents
from regdb_compiler.diagnostics import Diagnostic
from regdb_compiler.entries import RegulationEntry, VersionEntry, subdivision_of
from regdb_compiler.precedence import Targets
from regdb_compiler.resolve import Resolution, Resolved, constant_of

AUTHORITY_RULES = (
    ("R601", "missing-authority", "A county or city regulation that names no section delegating the matter to it has no effect."),
    ("R602", "unknown-authority", "The section named as authority delegates nothing to this kind of jurisdiction at that time."),
    ("R603", "beyond-delegation-bounds", "The value lies outside what the delegation allows."),
    ("R604", "wrong-direction", "The delegation lets the local rule be stricter (or looser) only, and it is the other way round."),
    ("R605", "outside-delegation", "The rule displaces something the delegation does not reach."),
    ("R606", "missing-required-sign", "The delegation gives no effect without its sign, and the rule requires none."),
)


@dataclass(frozen=True, eq=False)
class DelegationEntry:
    """One delegation in the version of the section that makes it."""

    doc: documents.Delegation
    version: VersionEntry

    @property
    def citation(self) -> Citation:
        return self.version.section.citation

    def spans(self, rule: Resolved) -> bool:
        """Whether it is in force at some time while the rule is."""
        version = self.version
        first = max(version.effective, rule.effective)
        return (version.until is None or first < version.until) and (rule.until is None or first < rule.until)


class Authority:
    """All delegations, and what each local rule's authority allows and adds."""

    def __init__(self, resolution: Resolution, targets: Targets) -> None:
        self.resolution, self.targets, self.corpus = resolution, targets, resolution.corpus
        self.by_section: dict[tuple[str, str], list[DelegationEntry]] = {}
        for version in self.corpus.versions:
            for doc in version.doc.delegates:
                key = (version.section.jurisdiction.short, version.section.doc.section)
                self.by_section.setdefault(key, []).append(DelegationEntry(doc, version))

    def delegations(self, rule: Resolved) -> list[DelegationEntry]:
        """The delegations a rule's authority names, to its kind of jurisdiction, in force with it."""
        citation = _citation(rule.entry)
        if citation is None:
            return []
        found = self.by_section.get((citation.code, citation.section), [])
        return [item for item in found if rule.entry.jurisdiction.kind in item.doc.to and item.spans(rule)]

    def added_condition(self, rule: Resolved) -> Node:
        """What delegation and jurisdiction add to a local rule's condition: road owners, and bounds of a posted value."""
        jurisdiction = rule.entry.jurisdiction
        if not jurisdiction.is_local:
            return TRUE
        owners = self.corpus.vocabulary.facts.get("road.owner")
        parts: list[Node] = []
        if owners is not None and jurisdiction.road_owners and set(owners.values) - set(jurisdiction.road_owners):
            parts.append(OneOf(owners.name, tuple(sorted(set(owners.values) & set(jurisdiction.road_owners)))))
        options = self.delegations(rule)
        allowing = [item for item in options if not any(self._against(rule, item))] or options
        ways = {to_json(way): way for item in allowing for way in [self._way(rule, item)]}
        if ways and TRUE not in ways.values():
            found = tuple(way for _, way in sorted(ways.items()))
            parts.append(found[0] if len(found) == 1 else Or(found))
        return all_of(*parts)

    def _way(self, rule: Resolved, item: DelegationEntry) -> Node:
        """Under what condition one delegation carries a rule: not on some owners' roads, a posted value within its bounds."""
        owners = self.corpus.vocabulary.facts.get("road.owner")
        parts: list[Node] = []
        if owners is not None and item.doc.not_on:
            parts.append(Not(OneOf(owners.name, tuple(sorted(item.doc.not_on)))))
        for limit in rule.limits:
            if limit.attribute == item.doc.attribute and limit.bound.terms:
                parts += _bounds_of(limit, item.doc.bounds)
        return all_of(*parts)

    def check(self) -> Iterator[Diagnostic]:
        """Every local rule against its delegation."""
        for rule in self.resolution.rules:
            if rule.entry.jurisdiction.is_local:
                yield from self._check(rule)

    def _check(self, rule: Resolved) -> Iterator[Diagnostic]:
        entry = rule.entry
        law = str(entry.citation)
        if not entry.doc.authority:
            message = f"{entry.id} is local law without authority, so it has no effect (CVC 21)"
            yield Diagnostic("R601", "missing-authority", "error", message, entry.place("id"), note="name the section that allows it", law=law)
            return
        options = self.delegations(rule)
        if not options:
            if not self._is_unread(entry):
                yield self._unknown(entry)
            return
        attempts = [list(self._against(rule, item)) for item in options]
        if all(attempts):
            yield from min(attempts, key=len)

    def _is_unread(self, entry: RegulationEntry) -> bool:
        """Whether the authority stands in a section that could not be read, whose own problem is told already."""
        citation = _citation(entry)
        owner = next((item for item in self.corpus.tree if citation is not None and item.short == citation.code), None)
        return citation is not None and owner is not None and self.corpus.leaves_out(f"{owner.code}-{citation.section}")

    def _unknown(self, entry: RegulationEntry) -> Diagnostic:
        place, text = entry.place("authority"), entry.doc.authority
        citation = _citation(entry)
        if citation is None:
            note = "write it as CVC 22358"
        elif (citation.code, citation.section) not in self.by_section:
            there = (citation.code, citation.section) in self.corpus.by_citation
            note = "that section delegates nothing here; add `delegates:` to it" if there else "no such section is in the codes"
        else:
            note = f"it delegates nothing to a {entry.jurisdiction.kind} while this rule is in force"
        return Diagnostic("R602", "unknown-authority", "error", f"`{text}` gives no authority", place, note=note, law=str(entry.citation))

    def _against(self, rule: Resolved, item: DelegationEntry) -> Iterator[Diagnostic]:
        entry, doc = rule.entry, item.doc
        law = f"{item.citation}"
        if doc.sign and not entry.doc.requires_sign:
            message = f"{item.citation} gives no effect without a sign"
            note = "add `requires_sign: <the sign's fact>`"
            yield Diagnostic("R606", "missing-required-sign", "error", message, entry.place("authority"), note=note, law=law)
        for limit in rule.limits:
            if limit.attribute == doc.attribute:
                yield from _check_bounds(entry, limit, item)
        for target, kind in self.targets.of.get(entry, ()):
            if kind == "overrides":
                yield from self._check_override(rule, item, target)

    def _check_override(self, rule: Resolved, item: DelegationEntry, target: str) -> Iterator[Diagnostic]:
        entry, doc = rule.entry, item.doc
        place = entry.place("overrides")
        others = self.resolution.by_id.get(target, ())
        if doc.of and not any(_named(name, other.entry) for name in doc.of for other in others):
            message = f"{item.citation} does not reach {target}; it reaches {', '.join(doc.of)}"
            yield Diagnostic("R605", "outside-delegation", "error", message, place, law=str(item.citation))
        for other in others:
            if not rule.overlaps(other):
                continue
            wrong = _wrong_direction(rule, other, doc)
            if wrong:
                related = ((other.entry.place("attributes"), f"{target} says {wrong[1]}"),)
                message = f"{item.citation} allows a {doc.direction} value only; {wrong[0]} is not {doc.direction} than {wrong[1]}"
                yield Diagnostic("R604", "wrong-direction", "error", message, entry.place("attributes"), related=related, law=str(item.citation))
                return


def _citation(entry: RegulationEntry) -> Citation | None:
    try:
        return parse_citation(entry.doc.authority)
    except CitationError:
        return None


def _named(name: str, entry: RegulationEntry) -> bool:
    group, _, word = name.partition(":")
    if group == "tag":
        return word in entry.doc.tags
    if group == "topic":
        return word == entry.topic
    return name in {entry.id, entry.section.id, str(entry.citation), entry.doc.id, subdivision_of(entry.doc)}


def _si(text: str) -> float | None:
    try:
        return parse_quantity(text).si if text else None
    except UnitError:
        return None


def _check_bounds(entry: RegulationEntry, limit: Limit, item: DelegationEntry) -> Iterator[Diagnostic]:
    value, doc = constant_of(limit.bound), item.doc
    if value is None:
        return
    least, most = _si(doc.bounds.min), _si(doc.bounds.max)
    allowed = [number for text in doc.values if (number := _si(text)) is not None]
    want = ""
    if least is not None and value < least:
        want = f"at least {doc.bounds.min}"
    elif most is not None and value > most:
        want = f"at most {doc.bounds.max}"
    elif allowed and value not in allowed:
        want = " or ".join(doc.values)
    if want:
        place = entry.place("attributes", limit.attribute)
        message = f"{limit.text} lies outside what {item.citation} allows"
        yield Diagnostic("R603", "beyond-delegation-bounds", "error", message, place, note=want, law=str(item.citation))


def _wrong_direction(rule: Resolved, other: Resolved, doc: documents.Delegation) -> tuple[str, str] | None:
    for ours in rule.limits:
        for theirs in other.limits:
            a, b = constant_of(ours.bound), constant_of(theirs.bound)
            if ours.attribute != theirs.attribute or a is None or b is None or doc.direction == "either":
                continue
            stricter = a <= b if ours.direction == "max" else a >= b
            if stricter != (doc.direction == "stricter") and a != b:
                return ours.text, theirs.text
    return None


def _bounds_of(limit: Limit, bounds: documents.Bounds) -> Iterator[Node]:
    """A value that only a sign tells counts while it lies within the delegation's bounds."""
    for op, text in ((">=", bounds.min), ("<=", bounds.max)):
        number = _si(text)
        if number is not None:
            yield Compare(op, limit.bound, Linear(number), "quantity", parse_quantity(text).unit.symbol)
