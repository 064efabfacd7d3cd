"""The state machine: names to ids, and what a shared name means in company."""

from __future__ import annotations

from pathlib import Path

import pytest
from regdb_compiler.read_corpus import read_corpus

from regdb.states import State, StateError, StateMachine, SuperState

SUPERS = [
    SuperState("follow", next=("follow", "cross")), SuperState("cross", aliases=("junction",)),
    SuperState("brake", entry="brake", from_anywhere=True),
]  # fmt: skip
STATES = [
    State("follow", "go_straight", next=("follow.change",)), State("follow", "change", aliases=("swerve",)), State("cross", "go_straight"),
    State("cross", "stop"), State("cross", "turn"), State("brake", "brake"),
]  # fmt: skip
MACHINE = StateMachine(SUPERS, STATES, "follow")


@pytest.mark.parametrize(
    ("name", "ids"),
    [
        ("cross.stop", ["cross.stop"]), ("stop", ["cross.stop"]), ("swerve", ["follow.change"]),
        ("go_straight", ["follow.go_straight", "cross.go_straight"]),
        ("cross", ["cross.go_straight", "cross.stop", "cross.turn"]), ("junction", ["cross.go_straight", "cross.stop", "cross.turn"]),
        ("Go-Straight", ["follow.go_straight", "cross.go_straight"]),
        (" go straight ", ["follow.go_straight", "cross.go_straight"]), ("brake", ["brake.brake"]),
    ],
)  # fmt: skip
def test_a_word_stands_for_states(name: str, ids: list[str]) -> None:
    assert list(MACHINE.expand(name)) == ids


@pytest.mark.parametrize(
    ("pair", "ids"),
    [
        (("stop", "go_straight"), ("cross.stop", "cross.go_straight")), (("go_straight", "stop"), ("cross.go_straight", "cross.stop")),
        (("go_straight", "go_straight"), ("follow.go_straight", "follow.go_straight")),
        (("go_straight", "swerve"), ("follow.go_straight", "follow.change")),
        (("cross", "cross"), ("cross.go_straight", "cross.go_straight")), (("junction", "turn"), ("cross.go_straight", "cross.turn")),
        (("brake", "go_straight"), ("brake.brake", "follow.go_straight")), (("cross.go_straight", "change"), ("cross.go_straight", "follow.change")),
    ],
)  # fmt: skip
def test_a_shared_name_means_the_one_in_the_others_super_state_else_the_initial_one(pair: tuple[str, str], ids: tuple[str, str]) -> None:
    assert MACHINE.transition(*pair) == ids


def test_an_unknown_state_names_the_nearest_or_all() -> None:
    with pytest.raises(StateError, match="did you mean turn"):
        MACHINE.expand("turnn")
    with pytest.raises(StateError, match="known: brake"):
        MACHINE.transition("zzz", "turn")


def test_names_are_every_word_there_is() -> None:
    assert {"cross", "junction", "cross.stop", "stop", "swerve", "brake.brake"} <= set(MACHINE.names)


def test_the_shipped_machine_is_the_papers(codes: Path) -> None:
    machine = read_corpus(codes).machine
    assert set(machine.super_states) == {"lane_following", "intersection_handling", "overtaking", "emergency_stop"}
    for state in machine.states.values():
        assert set(state.next) <= set(machine.states)
        for target in state.next:
            other = machine.super_states[target.partition(".")[0]]
            if other.name != state.super_state and not other.from_anywhere:
                assert state.name == machine.super_states[state.super_state].exit
                assert target == f"{other.name}.{other.entry}"
    assert machine.transition("stop", "turn_right") == ("intersection_handling.stop", "intersection_handling.turn_right")
