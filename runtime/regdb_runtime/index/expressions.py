"""A condition as two Python expressions over the flat list: `possibly` (not known false) and `surely` (known true).

Kleene's three values come apart into two classical ones: possibly(not c) is not surely(c), and and/or pass through.
No text of the database reaches the source: facts become list indices, words and odd numbers names of constants.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from regdb.condition import COMPARISONS, OPPOSITE, And, Compare, Const, Has, Is, Known, Linear, Node, Not, OneOf, Or, Within
from regdb_runtime.index.closures import condition, slot_of
from regdb_runtime.index.conjuncts import depth
from regdb_runtime.index.slots import FactTable

_DEEPEST = 12


class Expressions:
    """Writes expressions and keeps the constants they name in `names`."""

    def __init__(self, table: FactTable) -> None:
        self.table = table
        self.names: dict[str, Any] = {"__builtins__": {}}
        self._held: dict[object, str] = {}
        self._written: dict[Node, tuple[str, str]] = {}

    def pair(self, node: Node) -> tuple[str, str]:
        """The expressions (possibly, surely) of a part of a condition; deep ones call an exact function."""
        found = self._written.get(node)
        if found is None:
            found = self._call(node) if depth(node) > _DEEPEST else (self.write(node, possible=True), self.write(node, possible=False))
            self._written[node] = found
        return found

    def hold(self, value: Any, key: object) -> str:
        """The name of a constant in the generated code."""
        name = self._held.get(key)
        if name is None:
            name = self._held[key] = f"k{len(self._held)}"
            self.names[name] = value
        return name

    def _call(self, node: Node) -> tuple[str, str]:
        name = self.hold(condition(node, self.table), ("condition", node))
        return f"({name}(f) is not False)", f"({name}(f) is True)"

    def write(self, node: Node, *, possible: bool) -> str:
        """One expression: whether the node is possibly (`possible`) or surely true."""
        match node:
            case And(parts):
                return self._join(" and ", parts, possible) if parts else "True"
            case Or(parts):
                return self._join(" or ", parts, possible) if parts else "False"
            case Not(part):
                return self._negated(part, possible)
            case Const(value):
                return "True" if value else "False"
            case Known(fact):
                slot_of(fact, self.table)
                name = self.hold(fact, ("word", fact))
                return f"({name} in f[{self.table.scene_slot}] or {name} in f[{self.table.plan_slot}])"
            case Is(fact):
                return f"(f[{slot_of(fact, self.table)}] {'is not False' if possible else 'is True'})"
            case OneOf(fact, words):
                chosen = (*words, None) if possible else words
                return f"(f[{slot_of(fact, self.table)}] in {self.hold(frozenset(chosen), ('words', frozenset(chosen)))})"
            case Has(fact, word):
                return self._guard(slot_of(fact, self.table), f"{self.hold(word, ('word', word))} in x", possible)
            case Within(fact, start, end):
                joined = "and" if start <= end else "or"
                return self._guard(slot_of(fact, self.table), f"(x >= {int(start)} {joined} x < {int(end)})", possible)
            case Compare():
                return self._compare(node, possible)

    def _join(self, word: str, parts: tuple[Node, ...], possible: bool) -> str:
        return "(" + word.join(self.write(part, possible=possible) for part in parts) + ")"

    def _negated(self, node: Node, possible: bool) -> str:
        match node:
            case Is(fact):
                return f"(f[{slot_of(fact, self.table)}] {'is not True' if possible else 'is False'})"
            case Compare():
                return self._compare(Compare(OPPOSITE[node.op], node.left, node.right), possible)
            case _:
                return f"(not {self.write(node, possible=not possible)})"

    def _guard(self, slot: int, test: str, possible: bool) -> str:
        """A test of x, the value in a slot, with what an unknown value makes of it."""
        unknown = "is None or" if possible else "is not None and"
        return f"((x := f[{slot}]) {unknown} {test})"

    def _compare(self, node: Compare, possible: bool) -> str:
        if node.op not in COMPARISONS:
            raise ValueError(f"unknown comparison {node.op!r}")
        slots = [slot_of(fact, self.table) for side in (node.left, node.right) for _, fact in side.terms]
        if len(slots) == 1:
            test = f"{self._linear(node.left, lambda _: 'x')} {node.op} {self._linear(node.right, lambda _: 'x')}"
            return self._guard(slots[0], test, possible)
        test = f"{self._linear(node.left, self._cell)} {node.op} {self._linear(node.right, self._cell)}"
        unknown = [f"f[{slot}] {'is None' if possible else 'is not None'}" for slot in dict.fromkeys(slots)]
        return "(" + (" or " if possible else " and ").join([*unknown, test]) + ")"

    def _cell(self, fact: str) -> str:
        return f"f[{slot_of(fact, self.table)}]"

    def _linear(self, expression: Linear, cell: Callable[[str], str]) -> str:
        """A sum in the same order of operations as the reference, so that rounding agrees."""
        terms = expression.terms
        if len(terms) == 1 and expression.constant == 0 and terms[0][0] == 1:
            return cell(terms[0][1])
        parts = [self.number(expression.constant), *(f"{self.number(coefficient)} * {cell(fact)}" for coefficient, fact in terms)]
        return "(" + " + ".join(parts) + ")"

    def number(self, value: float) -> str:
        """A number as source: its shortest form where that is plain digits, else the name of a constant."""
        number = float(value)
        if math.isfinite(number) and number >= 0:
            return repr(number)
        return self.hold(number, ("number", repr(number)))
