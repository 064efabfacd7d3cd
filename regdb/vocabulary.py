"""The words conditions are made of: facts with type, unit, source and meaning; attributes that bound a plan."""

from __future__ import annotations

import datetime
import difflib
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field

from regdb.fusion_policy import FusionPolicy
from regdb.units import UnitError, parse_quantity, show_si, unit_named

Value = bool | float | int | str | frozenset[str]
"""A known value: truth, SI number, count, seconds of the day, day number, word, or set of words."""

KINDS = ("boolean", "enumeration", "set", "quantity", "count", "time", "date")
SOURCES = ("ego", "map", "perception", "clock", "plan", "history")


class FactError(ValueError):
    """A fact that is not in the vocabulary, or a value it cannot have."""


@dataclass(frozen=True, slots=True)
class Assumption:
    """What stands in for a fact that is not known: the value, the sensing range it is good for, and why."""

    value: Value
    within: str = ""
    because: str = ""


@dataclass(frozen=True, slots=True)
class Fact:
    """One fact of the scene or plan. `values` are an enumeration's or set's words, `unit` a quantity's usual unit.

    `entails`: boolean facts that are true whenever words reveal this one (true, or any value but none).
    `fusion`: how statements on it are believed and forgotten; None where nobody but its one teller says anything of it.
    """

    name: str
    kind: str
    meaning: str = ""
    source: str = "perception"
    values: tuple[str, ...] = ()
    unit: str = ""
    assumption: Assumption | None = None
    quiet: Value | None = None
    phrases: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    confusables: tuple[str, ...] = ()
    codes: Mapping[str, str] = field(default_factory=dict)
    entails: tuple[str, ...] = ()
    fusion: FusionPolicy | None = None

    @property
    def dimension(self) -> str:
        """The dimension of its numbers; `number` for counts, `time` and `date` for those, empty for the rest."""
        if self.kind == "quantity":
            return unit_named(self.unit).dimension
        return {"count": "number", "time": "time", "date": "date"}.get(self.kind, "")

    @property
    def is_numeric(self) -> bool:
        return self.kind in {"quantity", "count", "time", "date"}

    def read(self, text: object) -> Value | None:
        """A value a person wrote (`unknown`, `25 mph`, `red`, `"07:30"`, a list) as this fact's value; None is unknown.

        Raises FactError, saying what would be right.
        """
        if text is None or text == "unknown":
            return None
        if self.kind == "boolean":
            return _read_boolean(self, text)
        if self.kind == "enumeration":
            return self._word(str(text))
        if self.kind == "set":
            return frozenset(self._word(str(item)) for item in _items(text))
        if self.kind == "time":
            return read_time(str(text))
        if self.kind == "date":
            return read_date(str(text))
        return self._number(text)

    def show(self, value: Value | None) -> str:
        """A value of this fact as a person writes it."""
        if value is None:
            return "unknown"
        if self.kind == "boolean":
            return "true" if value else "false"
        if isinstance(value, frozenset):
            return "[" + ", ".join(sorted(value)) + "]"
        if isinstance(value, str):
            return value
        return show_value(float(value), self.kind, self.unit)

    def _word(self, text: str) -> str:
        if text in self.values:
            return text
        near = difflib.get_close_matches(text, self.values, 1)
        hint = f"did you mean {near[0]}? " if near else ""
        raise FactError(f"{self.name} cannot be {text!r}; {hint}it is one of: {', '.join(self.values)}")

    def _number(self, text: object) -> Value:
        if isinstance(text, bool):
            raise FactError(f"{self.name} is a {self.kind}, not {str(text).lower()}")
        try:
            quantity = parse_quantity(str(text))
        except UnitError as error:
            raise FactError(f"{self.name}: {error}") from None
        if quantity.dimension != self.dimension:
            want = f"a number with a unit of {self.dimension}, such as `{self.unit}`" if self.unit else "a bare number"
            raise FactError(f"{self.name} takes {want}, not {str(text)!r}")
        return quantity.si


def _read_boolean(fact: Fact, text: object) -> bool:
    if isinstance(text, bool):
        return text
    if text in ("true", "false"):
        return text == "true"
    raise FactError(f"{fact.name} is true, false or unknown, not {str(text)!r}")


def _items(text: object) -> Iterable[object]:
    if isinstance(text, (list, tuple, set, frozenset)):
        return text
    return [part for part in str(text).strip("[]{}").replace(",", " ").split() if part]


def read_time(text: str) -> int:
    """Seconds since midnight of `7:00`, `07:30` or `07:30:15`; `24:00` is the day's end. Raises FactError."""
    parts = text.split(":")
    if len(parts) in (2, 3) and all(part.isdigit() and len(part) <= 2 for part in parts):
        hour, minute, second = (int(part) for part in [*parts, "0"][:3])
        total = hour * 3600 + minute * 60 + second
        if minute < 60 and second < 60 and total <= 86400:
            return total
    raise FactError(f"{text!r} is no time of day; write it as 07:30")


def read_date(text: str) -> int:
    """Day number (proleptic Gregorian ordinal) of an ISO date. Raises FactError."""
    try:
        if len(text) != 10:
            raise ValueError
        return datetime.date.fromisoformat(text).toordinal()
    except ValueError:
        raise FactError(f"{text!r} is no date; write it as 2026-03-02") from None


def show_value(value: float, kind: str, unit: str) -> str:
    """A number of a fact of this kind, as a person writes it."""
    if kind == "time":
        return f"{int(value) // 3600:02d}:{int(value) % 3600 // 60:02d}" + (f":{int(value) % 60:02d}" if value % 60 else "")
    if kind == "date":
        return datetime.date.fromordinal(int(value)).isoformat()
    return show_si(value, unit)


@dataclass(frozen=True, slots=True)
class Attribute:
    """A word authors bound plans or scope rules with. `limit` bounds a quantity; `scope` asks a fact to match."""

    name: str
    kind: str
    fact: str
    direction: str = ""
    meaning: str = ""


class Vocabulary:
    """Every fact and attribute by name; the one source for types, completion, prompts and lexicon.

    `words`: classes of words that phrases name in braces; the class `swallow` holds phrases that reveal nothing.
    """

    def __init__(
        self, facts: Iterable[Fact] = (), attributes: Iterable[Attribute] = (), words: Mapping[str, tuple[str, ...]] | None = None
    ) -> None:
        self.words: Mapping[str, tuple[str, ...]] = words or {}
        self.facts: dict[str, Fact] = {fact.name: fact for fact in facts}
        self.attributes: dict[str, Attribute] = {item.name: item for item in attributes}

    def __contains__(self, name: str) -> bool:
        return name in self.facts

    def __iter__(self) -> Iterator[Fact]:
        return iter(self.facts.values())

    def __len__(self) -> int:
        return len(self.facts)

    def fact(self, name: str) -> Fact:
        """The fact with this name. Raises FactError with the nearest name there is."""
        try:
            return self.facts[name]
        except KeyError:
            raise FactError(f"unknown fact {name!r}{self.hint(name)}") from None

    def nearest(self, name: str) -> str | None:
        """The fact whose name is nearest, if any is near."""
        found = difflib.get_close_matches(name, self.facts, 1, 0.6)
        if found:
            return found[0]
        tail = [fact for fact in self.facts if fact.rsplit(".", 1)[-1] == name.rsplit(".", 1)[-1]]
        return tail[0] if len(tail) == 1 else None

    def hint(self, name: str) -> str:
        near = self.nearest(name)
        return f"; did you mean {near}?" if near else ""
