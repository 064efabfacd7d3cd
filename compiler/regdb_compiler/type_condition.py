"""Raw condition -> typed condition tree: every word is looked up, every quantity has a dimension, everything is in SI."""

from __future__ import annotations

import difflib
from collections.abc import Callable
from dataclasses import dataclass

from regdb.condition import FALSE, TRUE, And, Compare, Has, Is, Known, Linear, Node, Not, OneOf, Or, Within
from regdb.units import parse_quantity
from regdb.vocabulary import Fact, FactError, Vocabulary, read_date, read_time
from regdb_compiler.raw_condition import (
    Raw,
    RawCompare,
    RawHas,
    RawJoin,
    RawKnown,
    RawName,
    RawNot,
    RawOneOf,
    RawTerm,
    RawWithin,
    Word,
)


@dataclass(frozen=True, slots=True)
class Problem:
    """Something wrong in a condition's text, between two offsets; `note` says what would be right."""

    code: str
    name: str
    message: str
    start: int
    end: int
    note: str = ""


@dataclass(frozen=True, slots=True)
class _Side:
    """One side of a comparison: the expression, its dimension ('' for a bare number), unit and kind for people."""

    linear: Linear
    dimension: str
    unit: str
    kind: str
    bare: Word | None


class Typer:
    """Types one condition; problems are collected, and a wrong part stands as `true` so that the rest is still checked."""

    def __init__(self, vocabulary: Vocabulary, definition: Callable[[str], Node | None]) -> None:
        self.vocabulary, self.definition = vocabulary, definition
        self.problems: list[Problem] = []
        self.uses: list[str] = []

    def truth(self, raw: Raw) -> Node:
        match raw:
            case RawJoin("and", parts):
                return And(tuple(p for part in parts for p in _flat(self.truth(part), And)))
            case RawJoin(_, parts):
                return Or(tuple(p for part in parts for p in _flat(self.truth(part), Or)))
            case RawNot(part):
                return Not(self.truth(part))
            case RawKnown(name):
                return Known(name.text) if self._fact(name) else TRUE
            case RawName(name):
                return self._name(name)
            case RawOneOf(name, words):
                return self._one_of(name, words)
            case RawHas(word, name):
                return self._has(word, name)
            case RawWithin(name, start, end):
                return self._within(name, start, end)
            case RawCompare(op, left, right):
                return self._compare(op, left, right)

    def _wrong(self, code: str, name: str, message: str, word: Word, note: str = "") -> None:
        self.problems.append(Problem(code, name, message, word.start, word.end, note))

    def _fact(self, name: Word) -> Fact | None:
        fact = self.vocabulary.facts.get(name.text)
        if fact is None:
            near = self.vocabulary.nearest(name.text)
            self._wrong("R401", "unknown-fact", f"unknown fact `{name.text}`", name, f"did you mean {near}?" if near else "no such fact")
        return fact

    def _name(self, name: Word) -> Node:
        if name.text in ("true", "false"):
            return TRUE if name.text == "true" else FALSE
        if name.text not in self.vocabulary:
            defined = self.definition(name.text)
            if defined is not None:
                self.uses.append(name.text)
                return defined
        fact = self._fact(name)
        if fact is None:
            return TRUE
        if fact.kind != "boolean":
            example = f"{fact.name} == {fact.values[0]}" if fact.values else f"{fact.name} > 10 {fact.unit}".rstrip()
            self._wrong("R403", "wrong-type", f"`{fact.name}` is no condition: it is a {fact.kind}", name, f"compare it: {example}")
            return TRUE
        return Is(fact.name)

    def _one_of(self, name: Word, words: tuple[Word, ...]) -> Node:
        fact = self._fact(name)
        if fact is None:
            return TRUE
        if fact.kind != "enumeration":
            hint = f"write `{words[0].text} in {fact.name}`" if fact.kind == "set" else "only enumerations have words to choose from"
            self._wrong("R403", "wrong-type", f"`{fact.name}` is a {fact.kind}, not an enumeration", name, hint)
            return TRUE
        good = sorted({word.text for word in words if self._word_of(fact, word)})
        return OneOf(fact.name, tuple(good))

    def _word_of(self, fact: Fact, word: Word) -> bool:
        if word.text in fact.values:
            return True
        near = difflib.get_close_matches(word.text, fact.values, 1)
        hint = f"did you mean {near[0]}? " if near else ""
        self._wrong("R402", "unknown-word", f"`{fact.name}` cannot be `{word.text}`", word, f"{hint}one of: {', '.join(fact.values)}")
        return False

    def _has(self, word: Word, name: Word) -> Node:
        fact = self._fact(name)
        if fact is None:
            return TRUE
        if fact.kind != "set":
            hint = f"write `{fact.name} == {word.text}`" if fact.kind == "enumeration" else f"`{fact.name}` is a {fact.kind}"
            self._wrong("R403", "wrong-type", f"`{fact.name}` is no set", name, hint)
            return TRUE
        return Has(fact.name, word.text) if self._word_of(fact, word) else TRUE

    def _within(self, name: Word, start: Word, end: Word) -> Node:
        fact = self._fact(name)
        if fact is None:
            return TRUE
        if fact.kind not in {"time", "date"} or start.kind.lower() != fact.kind or end.kind.lower() != fact.kind:
            hint = "`within` takes a time fact with times (07:00..16:00) or a date fact with dates"
            self._wrong("R403", "wrong-type", f"`{fact.name}` is a {fact.kind}", name, hint)
            return TRUE
        first, last = self._moment(start), self._moment(end)
        return TRUE if first is None or last is None else Within(fact.name, first, last, fact.kind)

    def _moment(self, word: Word) -> int | None:
        try:
            return read_time(word.text) if word.kind == "TIME" else read_date(word.text)
        except FactError as error:
            self._wrong("R017", "condition-syntax", str(error), word)
            return None

    def _compare(self, op: Word, left: tuple[RawTerm, ...], right: tuple[RawTerm, ...]) -> Node:
        lone, other = _lone_name(left), _lone_name(right)
        fact = self.vocabulary.facts.get(lone.text) if lone else None
        if lone is not None and fact is not None and fact.kind in {"boolean", "enumeration", "set"}:
            return self._equals(op, lone, fact, other, right)
        if lone is not None and fact is None and other is not None and other.text not in self.vocabulary:
            self._fact(lone)  # what it is compared with may be a word of it: only the fact is wrong for certain
            return TRUE
        a, b = self._side(left), self._side(right)
        if a is None or b is None:
            return TRUE
        dimension = a.dimension or b.dimension
        for side, opposite in ((a, b), (b, a)):
            if side.bare is not None and opposite.dimension not in {"", "number"}:
                unit = opposite.unit
                example = f"{side.bare.text} {unit}" if unit else "07:00" if opposite.dimension == "time" else "2026-03-02"
                self._wrong("R301", "missing-unit", f"`{side.bare.text}` has no unit", side.bare, f"write {example}")
                return TRUE
        if a.dimension and b.dimension and a.dimension != b.dimension:
            message = f"a {a.dimension} cannot be compared with a {b.dimension}"
            self.problems.append(Problem("R303", "dimension-mismatch", message, _start(left), _end(right)))
            return TRUE
        kind = {"time": "time", "date": "date", "number": "count", "": "count"}.get(dimension, "quantity")
        return Compare(op.text, a.linear, b.linear, kind, (b.unit if not b.linear.terms else a.unit) or a.unit or b.unit)

    def _equals(self, op: Word, name: Word, fact: Fact, other: Word | None, right: tuple[RawTerm, ...]) -> Node:
        if op.text not in {"==", "!="} or other is None:
            place = Word("", "", _start(right), _end(right))
            want = {"boolean": "true or false", "enumeration": "one of its words"}.get(fact.kind, "a word: `word in fact`")
            self._wrong("R403", "wrong-type", f"`{fact.name}` is a {fact.kind}", place, f"compare it by == or != with {want}")
            return TRUE
        if fact.kind == "set":
            self._wrong("R403", "wrong-type", f"`{fact.name}` is a set", name, f"write `{other.text} in {fact.name}`")
            return TRUE
        if fact.kind == "boolean":
            if other.text not in {"true", "false"}:
                self._wrong("R402", "unknown-word", f"`{fact.name}` cannot be `{other.text}`", other, "it is true or false")
                return TRUE
            wanted = (other.text == "true") == (op.text == "==")
            return Is(fact.name) if wanted else Not(Is(fact.name))
        if not self._word_of(fact, other):
            return TRUE
        node = OneOf(fact.name, (other.text,))
        return node if op.text == "==" else Not(node)

    def _side(self, terms: tuple[RawTerm, ...]) -> _Side | None:
        constant, found, dimension, unit, kind, bare = 0.0, [], "", "", "quantity", None
        for term in terms:
            read = self._term(term)
            if read is None:
                return None
            value, fact, own, own_unit = read
            if own and dimension and own != dimension:
                place = Word("", "", _start(terms), _end(terms))
                self._wrong("R303", "dimension-mismatch", f"a {dimension} and a {own} cannot be added", place)
                return None
            if fact is None and not own:
                bare = term.factors[0]
            dimension, unit = dimension or own, unit or own_unit
            if fact is None:
                constant += value
            else:
                found.append((value, fact))
        if bare is not None and dimension not in {"", "number"}:
            self._wrong("R301", "missing-unit", f"`{bare.text}` has no unit", bare, f"write {bare.text} {unit}".rstrip())
            return None
        return _Side(Linear(constant, tuple(found)), dimension, unit, kind, bare)

    def _term(self, term: RawTerm) -> tuple[float, str | None, str, str] | None:
        """coefficient, fact (None for a literal), dimension ('' for a bare number), unit."""
        names = [word for word in term.factors if word.kind == "NAME"]
        literals = [word for word in term.factors if word.kind != "NAME"]
        if len(names) > 1 or len(literals) > 1:
            word = Word("", "", term.factors[0].start, term.factors[-1].end)
            self._wrong("R017", "condition-syntax", "only a number can multiply a fact", word, "2 * lane.width")
            return None
        if not names:
            return self._literal(term.sign, literals[0])
        fact = self._fact(names[0])
        if fact is None:
            return None
        if not fact.is_numeric:
            self._wrong("R403", "wrong-type", f"`{fact.name}` is a {fact.kind}, not a number", names[0])
            return None
        if literals and literals[0].kind != "NUMBER":
            self._wrong("R303", "dimension-mismatch", "a fact is multiplied by a bare number only", literals[0])
            return None
        factor = float(literals[0].text) if literals else 1.0
        return term.sign * factor, fact.name, fact.dimension, fact.unit

    def _literal(self, sign: int, word: Word) -> tuple[float, None, str, str] | None:
        if word.kind in {"TIME", "DATE"}:
            moment = self._moment(word)
            return None if moment is None else (float(sign * moment), None, word.kind.lower(), "")
        quantity = parse_quantity(word.text)
        bare = word.kind == "NUMBER"
        return sign * quantity.si, None, "" if bare else quantity.dimension, quantity.unit.symbol


