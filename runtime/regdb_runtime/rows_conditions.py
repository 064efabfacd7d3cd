"""Condition trees from the JSON of many rows at once: equal literals become one object, every fact is checked against the vocabulary."""

from __future__ import annotations

import json
from collections.abc import Collection, Sequence
from marshal import dumps
from typing import Any

from regdb.condition import And, Const, Linear, Literal, Node, Not, Or, literal_facts
from regdb.condition_text import from_data, linear_from_data
from regdb_runtime.errors import DatabaseDamaged


class ConditionReader:
    """Reads trees and linear expressions; holds the literals met so far."""

    def __init__(self, facts: Collection[str]) -> None:
        self._facts = facts
        self._literals: dict[bytes, Literal] = {}

    def trees(self, texts: Sequence[str | None]) -> list[Node | None]:
        """One tree per text, None where the text is None. Raises DatabaseDamaged for what is no tree or reads no known fact."""
        return [None if data is None else self._tree(data) for data in _parse(texts)]

    def linears(self, texts: Sequence[str]) -> list[Linear]:
        """One linear expression per text. Raises DatabaseDamaged."""
        found = []
        for data in _parse(texts):
            try:
                expression = linear_from_data(data)
            except (TypeError, ValueError) as error:
                raise DatabaseDamaged(f"the bound {json.dumps(data)} is no linear expression") from error
            for _, fact in expression.terms:
                self._check(fact)
            found.append(expression)
        return found

    def _tree(self, data: Any) -> Node:
        try:
            return self._node(data)
        except (TypeError, ValueError, IndexError, KeyError, AttributeError, RecursionError) as error:
            raise DatabaseDamaged(f"the condition {json.dumps(data)[:200]} is no condition tree") from error

    def _node(self, data: Any) -> Node:
        kind = data[0]
        if kind == "and" or kind == "or":
            return (And if kind == "and" else Or)(tuple([self._node(part) for part in data[1:]]))
        if kind == "not" and len(data) == 2:
            return Not(self._node(data[1]))
        key = dumps(data, 2)
        return self._literals.get(key) or self._literals.setdefault(key, self._literal(data))

    def _literal(self, data: Any) -> Literal:
        node = from_data(data)
        if isinstance(node, (And, Or, Not)):
            raise ValueError(data)
        if not isinstance(node, Const):
            for fact in literal_facts(node):
                self._check(fact)
        return node

    def _check(self, fact: str) -> None:
        if fact not in self._facts:
            raise DatabaseDamaged(f"a condition reads the fact {fact!r}, which the vocabulary of this database lacks")


def _parse(texts: Sequence[str | None]) -> list[Any]:
    """The JSON of all texts, read as one array; where that fails, one by one to name the culprit."""
    joined = ",".join(["null" if text is None else text for text in texts])
    try:
        data = json.loads(f"[{joined}]")
    except ValueError:
        data = []
    return data if len(data) == len(texts) else [_parse_one(text) for text in texts]


def _parse_one(text: str | None) -> Any:
    try:
        return None if text is None else json.loads(text)
    except ValueError as error:
        raise DatabaseDamaged(f"{text[:200] if text else text!r} is not JSON") from error

