"""The plan picked is the one that judging every plan by itself would pick; what binds motion follows from facts and law."""

from __future__ import annotations

import random
from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest
from assessment_scene import (
    FOOTPRINT,
    GO,
    LEFT_Y,
    MPH,
    PASS,
    POSTED,
    RIGHT_Y,
    SCHOOL,
    Case,
    bicycle,
    car,
    case,
    law,
    maneuver,
    stretch,
)  # fmt: skip
from regdb_runtime.assessment.assessed import LAWFUL, NO_PLAN, UNCERTAIN, UNLAWFUL
from regdb_runtime.assessment.judge import Judging
from regdb_runtime.assessment.plan_facts import measure
from regdb_runtime.assessment.violation import violations
from regdb_runtime.planning.contacts import Sweeper
from regdb_runtime.planning.goal import Goal, StopPoint
from regdb_runtime.trajectory import FrenetState

from regdb.vocabulary import Value

FRONT = 60.0 + FOOTPRINT.front
RED: dict[str, Value] = {
    **POSTED, "intersection.present": True, "intersection.control": "signal", "signal.present": True, "signal.place": "intersection",
    "signal.color": "red", "signal.shape": "circular", "intersection.distance": 30.0,
}  # fmt: skip


def naive(of: Case) -> tuple[int | None, int]:
    """Every plan measured alone, judged alone in every stretch it reaches, tested for contact; then the best of them."""
    assessor = of.assessor
    what = assessor._measuring(of.maneuver, of.stretches, of.candidates, of.predictions)
    judging = Judging(of.maneuver, of.stretches, [assessor._distinguish(item, of.maneuver) for item in of.stretches])
    sweeper = Sweeper(of.predictions, FOOTPRINT)
    found = []
    for place, row in enumerate(of.costs.order().tolist()):
        if of.ok[row] and np.isinf(sweeper.first_contact(of.candidates.x[row], of.candidates.y[row], of.candidates.heading[row])[0]):
            judged = judging.judge(measure(what, of.candidates, np.array([row])))
            rank = int(judged.rank[0])
            violation = violations(judged, assessor.settings, rank)[0] if rank != LAWFUL else ()
            found.append((rank, violation, float(of.costs.weighted[row]), place, row))
    return (min(found)[-1], min(found)[0]) if found else (None, NO_PLAN)


def random_case(seed: int) -> Case:
    """A manoeuvre among random road users, in a scene with a few random facts, some unknown; caps only sometimes."""
    draw = random.Random(seed)
    facts: dict[str, Value] = {**POSTED, "posted.speed": draw.choice((25, 35, 45)) * MPH}
    ahead = dict(draw.choice((POSTED, SCHOOL, RED)))
    may_be_unknown = ["school.children_going", "sign.speed_limit", "signal.color", "road.types", "lane.same_direction_available"]
    unknown = draw.sample(may_be_unknown, draw.randint(0, 2))
    border = FRONT + draw.uniform(5, 60)
    tracks = [bicycle(60 + draw.uniform(5, 40), RIGHT_Y - draw.uniform(0, 1.3), draw.uniform(0, 6))] if draw.random() < 0.6 else []
    tracks += [
        car(f"car{index}", 60 + draw.uniform(-20, 60), draw.choice((RIGHT_Y, LEFT_Y)), draw.uniform(0, 16)) for index in range(draw.randint(0, 3))
    ]  # fmt: skip
    passes = "bike" if tracks and tracks[0].kind == "bicycle" and draw.random() < 0.5 else None
    goal = Goal(offsets=tuple(sorted(draw.sample((-0.5, 0.0, 0.5, 1.0, 1.5, 2.5, 3.5), 3))), cruise_speed=draw.uniform(8, 20))
    if draw.random() < 0.3:
        goal = replace(goal, stop=StopPoint(border, "a line"))
    planned = maneuver(GO, PASS if passes else GO, goal=goal, passes=passes, passing_side="left" if passes else "none")
    pieces = (
        stretch(FRONT, border, facts, unknown=unknown, line=border if "signal.color" in ahead else None),
        stretch(border, 1e9, ahead, unknown=unknown),
    )
    start = FrenetState(60.0, draw.uniform(0, 16), 0.0, draw.uniform(-0.3, 0.3))
    return case(planned, pieces, tracks, start, draw.choice(("rss", "conservative", None)), capped=draw.random() < 0.5)


@pytest.mark.parametrize("seed", range(24))
def test_picks_what_judging_everything_picks(seed: int) -> None:
    of = random_case(seed)
    found = of.best()
    assert (found.index, found.rank) == naive(of)


