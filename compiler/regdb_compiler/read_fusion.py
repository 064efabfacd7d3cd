"""Declared fusion -> each fact's rules of belief: what a fact leaves out its class says; what does not fit is reported."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass, field, replace
from typing import TypeVar

from regdb.fusion_policy import CORROBORATORS, FusionPolicy, Permissive, Reach
from regdb.units import UnitError, parse_quantity
from regdb.vocabulary import Fact, FactError
from regdb_compiler import documents
from regdb_compiler.diagnostics import Diagnostic, Place
from regdb_compiler.parse import place_at
from regdb_compiler.source import SourceFile

FUSION_RULES = (
    ("R413", "bad-fusion", "How statements on a fact are fused does not fit together: class, reach, values, bounds or facts named."),
)
_T = TypeVar("_T")
FUSED = frozenset(("perception", "map"))
"""Sources of facts of which several can speak; ego, plan, history and clock have one teller each, who is exact."""


@dataclass(frozen=True)
class _Written:
    """One fact's declaration with its file, and that file's class."""

    doc: documents.Fact
    file: SourceFile
    usual: str


@dataclass
class FusionReader:
    """Collects classes and declarations file by file; `complete` gives every fact its policy once all files are read."""

    ages: dict[str, tuple[documents.Age, SourceFile]] = field(default_factory=dict)
    written: dict[str, _Written] = field(default_factory=dict)
    problems: list[Diagnostic] = field(default_factory=list)

    def take(self, doc: documents.VocabularyFile, file: SourceFile, names: Collection[str]) -> None:
        """The classes of a file, and the declarations of those of its facts that were accepted."""
        for name, age in doc.ages.items():
            if name in self.ages:
                self.problems.append(_bad(file, f"the class `{name}` is declared twice", ("ages", name)))
            else:
                self.ages[name] = age, file
        self.written.update({name: _Written(item, file, doc.fusion) for name, item in doc.facts.items() if name in names})

    def complete(self, facts: dict[str, Fact]) -> tuple[dict[str, Fact], list[Diagnostic]]:
        """The facts, each with its policy where it has one, and every reason why one has none."""
        found = dict(facts)
        for name, fact in facts.items():
            written = self.written[name]
            try:
                policy = self._policy(fact, written)
            except (FactError, UnitError) as error:
                self.problems.append(_bad(written.file, f"fusion of `{name}`: {error}", ("facts", name)))
                continue
            if policy is not None:
                self.problems += [_bad(written.file, f"fusion of `{name}`: {why}", ("facts", name)) for why in _strangers(policy, facts)]
                found[name] = replace(fact, fusion=policy)
        return found, self.problems

    def _policy(self, fact: Fact, written: _Written) -> FusionPolicy | None:
        own = written.doc.fusion
        if fact.source not in FUSED:
            if own != documents.Fusion():
                raise FactError(f"a fact of the {fact.source} has one teller and is not fused")
            return None
        name = own.ages or (written.usual if self._claims(written.usual, fact) else "") or self._by_source(fact.source)
        if not name:
            return None
        if name not in self.ages:
            raise FactError(f"there is no class {name!r}; declared: {', '.join(sorted(self.ages)) or 'none'}")
        return read_policy(fact, name, self.ages[name][0], own)

    def _claims(self, usual: str, fact: Fact) -> bool:
        """A file's class is for the facts of perception; what the map tells ages as the map does."""
        return bool(usual) and fact.source == "perception"

    def _by_source(self, source: str) -> str:
        return next((name for name, (age, _) in sorted(self.ages.items()) if source in age.sources), "")


def read_policy(fact: Fact, name: str, age: documents.Age, own: documents.Fusion) -> FusionPolicy:
    """A fact's policy out of its class and what it says itself. Raises FactError or UnitError."""
    plausible = own.plausible or age.plausible or documents.Plausible()
    return FusionPolicy(
        name, read_reach(own.holds or age.holds), read_reach(own.fresh or age.fresh),
        max(own.confirm or age.confirm or 2, 1), _seconds(own.within or age.within or "2 s"), _seconds(own.apart or age.apart or "0 s"),
        read_permissive(fact, own.permissive or age.permissive), _sources(_first(own.corroborate, age.corroborate)),
        True if (later := _first(own.replaced, age.replaced)) is None else later, _strictest(fact, own.strictest or age.strictest),
        _number(fact, plausible.min), _number(fact, plausible.max), _number(fact, plausible.step), own.asks or age.asks,
        own.question or age.question, _first(own.ends, age.ends) or (), _first(own.places, age.places) or (), own.because,
    )  # fmt: skip


