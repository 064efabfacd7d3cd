"""Scene and plan as one flat list of values, a slot per fact, with assumptions already standing in for what is unknown."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from regdb.situation import Plan, Scene
from regdb.vocabulary import Fact, FactError, Value, Vocabulary

Values = list[Any]
"""One value per fact (None is unknown); the last two entries are the facts observed by the scene and told by the plan."""

_CLASSES: dict[str, frozenset[type]] = {
    "boolean": frozenset({bool}),
    "enumeration": frozenset({str}),
    "set": frozenset({frozenset}),
    "quantity": frozenset({int, float}),
    "count": frozenset({int, float}),
    "time": frozenset({int, float}),
    "date": frozenset({int, float}),
}


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
        self._expected = {fact.name: (self.slots[fact.name], _CLASSES[fact.kind]) for fact in vocabulary}
        self._empty: dict[frozenset[str], Values] = {}

    def prepare(self, scene: Scene) -> PreparedScene:
        """Encode a scene. Values that are None are unknown; NaN is unknown and nothing is assumed in its place."""
        values = self._unknown(scene.silent).copy()
        expected = self._expected
        for name, value in scene.facts.items():
            found = expected.get(name)
            if found is not None:
                if value.__class__ not in found[1] or value != value:
                    return self._prepare_odd(scene)
                values[found[0]] = value
        values[self.scene_slot] = scene.facts
        return PreparedScene(self, scene, values)

    def with_plan(self, prepared: PreparedScene, plan: Plan) -> Values | None:
        """The values of a prepared scene with the plan's own over them; None when the plan has a value that needs a second look."""
        values = prepared.values.copy()
        expected = self._expected
        for name, value in plan.facts.items():
            found = expected.get(name)
            if found is not None:
                if value.__class__ not in found[1] or value != value:
                    return None
                values[found[0]] = value
        values[-1] = plan.facts
        return values

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
        for kind in _CLASSES[fact.kind]:
            if isinstance(value, kind):
                plain: Value = value if value.__class__ is kind else kind(value)  # type: ignore[assignment]
                return plain
    raise FactError(f"{fact.name} is a {fact.kind} and cannot be {value!r}")