def test_a_lawful_plan_wins_however_dear_it_is() -> None:
    """Costs are turned round: what the law forbids is the cheapest."""
    of = case(maneuver(), (stretch(FRONT, 1e9, SCHOOL),), start=FrenetState(60.0, 11.0), capped=False)
    fast_first = np.argsort(-of.candidates.speed.max(axis=1), kind="stable")
    costs = np.empty(len(fast_first))
    costs[fast_first] = np.arange(len(fast_first))
    found = of.assessor.best(of.maneuver, of.stretches, of.candidates, fast_first, costs, of.observation, of.predictions, of.ok)
    assert found.rank == LAWFUL
    assert found.index is not None
    assert of.candidates.speed[found.index].max() <= 25 * MPH
    said = {item.rule: item for item in found.rejections}
    assert said["CVC 22352(b)(2)"].bound == pytest.approx(25 * MPH)
    assert said["CVC 22352(b)(2)"].measured > 25 * MPH
    assert said["CVC 22352(b)(2)"].unit == "m/s"
    assert "25 mph" in said["CVC 22352(b)(2)"].because
    assert said["CVC 22352(b)(2)"].count > 10


def test_no_verdict_depends_on_what_else_is_measured() -> None:
    of = random_case(3)
    what = of.assessor._measuring(of.maneuver, of.stretches, of.candidates, of.predictions)
    rows = np.arange(0, len(of.candidates), 7)
    together = measure(what, of.candidates, rows)
    for place in range(0, len(rows), 5):
        alone = measure(what, of.candidates, rows[place : place + 1])
        for index in range(len(of.stretches)):
            assert together.one(index, place, {}) == alone.one(index, 0, {})


def test_caps_are_limits_in_force_and_possible_ones() -> None:
    pieces = (
        stretch(FRONT, 120.0, POSTED), stretch(120.0, 200.0, SCHOOL), stretch(200.0, 300.0, SCHOOL, unknown=("school.children_going",)),
        stretch(300.0, 400.0, {**SCHOOL, "school.children_going": False}),
    )  # fmt: skip
    caps = case(maneuver(), pieces).maneuver.goal.caps
    assert [(cap.start, cap.end) for cap in caps] == [(FRONT, 120.0), (120.0, 200.0), (200.0, 300.0), (300.0, 400.0)]
    assert [round(cap.speed / MPH, 6) for cap in caps] == [35, 25, 25, 35]
    assert caps[1].rule == "CVC 22352(b)(2)"
    assert caps[2].rule == "CVC 22352(b)(2) (may apply)"


def test_caps_hold_where_the_manoeuvre_is_unlawful_anyway() -> None:
    """A red light decides the verdict; the limit that may apply is found all the same."""
    pieces = (stretch(FRONT, 1e9, {**RED, **SCHOOL}, unknown=("school.children_going",), line=FRONT + 20.0),)
    planned = maneuver("intersection_handling.go_straight", "intersection_handling.go_straight", commits=True)
    caps = case(planned, pieces).maneuver.goal.caps
    assert [round(cap.speed / MPH, 6) for cap in caps] == [25]


def test_a_profile_that_asks_to_stop_in_sight_caps_the_speed() -> None:
    far = stretch(FRONT, 1e9, POSTED, measures={"speed.unsafe_for_conditions": {"sight_distance": 20.0}})
    caps = case(maneuver(), (far,), profile="conservative").maneuver.goal.caps
    speed = caps[0].speed
    assert speed * 2.5 + speed**2 / (2 * 3.4) == pytest.approx(20.0)


def test_unknown_is_taken_only_where_nothing_is_lawful() -> None:
    """Whether the speed suits the conditions nobody says: unknown for every plan. Whether 35 mph is posted: unknown for the faster ones."""
    of = case(maneuver(), (stretch(FRONT, 1e9, POSTED, unknown=("speed.unsafe_for_conditions",)),), profile=None)
    found = of.best()
    assert found.rank == UNCERTAIN
    assert found.verdict is not None
    assert found.verdict.verdict == "unknown"
    assert found.verdict.missing == ("speed.unsafe_for_conditions",)
    assert any("not known: speed.unsafe_for_conditions" in item.because for item in found.rejections)
    unseen = (stretch(FRONT, 1e9, POSTED, unknown=("sign.speed_limit",)),)
    perhaps = case(maneuver(), unseen, start=FrenetState(60.0, 15.6), profile=None, capped=False)
    slow = perhaps.best()
    assert slow.rank == LAWFUL
    assert slow.index is not None
    assert perhaps.candidates.speed[slow.index].max() <= 35 * MPH