def _first(own: _T | None, inherited: _T | None) -> _T | None:
    return inherited if own is None else own


def read_reach(texts: tuple[str, ...]) -> Reach:
    """`2 s`, `120 m`, or both. Raises FactError or UnitError."""
    bounds = {"duration": float("inf"), "length": float("inf")}
    for text in texts:
        quantity = parse_quantity(text)
        if quantity.dimension not in bounds or quantity.si < 0:
            raise FactError(f"{text!r} is neither a time nor a distance")
        bounds[quantity.dimension] = quantity.si
    return Reach(bounds["duration"], bounds["length"])


def read_permissive(fact: Fact, texts: tuple[str, ...]) -> Permissive:
    """Which values permit. Default: what the fact quietly is, false or none; of numbers and sets every one must be confirmed."""
    if texts == ("nothing",):
        return Permissive()
    if fact.is_numeric:
        return _beyond(fact, texts)
    possible: tuple[bool | str, ...] = (True, False) if fact.kind == "boolean" else fact.values
    if texts == ("all",) or (not texts and fact.kind == "set"):
        return Permissive(possible)
    if not texts:
        return Permissive((False,) if fact.kind == "boolean" else tuple(word for word in fact.values if word == "none"))
    return Permissive(tuple(_value(fact, text) for text in texts))


def _value(fact: Fact, text: str) -> bool | str:
    found = fact.read([text] if fact.kind == "set" else text)
    if isinstance(found, frozenset):
        return text
    if not isinstance(found, (bool, str)):
        raise FactError(f"{text!r} is no value that could permit")
    return found


def _beyond(fact: Fact, texts: tuple[str, ...]) -> Permissive:
    above = below = None
    for text in () if texts in ((), ("all",)) else texts:
        sign, number = text[:1], _number(fact, text[1:].strip())
        if sign not in "<>" or number is None:
            raise FactError(f"write what permits as `> 25 {fact.unit}` or `< 25 {fact.unit}`, not {text!r}")
        above, below = (number, below) if sign == ">" else (above, number)
    return Permissive((), above, below)


def _strictest(fact: Fact, words: tuple[str, ...]) -> tuple[str, ...]:
    for word in words:
        _value(fact, word)
    return words


def _number(fact: Fact, text: str) -> float | None:
    if not text:
        return None
    if not fact.is_numeric:
        raise FactError("only numbers have bounds")
    found = fact.read(text)
    return None if found is None or isinstance(found, (str, frozenset)) else float(found)


def _seconds(text: str) -> float:
    quantity = parse_quantity(text)
    if quantity.dimension != "duration":
        raise FactError(f"{text!r} is no time")
    return quantity.si


def _sources(words: tuple[str, ...] | None) -> tuple[str, ...]:
    for word in words or ():
        if word not in CORROBORATORS:
            raise FactError(f"{word!r} cannot corroborate; one of: {', '.join(CORROBORATORS)}")
    return words or ()


def _strangers(policy: FusionPolicy, facts: dict[str, Fact]) -> Iterator[str]:
    """Facts named that are not there, or cannot stand where they are named."""
    for role, names in (("asks", policy.asks), ("ends", tuple(name for name in policy.ends if name != "map")), ("places", policy.places)):
        for text in names:
            name, _, value = text.partition("=")
            fact = facts.get(name)
            if fact is None:
                yield f"`{role}` names `{name}`, which is no fact"
            elif value and value not in fact.values:
                yield f"`{role}` names `{text}`, which is no value of it"
            elif not value and fact.kind != "boolean":
                yield f"`{role}` needs a boolean fact, or fact=value: `{name}` is a {fact.kind}"


def _bad(file: SourceFile, message: str, path: tuple[str, ...]) -> Diagnostic:
    assert file.root is not None
    place = place_at(file.root, path)
    if place.end_line != place.line:
        place = Place(place.path, place.line, place.column, place.line, place.column + 1)
    return Diagnostic("R413", "bad-fusion", "error", message, place)
