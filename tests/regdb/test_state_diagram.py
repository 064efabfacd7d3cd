"""The machine as Mermaid and DOT: every state once, every transition once, emergencies said rather than drawn from everywhere."""

from __future__ import annotations

import re

import pytest
from regdb_compiler.read_corpus import read_corpus

from regdb.state_diagram import between, to_dot, to_mermaid, within
from regdb.states import State, StateMachine, SuperState

MACHINE = StateMachine(
    [SuperState("follow", next=("follow", "cross")), SuperState("cross"), SuperState("brake", entry="brake", from_anywhere=True)],
    [
        State("follow", "go_straight", next=("follow.go_straight", "follow.park", "cross.go_straight", "brake.brake")),
        State("follow", "park", extension=True, next=("follow.go_straight", "brake.brake")),
        State("cross", "go_straight", next=("follow.go_straight", "brake.brake")), State("brake", "brake", next=("follow.go_straight",)),
    ],
    "follow",
)  # fmt: skip

MERMAID = """\
stateDiagram-v2
    [*] --> follow
    state "Follow" as follow {
        [*] --> follow__go_straight
        state "go straight" as follow__go_straight
        state "park *" as follow__park
        follow__go_straight --> follow__go_straight
        follow__go_straight --> follow__park
        follow__park --> follow__go_straight
    }
    state "Cross" as cross {
        [*] --> cross__go_straight
        state "go straight" as cross__go_straight
    }
    state "Brake" as brake {
        [*] --> brake__brake
        state "brake" as brake__brake
    }
    follow__go_straight --> cross__go_straight
    cross__go_straight --> follow__go_straight
    brake__brake --> follow__go_straight
    note right of brake : entered from every state
"""


def test_mermaid_word_for_word() -> None:
    assert to_mermaid(MACHINE) == MERMAID


def test_dot_has_every_state_and_transition_once() -> None:
    text = to_dot(MACHINE)
    assert re.findall(r'^ +"([\w.]+)" \[', text, re.M) == list(MACHINE.states)
    assert re.findall(r'^ +"([\w.]+)" -> "([\w.]+)";', text, re.M) == [
        ("follow.go_straight", "follow.go_straight"), ("follow.go_straight", "follow.park"), ("follow.park", "follow.go_straight"),
        ("follow.go_straight", "cross.go_straight"), ("cross.go_straight", "follow.go_straight"), ("brake.brake", "follow.go_straight"),
    ]  # fmt: skip
    assert text.count("{") == text.count("}")


@pytest.mark.parametrize("write", [to_mermaid, to_dot])
def test_the_shipped_machine(write, codes) -> None:
    machine = read_corpus(codes).machine
    assert machine is not None
    text = write(machine)
    drawn = [*(pair for item in machine.super_states.values() for pair in within(machine, item)), *between(machine)]
    everywhere = {state.id for state in machine.states.values() if machine.super_states[state.super_state].from_anywhere}
    left = {(s.id, after) for s in machine.states.values() for after in s.next} - set(drawn)
    assert len(drawn) == len(set(drawn))
    assert all(after in everywhere for _, after in left)
    for state in machine.states:
        assert state in text or state.replace(".", "__") in text
