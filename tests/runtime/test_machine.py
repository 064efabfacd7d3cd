"""The machine of the database, driven: successors with their micro-steps."""

import itertools

import pytest
from regdb_runtime.strategy.machine import Machine
from strategy_scenes import law

LF, IH, OT = "lane_following", "intersection_handling", "overtaking"


@pytest.fixture(scope="module")
def machine() -> Machine:
    return Machine(law().machine)


def test_driving_starts_in_lane_following(machine):
    assert machine.initial == "lane_following.go_straight"
    assert machine.emergency == ("emergency_stop.emergency_stop", "emergency_stop.slow_down")


def test_a_queued_car_reaches_the_intersection_by_a_micro_step(machine):
    step = machine.step_to(f"{LF}.car_following", f"{IH}.stop")
    assert step.steps == (f"{LF}.go_straight", f"{IH}.go_straight", f"{IH}.stop")
    assert step.current == f"{IH}.go_straight"


def test_a_direct_successor_needs_no_micro_step(machine):
    step = machine.step_to(f"{LF}.go_straight", f"{IH}.go_straight")
    assert (step.current, step.via) == (f"{LF}.go_straight", ())


def test_super_states_are_left_and_entered_through_go_straight_alone(machine):
    for state in machine.states.states:
        for step in machine.successors(state):
            chain = (state, *step.steps)
            for before, after in itertools.pairwise(chain):
                assert after in machine.states.states[before].next
                if machine.super_state(before) != machine.super_state(after) and not before.startswith("emergency_stop"):
                    assert before.endswith(".go_straight")
                    assert after.endswith(".go_straight")
            assert all(passed.endswith(".go_straight") for passed in step.via)


def test_emergency_and_extensions_are_no_candidates(machine):
    for state in machine.states.states:
        offered = {step.next for step in machine.successors(state)} - {state}
        assert not any(name.startswith("emergency_stop") for name in offered)
        assert not any(machine.states.states[name].extension for name in offered)


def test_an_extension_that_is_asked_for_is_a_candidate():
    asked = Machine(law().machine, frozenset(("lane_following.pull_over",)))
    assert asked.step_to("lane_following.go_straight", "lane_following.pull_over") is not None
    assert asked.step_to("lane_following.go_straight", "lane_following.reverse") is None


def test_staying_is_a_step_without_micro_steps(machine):
    for state in machine.states.states:
        if state in machine.states.states[state].next:
            assert machine.step_to(state, state).steps == (state,)


def test_table_two_of_the_paper_holds_for_what_is_entered_next(machine):
    """Lane following -> itself, intersection handling, overtaking; intersection handling -> itself, lane following; overtaking -> all three."""
    allowed = {LF: {LF, IH, OT}, IH: {IH, LF}, OT: {OT, LF, IH}}
    for state in machine.states.states:
        first = {machine.super_state(step.next) for step in machine.successors(state) if not step.via}
        if machine.super_state(state) in allowed:
            assert first <= allowed[machine.super_state(state)]
