"""Scene and plan as one flat list of values, a slot per fact, with assumptions already standing in for what is unknown."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from regdb.situation import Plan, Scene
from regdb.vocabulary import Fact, FactError, Value, Vocabulary

Values = list[Any]
"""One value per fact (None is unknown); the last two entries are the facts observed by the scene and told by the plan."""

_CLASS: dict[str, type] = {
    "boolean": bool, "enumeration": str, "set": frozenset, "quantity": float, "count": float, "time": float, "date": float,
}  # fmt: skip
"""The plain type of a fact's values; whole numbers may stand for numbers."""


class PreparedScene:
    """A scene encoded once, to be judged with any number of plans. `wrong` tells of values no fact of that kind can have."""

    __slots__ = ("scene", "table", "values", "wrong")

    def __init__(self, table: FactTable, scene: Scene, values: Values, wrong: tuple[str, ...] = ()) -> None:
        self.table, self.scene, self.values, self.wrong = table, scene, values, wrong


class FactTable:
    """The slot of every fact in the vocabulary, and the encoding of scenes and plans into them."""

    def __init__(self, vocabulary: Vocabulary) -> None:
        self.vocabulary = vocabulary
        self.slots = {fact.name: slot for slot, fact in enumerate(vocabulary)}
        self.scene_slot, self.plan_slot = len(self.slots), len(self.slots) + 1
        self._expected: dict[str, tuple[int, type | None]] = {f.name: (self.slots[f.name], _CLASS[f.kind]) for f in vocabulary}
        self._nowhere: tuple[int, type | None] = (0, None)
        self._empty: dict[frozenset[str], Values] = {}

    def prepare(self, scene: Scene) -> PreparedScene:
        """Encode a scene. Values that are None are unknown; NaN is unknown and nothing is assumed in its place."""
        values = self._unknown(scene.silent).copy()
        if not self._fill(values, scene.facts):
            return self._prepare_odd(scene)
        values[-2] = scene.facts
        return PreparedScene(self, scene, values)

    def with_plan(self, prepared: PreparedScene, plan: Plan) -> Values | None:
        """The values of a prepared scene with the plan's own over them; None when the plan has a value that needs a second look."""
        values = prepared.values.copy()
        if plan.facts and not self._fill(values, plan.facts):
            return None
        values[-1] = plan.facts
        return values

    def _fill(self, values: Values, facts: Mapping[str, Value]) -> bool:
        """Put facts in their slots; False as soon as one is not plainly a value of its kind. (Every verdict passes here.)"""
        find, nowhere = self._expected.get, self._nowhere
        for name, value in facts.items():
            slot, kind = find(name, nowhere)
            if (value.__class__ is kind and value == value) or (kind is float and value.__class__ is int):
                values[slot] = value
            elif kind is not None:
                return False
        return True

    def tidy(self, facts: Mapping[str, Any]) -> tuple[dict[str, Value], frozenset[str], tuple[str, ...]]:
        """Facts in the types conditions expect: the usable ones, the names that were NaN, and what is wrong with the rest."""
        usable: dict[str, Value] = {}
        lost, wrong = set(), []
        for name, value in facts.items():
            fact = self.vocabulary.facts.get(name)
            try:
                plain = value if fact is None or value is None else _plain(fact, value)
            except FactError as error:
                wrong.append(str(error))
                plain = value
            if plain is None:
                continue
            if plain != plain:
                lost.add(name)
            else:
                usable[name] = plain
        return usable, frozenset(lost), tuple(wrong)

    def _prepare_odd(self, scene: Scene) -> PreparedScene:
        facts, lost, wrong = self.tidy(scene.facts)
        tidied = Scene(facts, scene.silent | lost)
        if wrong:
            return PreparedScene(self, tidied, self._unknown(tidied.silent), wrong)
        return self.prepare(tidied)

    def _unknown(self, silent: frozenset[str]) -> Values:
        """The values of a scene of which nothing is known: what the vocabulary assumes, None elsewhere."""
        found = self._empty.get(silent)
        if found is None:
            found = [_assumed(fact, silent) for fact in self.vocabulary]
            found += [{}, {}]
            if len(self._empty) < 64:
                self._empty[silent] = found
        return found


def _assumed(fact: Fact, silent: frozenset[str]) -> Value | None:
    if fact.assumption is None or fact.name in silent or fact.source in silent:
        return None
    return fact.assumption.value


def _plain(fact: Fact, value: Any) -> Value:
    """A value as the plain Python type of its fact; numpy scalars and other collections are taken for what they hold."""
    if hasattr(value, "item") and not isinstance(value, (str, frozenset)):
        value = value.item()
    if fact.kind == "set" and isinstance(value, (set, list, tuple)):
        value = frozenset(value)
    if isinstance(value, bool) is (fact.kind == "boolean"):
        kind = _CLASS[fact.kind]
        if isinstance(value, (kind, int) if kind is float else kind):
            plain: Any = value if value.__class__ in (kind, int) else kind(value)
            return plain  # type: ignore[no-any-return]
    raise FactError(f"{fact.name} is a {fact.kind} and cannot be {value!r}")
