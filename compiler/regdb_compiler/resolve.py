"""Conditions typed, limits read, states expanded, exceptions and overrides led to the regulations they name, dates split.

Every regulation becomes one `Resolved` per stretch of time in which nothing it rests on changes.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from functools import cached_property

from regdb.condition import TRUE, Has, Is, Linear, Node, Not, OneOf, all_of
from regdb.regulation import Limit
from regdb.states import StateError
from regdb.vocabulary import Attribute, Fact, FactError
from regdb_compiler.corpus import Corpus
from regdb_compiler.definitions import DefinitionTable, read_definitions
from regdb_compiler.diagnostics import Diagnostic, Place
from regdb_compiler.entries import RegulationEntry
from regdb_compiler.parse_condition import Parsed, parse_condition, read_linear
from regdb_compiler.type_condition import Problem, type_limit

RESOLVE_RULES = (
    ("R404", "unknown-state", "A state that the state machine does not have."),
    ("R405", "unknown-attribute", "An attribute the vocabulary does not declare, or a value it cannot have."),
    ("R304", "limit-on-permission", "A permission has limits; limits bound what a prohibition forbids to pass."),
)


@dataclass(frozen=True, eq=False)
class Resolved:
    """A regulation over one stretch of time: its typed parts. `sound` is False when a part could not be read."""

    entry: RegulationEntry
    effective: int
    until: int | None
    when: Node
    unless: Node | None
    scope: Node
    limits: tuple[Limit, ...]
    current: frozenset[str] | None
    next: frozenset[str] | None
    uses: tuple[str, ...] = ()
    sound: bool = True

    @property
    def id(self) -> str:
        return self.entry.id

    def overlaps(self, other: Resolved) -> bool:
        """Whether there is a day on which both are in force."""
        first = max(self.effective, other.effective)
        return (self.until is None or first < self.until) and (other.until is None or first < other.until)


@dataclass(frozen=True)
class Resolution:
    """Every regulation resolved, the definitions, and the problems found."""

    corpus: Corpus
    definitions: DefinitionTable
    rules: tuple[Resolved, ...]
    diagnostics: tuple[Diagnostic, ...] = ()

    @cached_property
    def by_id(self) -> dict[str, tuple[Resolved, ...]]:
        found: dict[str, list[Resolved]] = {}
        for rule in self.rules:
            found.setdefault(rule.id, []).append(rule)
        return {name: tuple(rules) for name, rules in found.items()}

    @cached_property
    def by_entry(self) -> dict[RegulationEntry, tuple[Resolved, ...]]:
        found: dict[RegulationEntry, list[Resolved]] = {}
        for rule in self.rules:
            found.setdefault(rule.entry, []).append(rule)
        return {entry: tuple(rules) for entry, rules in found.items()}


@dataclass
class _Reading:
    """One regulation while it is read: where its problems go."""

    corpus: Corpus
    entry: RegulationEntry
    problems: list[Diagnostic] = field(default_factory=list)

    def report(self, problem: Problem, *path: str) -> None:
        place = self.entry.text_place(problem.start, problem.end, *path)
        self.problems.append(Diagnostic(problem.code, problem.name, "error", problem.message, place, note=problem.note))

    def wrong(self, code: str, name: str, message: str, place: Place, note: str = "") -> None:
        self.problems.append(Diagnostic(code, name, "error", message, place, note=note))


def resolve(corpus: Corpus) -> Resolution:
    """Type everything. Problems are values; an unsound regulation stays, marked so that nothing builds on it."""
    definitions, problems = read_definitions(corpus)
    found: list[Diagnostic] = list(problems)
    rules: list[Resolved] = []
    for entry in corpus.regulations:
        reading = _Reading(corpus, entry)
        rules += _resolve_entry(reading, definitions)
        found += reading.problems
    return Resolution(corpus, definitions, tuple(rules), tuple(dict.fromkeys(found)))


def _resolve_entry(reading: _Reading, definitions: DefinitionTable) -> Iterator[Resolved]:
    entry = reading.entry
    scope, limits = _attributes(reading)
    scope = all_of(scope, _sign(reading), _classes(reading))
    current, following = _states(reading, "current"), _states(reading, "next")
    if entry.until is not None and entry.until <= entry.effective:
        return
    starts = [entry.effective]
    while starts:
        start = starts.pop()
        when, unless = _conditions(reading, definitions, start)
        uses = tuple(dict.fromkeys((*when.uses, *(unless.uses if unless else ()))))
        changes = definitions.changes(uses, entry.jurisdiction, start, entry.until)
        until = changes if changes is not None else entry.until
        if changes is not None:
            starts.append(changes)
        sound = when.node is not None and (unless is None or unless.node is not None) and not reading.problems
        sound = sound and not any(name in definitions.broken for name in uses)
        yield Resolved(
            entry, start, until, when.node or TRUE, unless.node if unless else None, scope, limits, current, following, uses, sound
        )


def _conditions(reading: _Reading, definitions: DefinitionTable, day: int) -> tuple[Parsed, Parsed | None]:
    entry, doc = reading.entry, reading.entry.doc.condition

    def definition(name: str) -> Node | None:
        return definitions.tree(name, entry.jurisdiction, day)

    when = parse_condition(doc.when, reading.corpus.vocabulary, definition) if doc.when else Parsed(TRUE)
    unless = parse_condition(doc.unless, reading.corpus.vocabulary, definition) if doc.unless else None
    for parsed, key in ((when, "when"), (unless, "unless")):
        for problem in parsed.problems if parsed is not None else ():
            reading.report(problem, "condition", key)
    return when, unless


def _attributes(reading: _Reading) -> tuple[Node, tuple[Limit, ...]]:
    """The scope as a condition, the limits as limits."""
    scope: list[Node] = []
    limits: list[Limit] = []
    vocabulary = reading.corpus.vocabulary
    for name, text in sorted(reading.entry.doc.attributes.items()):
        attribute = vocabulary.attributes.get(name)
        if attribute is None:
            known = ", ".join(vocabulary.attributes)
            place = reading.entry.key_place("attributes", name)
            reading.wrong("R405", "unknown-attribute", f"unknown attribute `{name}`", place, f"known: {known}")
        elif attribute.kind == "limit":
            limits += _limit(reading, attribute, text)
        else:
            scope += _scope(reading, attribute, text)
    if limits and reading.entry.doc.legality:
        message = "a permission cannot have limits; write the prohibition it is an exception to"
        reading.wrong("R304", "limit-on-permission", message, reading.entry.key_place("attributes"))
    return all_of(*scope), tuple(limits)


def _limit(reading: _Reading, attribute: Attribute, text: str) -> Iterator[Limit]:
    raw = read_linear(text)
    if isinstance(raw, Problem):
        reading.report(raw, "attributes", attribute.name)
        return
    vocabulary = reading.corpus.vocabulary
    fact = vocabulary.fact(attribute.fact)
    bound, unit, problems = type_limit(raw, fact, vocabulary)
    for problem in problems:
        reading.report(problem, "attributes", attribute.name)
    if bound is not None:
        yield Limit(attribute.name, fact.name, attribute.direction, bound, unit, text)


def _scope(reading: _Reading, attribute: Attribute, text: str) -> Iterator[Node]:
    fact = reading.corpus.vocabulary.fact(attribute.fact)
    try:
        yield matches(fact, text)
    except FactError as error:
        reading.wrong("R405", "unknown-attribute", str(error), reading.entry.place("attributes", attribute.name))


def matches(fact: Fact, text: str) -> Node:
    """A fact has the value written. Raises FactError."""
    if fact.kind == "set":
        fact.read([text])
        return Has(fact.name, text)
    value = fact.read(text)
    if fact.kind == "enumeration":
        return OneOf(fact.name, (str(value),))
    if fact.kind == "boolean":
        return Is(fact.name) if value else Not(Is(fact.name))
    raise FactError(f"{fact.name} is a {fact.kind}; a scope names a word")


def _sign(reading: _Reading) -> Node:
    name = reading.entry.doc.requires_sign
    if not name:
        return TRUE
    fact = reading.corpus.vocabulary.facts.get(name)
    if fact is None or fact.kind != "boolean":
        note = reading.corpus.vocabulary.hint(name).lstrip("; ") or "a boolean fact of the vocabulary"
        reading.wrong("R401", "unknown-fact", f"`requires_sign` names no boolean fact: `{name}`", reading.entry.place("requires_sign"), note)
        return TRUE
    return Is(name)


def _classes(reading: _Reading) -> Node:
    classes = reading.entry.doc.applies_to
    if not classes:
        return TRUE
    fact = reading.corpus.vocabulary.facts.get("ego.vehicle_class")
    try:
        if fact is None:
            raise FactError("the vocabulary has no ego.vehicle_class")
        return OneOf(fact.name, tuple(sorted(str(fact.read(name)) for name in classes)))
    except FactError as error:
        reading.wrong("R402", "unknown-word", str(error), reading.entry.place("applies_to"))
        return TRUE


def _states(reading: _Reading, role: str) -> frozenset[str] | None:
    names: Iterable[str] = getattr(reading.entry.doc.states, role)
    found: set[str] = set()
    for position, name in enumerate(names):
        try:
            found.update(reading.corpus.machine.expand(name))
        except StateError as error:
            message, _, note = str(error).partition("; ")
            place = reading.entry.place("states", role, position)
            reading.wrong("R404", "unknown-state", message, place, note)
    return frozenset(found) if found else None


def constant_of(bound: Linear) -> float | None:
    """A bound that is a number, in SI; None when a fact stands for it."""
    return bound.constant if not bound.terms else None
