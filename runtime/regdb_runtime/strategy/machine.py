"""The state machine of the database, driven: what may follow the state in force, by which micro-steps, and for how long it has been so."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

from regdb.states import StateMachine

MOST_STEPS = 4
"""Micro-steps in one tick at most: out of a queue, out of a super-state, into the next and to its manoeuvre."""


@dataclass(frozen=True, slots=True)
class Step:
    """A state that may follow: `steps` are the micro-steps to it, itself last; `current` is the state it is entered from."""

    current: str
    next: str
    via: tuple[str, ...] = ()

    @property
    def steps(self) -> tuple[str, ...]:
        """Everything passed through, the state itself last."""
        return (*self.via, self.next)


@dataclass(frozen=True)
class Machine:
    """Successors with their micro-steps.

    A super-state is left and entered only through its exit and entry states (paper, III-C); a micro-step passes through such states alone, takes
    no time and moves nothing. `from_anywhere` super-states are no candidates: distance alone leads into them. `asked`: extension states in use.
    """

    states: StateMachine
    asked: frozenset[str] = frozenset()
    _found: dict[str, tuple[Step, ...]] = field(default_factory=dict, repr=False)

    @cached_property
    def initial(self) -> str:
        """The state driving starts in (paper, P12): the entry of the initial super-state."""
        entry = self.states.super_states[self.states.initial].entry
        return f"{self.states.initial}.{entry}"

    @cached_property
    def emergency(self) -> tuple[str, str]:
        """Entry and exit of the super-state that is entered from anywhere."""
        for item in self.states.super_states.values():
            if item.from_anywhere:
                return f"{item.name}.{item.entry}", f"{item.name}.{item.exit}"
        raise LookupError("the machine has no super-state that is entered from anywhere")

    def successors(self, state: str) -> tuple[Step, ...]:
        """Every state that can follow within one tick, nearest first, then in the machine's order; itself among them where it may stay."""
        found = self._found.get(state)
        if found is None:
            found = self._found[state] = self._search(state)
        return found

    def step_to(self, state: str, following: str) -> Step | None:
        """The micro-steps from one state to another, None when there are none."""
        return next((step for step in self.successors(state) if step.next == following), None)

    def super_state(self, state: str) -> str:
        """The super-state of a state's id."""
        return self.states.states[state].super_state

    def _search(self, state: str) -> tuple[Step, ...]:
        found: dict[str, Step] = {}
        edge = [Step(state, state)]
        for depth in range(MOST_STEPS):
            edge = [
                Step(last.next if depth else state, following, (*last.via, last.next) if depth else ())
                for last in edge if depth == 0 or self._passable(last.next)
                for following in self.states.states[last.next].next if self._offered(following) or following == state
            ]
            edge = [step for place, step in enumerate(edge) if step.next not in found and step.next not in {e.next for e in edge[:place]}]
            found.update((step.next, step) for step in edge)
        return tuple(found.values())

    def _offered(self, state: str) -> bool:
        item = self.states.states[state]
        if self.states.super_states[item.super_state].from_anywhere:
            return False
        return not item.extension or state in self.asked

    def _passable(self, state: str) -> bool:
        item = self.states.states[state]
        of = self.states.super_states[item.super_state]
        return item.name in (of.entry, of.exit)
