"""Interpretations at work: the article's distances against motion simulated step by step, and what profiles decide, or leave open."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from regdb_runtime import formulas
from regdb_runtime.interpretation import _REQUIRED, Judgement, interpreted, judge, judge_all

from regdb.interpretation import FORMULAS, Decision, Interpretation, Parameter
from regdb.situation import Plan, Scene

RSS = {"response_time": 1.0, "max_acceleration": 3.5, "min_braking": 4.0}
SPEEDS = st.floats(0, 40)
STEP = 0.001


def travelled(speed: float, response: float, acceleration: float, braking: float) -> float:
    """Distance until standing still, by small steps: speeding up while responding, then braking."""
    place, time = 0.0, 0.0
    while time < response or speed > 0:
        rate = acceleration if time < response else -braking
        after = max(0.0, speed + rate * STEP)
        place += (speed + after) / 2 * STEP
        speed, time = after, time + STEP
    return place


@pytest.mark.parametrize(("rear", "front"), [(0, 0), (10, 10), (30, 30), (30, 20), (13.4, 13.4), (20, 40)])
def test_the_longitudinal_distance_is_what_the_worst_case_needs(rear: float, front: float) -> None:
    worst = travelled(rear, 1.0, 3.5, 4.0) - travelled(front, 0.0, 0.0, 8.0)
    assert formulas.rss_longitudinal(rear, front, **RSS, max_braking=8.0) == pytest.approx(max(0.0, worst), abs=0.05)


def test_the_longitudinal_distance_of_definition_1_worked_by_hand() -> None:
    found = formulas.rss_longitudinal(20.0, 20.0, **RSS, max_braking=8.0)
    assert found == 20 * 1 + 3.5 / 2 + 23.5**2 / 8 - 20**2 / 16


def test_the_opposite_distance_is_the_sum_of_both_ways_to_a_stop() -> None:
    found = formulas.rss_opposite(15.0, 20.0, **RSS, min_braking_correct=3.0)
    assert found == pytest.approx(travelled(15, 1, 3.5, 3) + travelled(20, 1, 3.5, 4), abs=0.05)
    assert found == (15 + 18.5) / 2 + 18.5**2 / 6 + (20 + 23.5) / 2 + 23.5**2 / 8


def test_the_lateral_distance_of_definition_6() -> None:
    found = formulas.rss_lateral(
        0.5, -0.3, response_time=1.0, max_lateral_acceleration=0.2, min_lateral_braking=0.8, fluctuation_margin=0.1
    )
    left = (0.5 + 0.7) / 2 + 0.7**2 / 1.6
    right = (-0.3 + -0.5) / 2 - 0.5**2 / 1.6
    assert found == pytest.approx(0.1 + left - right)
    assert found == pytest.approx(0.1 + travelled(0.5, 1, 0.2, 0.8) + travelled(0.3, 1, 0.2, 0.8), abs=0.01)


def test_the_way_to_a_stop_of_a_design_manual() -> None:
    """AASHTO: 60 mph on the level, 2.5 s and 11.2 ft/s2, is 566 ft."""
    found = formulas.stopping_distance(60 * 0.44704, response_time=2.5, min_braking=11.2 * 0.3048)
    assert found / 0.3048 == pytest.approx(566, abs=1)


@given(SPEEDS, SPEEDS, SPEEDS)
def test_who_is_faster_needs_more_and_a_faster_leader_less(rear: float, front: float, more: float) -> None:
    base = formulas.rss_longitudinal(rear, front, **RSS, max_braking=8.0)
    assert formulas.rss_longitudinal(rear + more, front, **RSS, max_braking=8.0) >= base
    assert formulas.rss_longitudinal(rear, front + more, **RSS, max_braking=8.0) <= base
    assert formulas.rss_yield(rear, **RSS) >= base


def profile(formula: str, true_when: str = "unsafe", **numbers: float) -> Interpretation:
    parameters = {name: Parameter(str(number), number) for name, number in numbers.items()}
    decision = Decision("lead.following_unsafe", formula, parameters, true_when, "because")
    return Interpretation("test", "Test", decisions={"lead.following_unsafe": decision})


def test_every_formula_has_its_arithmetic_and_compares_something_it_measures() -> None:
    assert set(_REQUIRED) == set(FORMULAS)
    for name, formula in FORMULAS.items():
        quantity, required = _REQUIRED[name](dict.fromkeys(formula.measures, 10.0), dict.fromkeys(formula.parameters, 2.0))
        assert formula.measures[quantity] == "length"
        assert required >= 0


def test_a_gap_is_judged_with_the_numbers_used() -> None:
    rss = profile("rss_longitudinal", **RSS, max_braking=8.0)
    measured = {"rear_speed": 20.0, "front_speed": 20.0, "gap": 30.0}
    near = judge(rss, "lead.following_unsafe", measured)
    assert (near.value, near.quantity, near.measured) == (True, "gap", measured)
    assert near.required == pytest.approx(65.78125)
    assert near.because == "gap 30.00 m is less than the 65.78 m that rss_longitudinal asks"
    assert judge(rss, "lead.following_unsafe", {**measured, "gap": 70.0}).value is False


def test_the_bound_itself_is_enough() -> None:
    three = profile("time_gap", least_time=3.0)
    assert judge(three, "lead.following_unsafe", {"rear_speed": 10.0, "gap": 30.0}).value is False
    assert judge(three, "lead.following_unsafe", {"rear_speed": 10.0, "gap": math.nextafter(30.0, 0)}).value is True


def test_what_is_not_measured_is_not_decided() -> None:
    found = judge(profile("rss_longitudinal", **RSS, max_braking=8.0), "lead.following_unsafe", {"rear_speed": 20.0})
    assert (found.value, found.missing) == (None, ("front_speed", "gap"))
    assert found.because == "front_speed, gap are not known"


def test_a_profile_that_never_decides_leaves_unknown() -> None:
    for one in (profile(""), Interpretation("silent", "Silent")):
        assert judge(one, "lead.following_unsafe", {"gap": 1.0, "rear_speed": 50.0}).value is None


def test_enough_clearance_says_nothing_beyond_the_speed_it_is_meant_for() -> None:
    beside = profile("clearance", least_clearance=1.5, up_to_speed=13.4112)
    values = [
        judge(beside, "lead.following_unsafe", {"speed": speed, "lateral_gap": gap}).value
        for speed, gap in ((10.0, 2.0), (10.0, 1.0), (20.0, 1.0), (20.0, 2.0))
    ]
    assert values == [False, True, True, None]


def test_a_fact_may_be_true_when_safe() -> None:
    clear = profile("rss_opposite", "safe", **RSS, min_braking_correct=3.0)
    measured = {"own_speed": 15.0, "other_speed": 20.0}
    assert judge(clear, "lead.following_unsafe", {**measured, "gap": 500.0}).value is True
    assert judge(clear, "lead.following_unsafe", {**measured, "gap": 50.0}).value is False


@pytest.mark.parametrize("bad", [-1.0, math.nan, math.inf])
def test_what_cannot_be_measured_is_refused(bad: float) -> None:
    with pytest.raises(ValueError, match="cannot be measured"):
        judge(profile("time_gap", least_time=3.0), "lead.following_unsafe", {"rear_speed": bad, "gap": 10.0})


def test_scene_and_plan_take_what_was_decided_and_nobody_told() -> None:
    facts = {name: Decision(name, "time_gap", {"least_time": Parameter("3 s", 3.0)}) for name in ("a.near", "b.near", "c.near", "plan.near")}
    measured = {name: {"rear_speed": 10.0, "gap": 5.0} for name in ("a.near", "b.near", "plan.near")}
    found = judge_all(Interpretation("p", "P", decisions=facts), measured)
    assert [item.value for item in found] == [True, True, None, True]
    scene, plan = interpreted(Scene({"b.near": False}, frozenset(["map"])), Plan("x", "y"), found)
    assert scene == Scene({"a.near": True, "b.near": False}, frozenset(["map"]))
    assert plan == Plan("x", "y", {"plan.near": True})
    assert interpreted(scene, plan, [Judgement("a.near", "p", None)]) == (scene, plan)
