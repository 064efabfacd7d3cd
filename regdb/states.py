"""The finite state machine as data: super-states, their states, transitions, prompts (paper, section III-C, Table II)."""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from dataclasses import dataclass


class StateError(ValueError):
    """A state that is not there, or a machine that is none."""


@dataclass(frozen=True, slots=True)
class State:
    """One state. Its id is `super_state.name`; `next` are ids it may go to, across super-states too."""

    super_state: str
    name: str
    meaning: str = ""
    aliases: tuple[str, ...] = ()
    extension: bool = False
    prompt: str = ""
    next: tuple[str, ...] = ()

    @property
    def id(self) -> str:
        return f"{self.super_state}.{self.name}"


@dataclass(frozen=True, slots=True)
class SuperState:
    """One super-state with its prompt, the super-states that may follow, and the states it is entered and left through."""

    name: str
    meaning: str = ""
    prompt: str = ""
    next: tuple[str, ...] = ()
    entry: str = "go_straight"
    exit: str = "go_straight"
    aliases: tuple[str, ...] = ()
    from_anywhere: bool = False


class StateMachine:
    """All states by id. Names are resolved here: an id, a short name, an alias, or a super-state for all its states."""

    def __init__(self, super_states: Iterable[SuperState], states: Iterable[State], initial: str) -> None:
        self.super_states = {item.name: item for item in super_states}
        self.states = {state.id: state for state in states}
        self.initial = initial
        self._named: dict[str, tuple[str, ...]] = {}
        self._transitions: dict[tuple[str, str], tuple[str, str]] = {}
        for state in self.states.values():
            for name in (state.id, state.name, *state.aliases):
                self._named[name] = (*self._named.get(name, ()), state.id)
        for item in self.super_states.values():
            own = tuple(state.id for state in self.states.values() if state.super_state == item.name)
            for name in (item.name, *item.aliases):
                self._named[name] = tuple(dict.fromkeys((*own, *self._named.get(name, ()))))

    @property
    def names(self) -> tuple[str, ...]:
        """Every word that names a state or super-state."""
        return tuple(self._named)

    def expand(self, name: str) -> tuple[str, ...]:
        """The ids a word stands for: one state, those of that name in every super-state, or a super-state's all."""
        try:
            return self._named[_key(name)]
        except KeyError:
            near = difflib.get_close_matches(_key(name), self._named, 1)
            hint = f"; did you mean {near[0]}?" if near else f"; known: {', '.join(sorted(self._named))}"
            raise StateError(f"unknown state {name!r}{hint}") from None

    def transition(self, current: str, following: str) -> tuple[str, str]:
        """Two names as ids: a name shared by several super-states means the one in the other's, else the initial one."""
        found = self._transitions.get((current, following))
        if found is None:
            found = self._transitions[current, following] = self._transition(current, following)
        return found

    def _transition(self, current: str, following: str) -> tuple[str, str]:
        ours, theirs = self._candidates(current), self._candidates(following)
        pairs = [(a, b) for a in ours for b in theirs]
        same = [pair for pair in pairs if _super(pair[0]) == _super(pair[1])]
        choices = same or pairs
        first = [pair for pair in choices if _super(pair[0]) == self.initial]
        return (first or choices)[0]

    def _candidates(self, name: str) -> tuple[str, ...]:
        key = _key(name)
        for item in self.super_states.values():
            if key == item.name or key in item.aliases:
                return self.expand(item.name if f"{item.name}.{item.entry}" not in self.states else f"{item.name}.{item.entry}")
        return self.expand(key)


def _key(name: str) -> str:
    return name.strip().lower().replace(" ", "_").replace("-", "_")


def _super(state_id: str) -> str:
    return state_id.partition(".")[0]
