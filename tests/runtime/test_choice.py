"""The choice: no weight buys a breach, the order of candidates does not matter, and the lesser breach is told by duties."""

import math
import re
from dataclasses import dataclass
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from regdb_runtime.database import RegulationDatabase
from regdb_runtime.planning.choice import LAWFUL, NO_PLAN, UNKNOWN, UNLAWFUL, choose
from regdb_runtime.planning.cost import CostTerms
from regdb_runtime.planning.duties import DUTIES, count, violations
from regdb_runtime.verdict import Verdict

from regdb.condition import Linear
from regdb.front import database
from regdb.meaning import LimitInForce
from regdb.regulation import Limit, Regulation
from regdb.situation import Plan, Scene, quiet_facts
from regdb.units import to_si


@dataclass(frozen=True)
class Candidate:
    rank: int
    cost: CostTerms | None
    verdict: Verdict | None = None
    breach: tuple[float, ...] = ()
    name: int = 0


def costing(total: float, rank: int = LAWFUL, breach: tuple[float, ...] = (), name: int = 0) -> Candidate:
    return Candidate(rank, CostTerms(0.0, 0.0, 0.0, 0.0, total), None, breach, name)


def breach(option: object) -> tuple[float, ...]:
    assert isinstance(option, Candidate)
    return option.breach


weights = st.floats(1e-6, 1e6)
terms = st.floats(-1e4, 1e4)


@st.composite
def weighed(draw: st.DrawFn) -> list[Candidate]:
    """Candidates whose totals come from one set of positive weights, whatever these are, even where they make a breach cheap."""
    legal, safety, comfort, distance = (draw(weights) for _ in range(4))
    found = []
    for name in range(draw(st.integers(1, 8))):
        rank = draw(st.sampled_from((LAWFUL, UNKNOWN, UNLAWFUL, NO_PLAN)))
        parts = [draw(terms) for _ in range(3)]
        total = legal * (0.0, 1.0, 10.0, 10.0)[rank] + safety * parts[0] + comfort * parts[1] + distance * parts[2]
        has_plan = rank != NO_PLAN
        breaks = (float(draw(st.integers(0, 2))), float(draw(st.integers(0, 2)))) if rank == UNLAWFUL else ()
        found.append(Candidate(rank, CostTerms(0.0, *parts, total) if has_plan else None, None, breaks, name))
    return found


@given(weighed())
def test_no_weights_let_a_lesser_rank_win(options: list[Candidate]) -> None:
    chosen = choose(options, breaches=breach)
    best = min(option.rank for option in options)
    if best == NO_PLAN:
        assert chosen.index is None
        assert chosen.flag == "no_trajectory"
        return
    assert chosen.index is not None
    taken = options[chosen.index]
    assert taken.rank == best
    assert chosen.flag == ("", "unknown", "least_violation")[best]
    for other in options:
        if other.rank == best and other.cost is not None and taken.cost is not None:
            assert (taken.breach, taken.cost.total) <= (other.breach, other.cost.total)
    assert chosen.margin is None or chosen.margin >= 0.0


@given(weighed(), st.randoms(use_true_random=False))
def test_the_order_of_candidates_does_not_matter(options: list[Candidate], dice: object) -> None:
    shuffled = list(options)
    dice.shuffle(shuffled)  # type: ignore[attr-defined]
    one = choose(options, ties=[option.name for option in options], breaches=breach)
    two = choose(shuffled, ties=[option.name for option in shuffled], breaches=breach)
    assert (one.margin, one.flag, one.violations) == (two.margin, two.flag, two.violations)
    if one.index is not None and two.index is not None:
        assert options[one.index].name == shuffled[two.index].name
    else:
        assert one.index is two.index is None


def test_equal_costs_are_settled_by_the_order_given() -> None:
    assert choose([costing(1.0), costing(1.0)]).index == 0
    assert choose([costing(1.0), costing(1.0)], ties=[5, 2]).index == 1
    assert choose([costing(1.0), costing(1.0)]).margin == 0.0


def test_the_margin_is_to_the_next_of_the_same_rank() -> None:
    assert choose([costing(1.0), costing(0.0, UNLAWFUL), costing(4.0), costing(2.5)], breaches=breach).margin == 1.5
    assert choose([costing(1.0), costing(0.0, UNKNOWN)]).margin is None


def test_what_cannot_be_counted_is_taken_last() -> None:
    chosen = choose([costing(math.nan), costing(1e9)])
    assert (chosen.index, chosen.margin) == (1, None)
    assert choose([costing(math.nan)]).index == 0


