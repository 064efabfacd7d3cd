"""What several rules look at, worked out once for a build: literals, passages of the text, who names whom, the day of the check."""

from __future__ import annotations

import datetime
import re
from collections.abc import Iterator, Mapping
from functools import cached_property

from regdb.condition import Compare, Literal, Node, facts_of, literals
from regdb.vocabulary import Fact
from regdb_compiler.authority import DelegationEntry
from regdb_compiler.diagnostics import Place
from regdb_compiler.driver import Build
from regdb_compiler.entries import RegulationEntry, VersionEntry
from regdb_compiler.ledger import CodeLedger, ledgers
from regdb_compiler.resolve import Resolved

_MARK = re.compile(r"^[ \t]*\(([a-z])\)", re.MULTILINE)


class View:
    """Shared, lazily computed tables over one build."""

    def __init__(self, build: Build, today: datetime.date | None = None) -> None:
        self.build, self.corpus = build, build.corpus
        self.today = (today or datetime.date.today()).toordinal()
        self._facts: dict[int, tuple[str, ...]] = {}
        self._literals: dict[int, tuple[Literal, ...]] = {}
        self._passages: dict[VersionEntry, Mapping[str, str]] = {}

    @cached_property
    def rules(self) -> tuple[Resolved, ...]:
        """Sound regulations, one for each stretch of time, as resolved."""
        return tuple(rule for rule in self.build.resolution.rules if rule.sound)

    @cached_property
    def first(self) -> tuple[Resolved, ...]:
        """Sound regulations, of each as written only its first stretch of time: what its author typed."""
        seen: dict[RegulationEntry, Resolved] = {}
        for rule in self.rules:
            seen.setdefault(rule.entry, rule)
        return tuple(seen.values())

    @cached_property
    def whole(self) -> bool:
        """Whether everything was read, so that what nothing names is truly unused."""
        return all(not (d.level == "error" and d.code.startswith("R0")) for d in self.build.diagnostics)

    def literals(self, node: Node) -> tuple[Literal, ...]:
        """Literals of a condition; each tree is walked once. Trees live as long as the build, so their identity is a key."""
        found = self._literals.get(id(node))
        if found is None:
            found = self._literals[id(node)] = tuple(literals(node))
        return found

    def facts(self, node: Node) -> tuple[str, ...]:
        """Facts that a condition reads; each tree is walked once."""
        found = self._facts.get(id(node))
        if found is None:
            found = self._facts[id(node)] = facts_of(node)
        return found

    def rule_literals(self, rule: Resolved) -> Iterator[Literal]:
        """Literals of `when`, `unless` and the scope of a regulation."""
        yield from self.literals(rule.when)
        if rule.unless is not None:
            yield from self.literals(rule.unless)
        yield from self.literals(rule.scope)

    def rule_facts(self, rule: Resolved) -> tuple[str, ...]:
        """Facts that a regulation reads: condition, scope, sign, bounds and the quantities they bound."""
        found = [*self.facts(rule.when), *self.facts(rule.scope)]
        if rule.unless is not None:
            found += self.facts(rule.unless)
        for limit in rule.limits:
            found += [limit.fact, *(fact for _, fact in limit.bound.terms)]
        return tuple(found)

    @cached_property
    def read_facts(self) -> frozenset[str]:
        """Every fact that some regulation, definition or attribute reads."""
        found: set[str] = set()
        for rule in self.build.resolution.rules:
            found.update(self.rule_facts(rule))
        for entries in self.build.resolution.definitions.entries.values():
            for entry in entries:
                owner, day = entry.version.section.jurisdiction, entry.version.effective
                tree = self.build.resolution.definitions.tree(entry.doc.name, owner, day)
                found.update(facts_of(tree) if tree is not None else ())
        return frozenset(found | {attribute.fact for attribute in self.corpus.vocabulary.attributes.values()})

    def passages(self, version: VersionEntry) -> Mapping[str, str]:
        """Leading letter of a subdivision -> its passage of the version's text; all of it under the empty word."""
        found = self._passages.get(version)
        if found is None:
            found = self._passages[version] = _passages(version.doc.text)
        return found

    def passage(self, entry: RegulationEntry) -> str:
        """The passage of the text that a regulation rests on; the whole text where that is not divided."""
        passages = self.passages(entry.version)
        letter = next(iter(entry.citation.parts), "")
        return passages.get(letter, "" if len(passages) > 1 else passages[""])

    @cached_property
    def named_tags(self) -> frozenset[str]:
        """Tags that an exception, an override or a delegation names."""
        names = [name for e in self.corpus.regulations for name in (*e.doc.exception_to, *e.doc.overrides)]
        names += [name for version in self.corpus.versions for doc in version.doc.delegates for name in doc.of]
        return frozenset(name.removeprefix("tag:") for name in names if name.startswith("tag:"))

    @cached_property
    def ledgers(self) -> tuple[CodeLedger, ...]:
        """How every section stands, by code."""
        return ledgers(self.corpus)

    @cached_property
    def delegations(self) -> tuple[DelegationEntry, ...]:
        """Every delegation, in the order of the codes."""
        return tuple(item for items in self.build.authority.by_section.values() for item in items)

    def fact(self, name: str) -> Fact | None:
        return self.corpus.vocabulary.facts.get(name)

    def fact_place(self, name: str) -> Place:
        """Where a fact is declared."""
        return self.corpus.fact_places.get(name, Place(f"{self.corpus.root.name}/vocabulary", 1, 1, 1, 1))


def _passages(text: str) -> dict[str, str]:
    marks = list(_MARK.finditer(text))
    found = {"": text}
    ends = [*(mark.start() for mark in marks[1:]), len(text)]
    for mark, end in zip(marks, ends, strict=False):
        found[mark[1]] = found.get(mark[1], "") + text[mark.start() : end]
    return found


def view_of(build: Build, today: datetime.date | None = None) -> View:
    """The build's view, made when first asked for; it is kept with the build, as its cached properties are."""
    held = build.__dict__.get("lint_view")
    if not isinstance(held, View) or (today is not None and held.today != today.toordinal()):
        held = build.__dict__["lint_view"] = View(build, today)
    return held


def numbers(literal: Literal) -> tuple[float, ...]:
    """The literal numbers of a comparison, in SI."""
    if not isinstance(literal, Compare):
        return ()
    return tuple(side.constant for side in (literal.left, literal.right) if not side.terms or side.constant)


def spot(entry: RegulationEntry, key: str, word: str) -> Place:
    """Where a word stands in `when` or `unless`; the whole condition where a definition brings it in."""
    text = getattr(entry.doc.condition, key)
    match = re.search(rf"(?<![\w.]){re.escape(word)}(?![\w.])", text)
    return entry.text_place(match.start(), match.end(), "condition", key) if match else entry.place("condition", key)