def _flat(node: Node, kind: type[And] | type[Or]) -> tuple[Node, ...]:
    return node.parts if isinstance(node, kind) else (node,)


def _lone_name(terms: tuple[RawTerm, ...]) -> Word | None:
    if len(terms) == 1 and terms[0].sign == 1 and len(terms[0].factors) == 1 and terms[0].factors[0].kind == "NAME":
        return terms[0].factors[0]
    return None


def _start(terms: tuple[RawTerm, ...]) -> int:
    return terms[0].factors[0].start


def _end(terms: tuple[RawTerm, ...]) -> int:
    return terms[-1].factors[-1].end


def type_limit(terms: tuple[RawTerm, ...], fact: Fact, vocabulary: Vocabulary) -> tuple[Linear | None, str, list[Problem]]:
    """A limit's bound (`25 mph`, `posted.speed`, `posted.speed - 5 mph`) for the quantity it bounds: bound, unit, problems."""
    typer = Typer(vocabulary, lambda _: None)
    side = typer._side(terms)
    if side is None:
        return None, "", typer.problems
    if side.bare is not None and fact.dimension != "number":
        typer._wrong("R301", "missing-unit", f"`{side.bare.text}` has no unit", side.bare, f"write {side.bare.text} {fact.unit}")
    elif side.dimension and side.dimension != fact.dimension:
        place = Word("", "", _start(terms), _end(terms))
        message = f"a {side.dimension} cannot bound `{fact.name}`, which is a {fact.dimension}"
        typer._wrong("R303", "dimension-mismatch", message, place)
    return (None if typer.problems else side.linear), side.unit or fact.unit, typer.problems