def test_nothing_to_choose_from() -> None:
    assert choose([]).flag == "no_trajectory"


def rule(name: str, topic: str, *attributes: str) -> Regulation:
    limits = tuple(Limit(attribute, "plan.speed", "max", Linear(10.0)) for attribute in attributes)
    return Regulation(name, name, "here", legality=False, topic=topic, limits=limits)


def place(name: str) -> int:
    return next(index for index, duty in enumerate(DUTIES) if duty.name == name)


def test_a_breach_is_filed_under_the_weightiest_duty_it_touches() -> None:
    found = count([rule("a", "red-signal"), rule("b", "pedestrian-crosswalk"), rule("c", "pedestrian-crosswalk"), rule("d", "headlamps")], (), {})
    assert found[place("persons on foot")] == 1.0, "two rules of one topic are one breach"
    assert found[place("signals and stops")] == 1.0
    assert found[-1] == 1.0
    assert sum(found) == 3.0


def test_a_limit_counts_by_how_far_it_is_passed() -> None:
    speeding = rule("a", "maximum-speed", "max_speed")
    held = LimitInForce(speeding.limits[0], 10.0, speeding)
    at = place("speed")
    assert count([speeding], [held], {"plan.speed": 11.0})[at] == pytest.approx(0.1)
    assert count([speeding], [held], {"plan.speed": 50.0})[at] == 1.0
    assert count([speeding], [held], {})[at] == 1.0, "not measured counts in full"
    three_feet = Limit("min_clearance", "plan.clearance", "min", Linear(0.9144))
    near = Regulation("p", "p", "here", legality=False, topic="passing-bicycle", limits=(three_feet,))
    measured = count([near], [LimitInForce(near.limits[0], 0.9144, near)], {"plan.clearance": 0.4572})
    assert measured[place("persons on bicycles and at work")] == pytest.approx(0.5)


def test_to_speed_a_little_is_less_than_to_run_a_light() -> None:
    speed = count([rule("a", "maximum-speed", "max_speed")], (), {})
    light = count([rule("b", "red-signal")], (), {})
    chosen = choose([costing(0.0, UNLAWFUL, light), costing(99.0, UNLAWFUL, speed)], breaches=breach)
    assert (chosen.index, chosen.flag, chosen.violations) == (1, "least_violation", speed)


def test_duties_name_topics_and_attributes_that_the_shipped_law_has() -> None:
    law = RegulationDatabase.open(database())
    topics, attributes = set(), set()
    for code in ("cvc", "uvc", "la_city", "lacounty"):
        for day in ("2005-01-01", "2020-01-01", "2026-01-01"):
            rules = law.at(code, day).rules
            topics |= {item.topic for item in rules}
            attributes |= {limit.attribute for item in rules for limit in item.limits}
    named = [topic for duty in DUTIES for topic in duty.topics]
    assert len(named) == len(set(named)), "a topic belongs to one duty"
    assert set(named) <= topics, sorted(set(named) - topics)
    assert {name for duty in DUTIES for name in duty.attributes} <= attributes


@pytest.mark.parametrize(("speed", "beyond"), [(105.0, 40 / 65 + 1), (66.0, 1 / 65), (65.0, 0.0)])
def test_a_verdict_of_the_shipped_law_is_measured(speed: float, beyond: float) -> None:
    """On a freeway, where the maximum speed is 65 mph (CVC 22349(a)); over 100 mph the graver offence (22348(b)) is one breach more."""
    law = RegulationDatabase.open(database())
    facts = quiet_facts(law.vocabulary)
    facts |= {"road.types": ["highway", "freeway"], "road.divided": True, "road.lanes": 8, "road.lanes_same_direction": 4}
    state = "lane_following.go_straight"
    verdict = law.at("cvc", "2026-03-02").judge(Scene(facts), Plan(state, state, {"plan.speed": to_si(speed, "mph")}))
    assert (verdict.verdict == "illegal") == (beyond > 0.0)
    found = violations(verdict)
    assert found[place("speed")] == pytest.approx(beyond)
    assert sum(found) == found[place("speed")]


def test_the_documentation_lists_the_duties_in_their_order() -> None:
    page = Path(__file__).parents[2] / "docs" / "explanation" / "costs-and-choice.md"
    listed = re.findall(r"^\d+\. (.+)$", page.read_text(encoding="utf-8"), re.MULTILINE)
    assert listed == [*(duty.name for duty in DUTIES), "everything else"]
