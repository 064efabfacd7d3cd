"""The facts of a neutral conformance case, their types inferred from conditions, scene, plan, policy and limits."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

from regdb_compiler.parse_condition import read_linear, read_raw
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
from regdb_compiler.type_condition import Problem

from regdb.units import UnitError, parse_quantity

CONSTANTS = {"true", "false"}


@dataclass
class NeutralFact:
    """What is known of a fact: its kind once something tells it, its words, its unit."""

    kind: str = ""
    words: dict[str, None] = field(default_factory=dict)
    unit: str = ""

    def learn(self, kind: str) -> None:
        """What one mention tells; a set or enumeration is told by its words, which do not contradict each other."""
        self.kind = self.kind or kind


class _Facts:
    """Facts by name while the case is gone through."""

    def __init__(self) -> None:
        self.by_name: dict[str, NeutralFact] = {}
        self.unsure: list[RawCompare] = []

    def get(self, name: str) -> NeutralFact:
        return self.by_name.setdefault(name, NeutralFact())


def infer_facts(case: dict[str, Any]) -> dict[str, NeutralFact]:
    """Fact -> kind, words and unit. A fact that nothing tells the kind of is a boolean."""
    facts = _Facts()
    for name, value in _told(case):
        _from_value(facts, name, value)
    for rule in case.get("rules") or []:
        for key in ("when", "unless"):
            if rule.get(key) is not None and not isinstance(rule[key], bool):
                raw = read_raw(str(rule[key]))
                if not isinstance(raw, Problem):
                    _from_condition(facts, raw)
        for name, bound in (rule.get("limits") or {}).items():
            _from_limit(facts, str(name), str(bound))
    for item in facts.unsure:
        _from_equation(facts, item)
    for fact in facts.by_name.values():
        fact.learn("boolean")
    return facts.by_name


def _told(case: dict[str, Any]) -> Iterator[tuple[str, object]]:
    yield from (case.get("scene") or {}).items()
    for name, value in (case.get("plan") or {}).items():
        if name not in {"current", "next"}:
            yield name, value
    for name, policy in (case.get("policy") or {}).items():
        yield name, policy["assume"]
    for name in case.get("facts") or []:
        yield name, "unknown"


def _from_value(facts: _Facts, name: str, value: object) -> None:
    fact = facts.get(str(name))
    if value is None or value == "unknown":
        return
    if isinstance(value, bool):
        fact.learn("boolean")
    elif isinstance(value, (int, float)):
        fact.learn("count")
    elif isinstance(value, (list, tuple)):
        fact.learn("set")
        fact.words.update(dict.fromkeys(map(str, value)))
    else:
        _from_text(fact, str(value))


def _from_text(fact: NeutralFact, text: str) -> None:
    try:
        unit = parse_quantity(text).unit.symbol
    except UnitError:
        if ":" in text:
            fact.learn("time")
        elif len(text) == 10 and text[4] == text[7] == "-":
            fact.learn("date")
        else:
            fact.learn("enumeration")
            fact.words[text] = None
        return
    fact.learn("quantity" if unit else "count")
    fact.unit = fact.unit or unit


def _from_condition(facts: _Facts, raw: Raw) -> None:
    match raw:
        case RawJoin(_, parts):
            for part in parts:
                _from_condition(facts, part)
        case RawNot(part):
            _from_condition(facts, part)
        case RawKnown(name):
            facts.get(name.text)
        case RawName(name):
            if name.text not in CONSTANTS:
                facts.get(name.text).learn("boolean")
        case RawOneOf(name, words):
            facts.get(name.text).learn("enumeration")
            facts.get(name.text).words.update(dict.fromkeys(word.text for word in words))
        case RawHas(word, name):
            facts.get(name.text).learn("set")
            facts.get(name.text).words[word.text] = None
        case RawWithin(name, start, _):
            facts.get(name.text).learn(start.kind.lower())
        case RawCompare():
            _from_compare(facts, raw)


def _from_compare(facts: _Facts, raw: RawCompare) -> None:
    """`color == red` may be a word or another number; it is settled when all else has been seen."""
    if raw.op.text in {"==", "!="} and _lone(raw.left) and _lone(raw.right):
        facts.get(raw.left[0].factors[0].text)
        facts.unsure.append(raw)
    else:
        _from_numbers(facts, (*raw.left, *raw.right))


def _from_equation(facts: _Facts, raw: RawCompare) -> None:
    left, right = raw.left[0].factors[0].text, raw.right[0].factors[0].text
    fact = facts.get(left)
    if right in CONSTANTS:
        fact.learn("boolean")
    elif fact.kind in {"", "enumeration"} and (right not in facts.by_name or fact.kind or facts.by_name[right].kind == "boolean"):
        fact.learn("enumeration")
        fact.words[right] = None
    else:
        _from_numbers(facts, (*raw.left, *raw.right))


def _from_numbers(facts: _Facts, terms: tuple[RawTerm, ...]) -> None:
    """Facts compared with each other share kind and unit; a unit beside a number makes them quantities."""
    words = [word for term in terms for word in term.factors]
    named = [facts.get(word.text) for word in words if word.kind == "NAME"]
    units = [parse_quantity(word.text).unit.symbol for word in words if word.kind == "QUANTITY"] + [fact.unit for fact in named if fact.unit]
    moment = next((word.kind.lower() for word in words if word.kind in {"TIME", "DATE"}), "")
    kind = moment or next((fact.kind for fact in named if fact.kind), "") or ("quantity" if units else "count")
    for fact in named:
        fact.learn(kind)
        if fact.kind == "quantity" and units:
            fact.unit = fact.unit or units[0]


def _from_limit(facts: _Facts, attribute: str, bound: str) -> None:
    """`max_speed` bounds the plan's quantity `speed`; a fact may stand for the number."""
    quantity = Word(attribute.partition("_")[2], "NAME", 0, 0)
    terms = read_linear(bound)
    if not isinstance(terms, Problem):
        _from_numbers(facts, (RawTerm(1, (quantity,)), *terms))


def _lone(terms: tuple[RawTerm, ...]) -> bool:
    return len(terms) == 1 and terms[0].sign == 1 and len(terms[0].factors) == 1 and terms[0].factors[0].kind == "NAME"
