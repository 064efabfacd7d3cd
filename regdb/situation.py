"""A scene and a plan, read from what people write, as the values conditions are evaluated on."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from regdb.states import StateError, StateMachine
from regdb.vocabulary import FactError, Value, Vocabulary


class SceneError(ValueError):
    """A scene or plan with words that are not in the vocabulary; `problems` lists every one of them."""

    def __init__(self, problems: Iterable[str]) -> None:
        self.problems = tuple(problems)
        super().__init__("; ".join(self.problems))


@dataclass(frozen=True)
class Scene:
    """What is known now: fact -> value in SI; a fact left out is unknown.

    `silent` names facts and sources (`perception`) that report nothing at present, so that nothing is assumed of them.
    """

    facts: Mapping[str, Value] = field(default_factory=dict)
    silent: frozenset[str] = frozenset()


@dataclass(frozen=True)
class Plan:
    """A candidate: the transition between two state ids, and the plan's own quantities in SI."""

    current: str
    next: str
    facts: Mapping[str, Value] = field(default_factory=dict)


class Situation:
    """A scene with a plan under a vocabulary: what conditions read."""

    def __init__(self, vocabulary: Vocabulary, scene: Scene, plan: Plan) -> None:
        self.vocabulary, self.scene, self.plan = vocabulary, scene, plan

    def observed(self, fact: str) -> Value | None:
        """The value as told by scene or plan, None when it is not."""
        value = self.plan.facts.get(fact)
        return self.scene.facts.get(fact) if value is None else value

    def value(self, fact: str) -> Value | None:
        """The value as told, else what the vocabulary assumes of it."""
        value = self.observed(fact)
        return self.assumed(fact) if value is None else value

    def assumed(self, fact: str) -> Value | None:
        """What stands in for the fact while it is unknown; None when nothing may."""
        declared = self.vocabulary.facts.get(fact)
        if declared is None or declared.assumption is None:
            return None
        if fact in self.scene.silent or declared.source in self.scene.silent:
            return None
        return declared.assumption.value


def quiet_facts(vocabulary: Vocabulary) -> dict[str, Value]:
    """The uneventful scene: every fact at its quiet value; facts without one are left out."""
    return {fact.name: fact.quiet for fact in vocabulary if fact.quiet is not None}


def read_scene(raw: Mapping[str, object], vocabulary: Vocabulary) -> Scene:
    """A scene as people write it: fact -> `true`, `25 mph`, `red`, `unknown` …; `like: quiet` starts from the quiet scene,
    `silent: [perception]` says what reports nothing. Raises SceneError with every problem."""
    facts: dict[str, Value] = {}
    problems: list[str] = []
    like = raw.get("like")
    if like == "quiet":
        facts.update(quiet_facts(vocabulary))
    elif like is not None:
        problems.append(f"unknown base scene {like!r}; there is: quiet")
    silent = raw.get("silent", ())
    for name, text in raw.items():
        if name not in {"like", "silent"}:
            _read_fact(name, name, text, vocabulary, facts, problems)
    if problems:
        raise SceneError(problems)
    return Scene(facts, frozenset([silent] if isinstance(silent, str) else map(str, silent)))  # type: ignore[call-overload]


def read_plan(raw: Mapping[str, object], vocabulary: Vocabulary, machine: StateMachine) -> Plan:
    """A plan as people write it: `current`, `next`, and quantities with or without `plan.`. Raises SceneError."""
    facts: dict[str, Value] = {}
    problems: list[str] = []
    for name, text in raw.items():
        if name not in {"current", "next"}:
            full = name if name in vocabulary else f"plan.{name}"
            _read_fact(name, full, text, vocabulary, facts, problems)
    current, following = str(raw.get("current") or ""), str(raw.get("next") or "")
    try:
        current, following = machine.transition(current or following or machine.initial, following or current or machine.initial)
    except StateError as error:
        problems.append(str(error))
    if problems:
        raise SceneError(problems)
    return Plan(current, following, facts)


def _read_fact(
    name: str, full: str, text: object, vocabulary: Vocabulary, facts: dict[str, Value], problems: list[str]
) -> None:
    if full not in vocabulary:
        near = difflib.get_close_matches(name, vocabulary.facts, 1, 0.6)
        problems.append(f"unknown fact {name!r}" + (f"; did you mean {near[0]}?" if near else ""))
        return
    try:
        value = vocabulary.fact(full).read(text)
    except FactError as error:
        problems.append(str(error))
        return
    if value is None:
        facts.pop(full, None)
    else:
        facts[full] = value