def test_red_binds_by_where_the_plan_ends() -> None:
    """The same transition is lawful for plans that stay behind the line and unlawful for those that pass it."""
    line = FRONT + 25.0
    state = "intersection_handling.go_straight"
    red = stretch(FRONT, 1e9, RED, line=line)
    stop = maneuver(state, "intersection_handling.stop", goal=Goal(cruise_speed=8.0, stop=StopPoint(line, "CVC 21453(a)")))
    stopping = case(stop, (red,), start=FrenetState(60.0, 8.0)).best()
    assert stopping.rank == LAWFUL
    through = case(maneuver(state, state, goal=Goal(cruise_speed=15.0), commits=True), (red,), start=FrenetState(60.0, 8.0)).best()
    assert through.rank == UNLAWFUL
    assert "CVC 21453(a)" in {item.rule for item in through.rejections}
    green = stretch(FRONT, 1e9, {**RED, "signal.color": "green"}, line=line)
    assert case(maneuver(state, state, goal=Goal(cruise_speed=15.0), commits=True), (green,), start=FrenetState(60.0, 8.0)).best().rank == LAWFUL


def test_a_cyclist_is_passed_at_three_feet_or_not_at_all() -> None:
    tracks = [bicycle(105.0, RIGHT_Y - 1.1)]
    goal = Goal(offsets=(0.0, 0.3, 0.6, 0.9, 1.2), cruise_speed=15.0)
    of = case(maneuver(GO, PASS, goal=goal, passes="bike", passing_side="left"), (stretch(FRONT, 1e9, POSTED),), tracks)
    found = of.best()
    assert found.rank == LAWFUL
    assert found.verdict is not None
    assert found.verdict.plan.facts["plan.clearance"] >= 0.9144
    narrow = case(replace(of.maneuver, goal=replace(goal, offsets=(0.0, 0.3))), of.stretches, tracks).best()
    assert narrow.rank == UNLAWFUL, "waiting behind is lawful, but it is no pass: that is car following"
    assert {item.rule: (item.bound, item.unit) for item in narrow.rejections}["CVC 21760(c)"] == (0.9144, "m")


def test_what_breaks_least_is_taken_when_nothing_is_lawful() -> None:
    """The limit drops where the vehicle is: of plans all too fast, one that slows down, though not with all there is: a tenth of the limit
    more or less, on average, is for comfort to weigh."""
    of = case(maneuver(goal=Goal(cruise_speed=16.0)), (stretch(FRONT, 1e9, SCHOOL),), start=FrenetState(60.0, 15.6), capped=False)
    found = of.best()
    assert found.rank == UNLAWFUL
    assert found.index is not None
    beyond = np.maximum(of.candidates.speed - 25 * MPH, 0.0).mean(axis=1) / (25 * MPH)
    assert np.ceil(beyond[found.index] * 10) == np.ceil(beyond[of.ok].min() * 10)
    assert of.candidates.acceleration[found.index].min() > -3.4
    assert max(found.violation) == pytest.approx(0.1)


def test_nothing_that_touches_anybody_is_taken() -> None:
    wall = [car("wall", 60.0 + FOOTPRINT.front + 3.0, RIGHT_Y, 0.0)]
    found = case(maneuver(goal=Goal(cruise_speed=16.0)), (stretch(FRONT, 1e9, POSTED),), wall, FrenetState(60.0, 15.0)).best()
    assert found.index is None
    assert found.rank == NO_PLAN
    assert found.rejections[-1].rule == "collision"
    assert "wall" in found.rejections[-1].because


def test_no_plan_at_all_is_said() -> None:
    of = case(maneuver(), (stretch(FRONT, 1e9, POSTED),))
    none = replace(of, ok=np.zeros(len(of.candidates), dtype=bool)).best()
    assert (none.index, none.rank) == (None, NO_PLAN)


def test_the_chosen_plan_is_judged_by_its_own_numbers() -> None:
    of = random_case(5)
    found = of.best()
    assert found.index is not None
    assert found.verdict in found.verdicts
    for verdict in found.verdicts:
        again = law().at(verdict.place, verdict.date).judge(verdict.scene, verdict.plan)
        assert (again.verdict, again.deciding) == (verdict.verdict, verdict.deciding)
        if "plan.speed" in verdict.plan.facts:
            assert verdict.plan.facts["plan.speed"] <= of.candidates.speed[found.index].max() + 1e-6


def test_facts_are_words_of_the_vocabulary() -> None:
    known = law().vocabulary
    for seed in range(6):
        of = random_case(seed)
        for verdict in of.best().verdicts:
            facts: Mapping[str, Value] = verdict.plan.facts
            for name, value in facts.items():
                fact = known.fact(name)
                assert fact.kind in {"boolean", "quantity", "enumeration", "set", "count"}
                if fact.kind == "enumeration":
                    assert value in fact.values, name
                if fact.kind == "set":
                    assert set(value) <= set(fact.values), name  # type: ignore[arg-type]
