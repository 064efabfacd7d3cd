"""Why a mutant cannot be told from the law: the machine reaches no other transition, or no values of the facts tell the rows apart."""

from __future__ import annotations

import random
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import islice, pairwise, product

from regdb.condition import Compare, Const, Has, Is, Known, Literal, OneOf, Within, evaluate, literals
from regdb.regulation import Regulation
from regdb.truth import Truth, conjoin, negate
from regdb.vocabulary import Value
from regdb_compiler.driver import Build
from regdb_compiler.mutation.change_scope import transitions
from regdb_compiler.mutation.mutant import Mutant

TABLE = 20_000
"""Rows of the largest truth table that is written out; conditions with more facts count as not proven."""

GUESSES = 60
"""Random rows that are tried first: most mutants that differ at all differ in one of them."""

_SEED = 11

Domains = dict[str, tuple[Value | None, ...]]


@dataclass(frozen=True, slots=True)
class _Row:
    """One row of a truth table, read without assumptions."""

    values: Mapping[str, Value | None]

    def value(self, fact: str) -> Value | None:
        return self.values.get(fact)

    def observed(self, fact: str) -> Value | None:
        return self.values.get(fact)


def why_equivalent(mutant: Mutant, build: Build) -> str:
    """Why nothing can tell the mutant from the law; empty where that is not proven."""
    if all(_same_transitions(build, *swap) for swap in mutant.swaps):
        return "the state machine has no transition that tells them apart"
    if all(_same_but_conditions(*swap) and _same_truth(build, *swap) for swap in mutant.swaps):
        return "no values of the facts tell them apart"
    return ""


def _same_transitions(build: Build, original: Regulation, changed: Regulation) -> bool:
    if (original.current, original.next) == (changed.current, changed.next):
        return False
    return transitions(build.corpus.machine, original) == transitions(build.corpus.machine, changed)


def _same_but_conditions(original: Regulation, changed: Regulation) -> bool:
    names = ("jurisdiction", "legality", "effective", "until", "limits", "force", "current", "next", "targets")
    return all(getattr(original, name) == getattr(changed, name) for name in names)


def _same_truth(build: Build, original: Regulation, changed: Regulation) -> bool:
    """A prohibition counts by itself; a permission only together with what it is an exception to."""
    contexts = [other for other in build.regulations if other.id in original.targets] if original.legality else [None]
    return all(_same_in(build, original, changed, other) for other in contexts)


def _same_in(build: Build, original: Regulation, changed: Regulation, context: Regulation | None) -> bool:
    rows = (original, changed) if context is None else (original, changed, context)
    domains = _domains(build, rows)
    if domains is None:
        return False
    return all(_outcome(original, context, row) == _outcome(changed, context, row) for row in _rows(domains)) and _is_small(domains)


def _outcome(rule: Regulation, context: Regulation | None, row: _Row) -> Truth:
    return _holds(rule, row) if context is None else conjoin((_holds(context, row), negate(_holds(rule, row))))


def _holds(rule: Regulation, row: _Row) -> Truth:
    return conjoin((evaluate(rule.when, row), True if rule.unless is None else negate(evaluate(rule.unless, row))))


def _is_small(domains: Domains) -> bool:
    size = 1
    for values in domains.values():
        size *= len(values)
    return size <= TABLE


def _rows(domains: Domains) -> Iterator[_Row]:
    """Some random rows, then all of them where the table is small."""
    guess = random.Random(_SEED)
    for _ in range(GUESSES):
        yield _Row({fact: guess.choice(values) for fact, values in domains.items()})
    if _is_small(domains):
        for values in islice(product(*domains.values()), TABLE):
            yield _Row(dict(zip(domains, values, strict=True)))


def _domains(build: Build, rules: tuple[Regulation, ...]) -> Domains | None:
    """Fact -> values that between them show everything a condition can tell apart, and unknown; None where numbers are mixed."""
    found: dict[str, list[Literal]] = {}
    for node in (node for rule in rules for node in (rule.when, rule.unless) if node is not None):
        for literal in literals(node):
            fact = _only_fact(literal)
            if fact is None or isinstance(literal, Known):
                return None
            if fact:
                found.setdefault(fact, []).append(literal)
    return {fact: (*_values(build, fact, tuple(uses)), None) for fact, uses in found.items()}


def _only_fact(literal: Literal) -> str | None:
    """The one fact a literal reads, empty for a constant, None where it mixes several."""
    if isinstance(literal, Const):
        return ""
    if isinstance(literal, Compare):
        names = {fact for side in (literal.left, literal.right) for _, fact in side.terms}
        return next(iter(names)) if len(names) == 1 else None
    return literal.fact


def _values(build: Build, fact: str, uses: tuple[Literal, ...]) -> tuple[Value, ...]:
    first = uses[0]
    if isinstance(first, Is):
        return (True, False)
    if isinstance(first, OneOf):
        named = dict.fromkeys(word for use in uses if isinstance(use, OneOf) for word in use.words)
        others = [word for word in build.corpus.vocabulary.fact(fact).values if word not in named]
        return (*named, *others[:1])
    if isinstance(first, Has):
        words = tuple(dict.fromkeys(use.word for use in uses if isinstance(use, Has)))
        return tuple(frozenset(w for w, on in zip(words, choice, strict=True) if on) for choice in product((True, False), repeat=len(words)))
    return _numbers(uses)


def _numbers(uses: tuple[Literal, ...]) -> tuple[Value, ...]:
    """Every number at which something changes, one between each two, and one beyond either end."""
    ends: set[float] = set()
    for use in uses:
        if isinstance(use, Within):
            ends.update((use.start, use.end))
        elif isinstance(use, Compare):
            slope = sum(c for c, _ in use.left.terms) - sum(c for c, _ in use.right.terms)
            ends.add((use.right.constant - use.left.constant) / slope if slope else 0.0)
    points = sorted(ends)
    between = [(a + b) / 2 for a, b in pairwise(points)]
    return tuple(sorted({points[0] - 1, *points, *between, points[-1] + 1}))
