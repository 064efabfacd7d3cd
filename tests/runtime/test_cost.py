"""The cost of plans: each part from its definition, the paper's sum, others on the way, and what weights mean."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from regdb_runtime.maps.reference_path import ReferencePath
from regdb_runtime.observation import Footprint, Track
from regdb_runtime.planning.cost import motion_cost, weigh
from regdb_runtime.planning.cost_settings import DEFAULT, PAPER, UNITS, CostSettings, Weights, settings
from regdb_runtime.planning.prediction import ConstantVelocity
from regdb_runtime.planning.users_along_path import UsersAlongPath, users_along
from regdb_runtime.trajectory import Candidates

FOOTPRINT = Footprint()
TIME = np.arange(51) * 0.1
PATH = ReferencePath(np.array([[-100.0, 0.0], [0.0, 0.0], [200.0, 0.0]]))
HERE = (0.0, 0.0)


def plans(*speeds: float, offset: float = 0.0, acceleration: float = 0.0, curvature: float = 0.0) -> Candidates:
    """Straight plans from the path's station of the origin, at constant acceleration."""
    start = np.array(speeds)[:, None]
    speed = start + acceleration * TIME
    way = start * TIME + acceleration * TIME**2 / 2
    flat = np.zeros_like(way)
    return Candidates(
        TIME, way, flat + offset, flat, speed, flat + acceleration, flat, flat + curvature, way + 100.0, flat + offset
    )


def wavy(count: int, seed: int) -> Candidates:
    dice = np.random.default_rng(seed)
    rows = [dice.normal(size=(count, 51)) for _ in range(9)]
    return Candidates(TIME, *rows)


def test_the_papers_profile_has_its_three_terms_and_the_advance_alone() -> None:
    many = wavy(20, 1)
    costs = motion_cost(many, PAPER)
    acceleration = np.mean(np.abs(many.acceleration), axis=1)
    variance = np.var(many.speed, axis=1)
    curvature = np.max(np.abs(many.curvature), axis=1)
    assert costs.safety + costs.comfort == pytest.approx(acceleration + variance + curvature)
    assert costs.distance == pytest.approx(-(many.station[:, -1] - many.station[:, 0]))
    assert set(costs.parts) == {"mean_acceleration", "speed_variance", "max_curvature", "advance"}


def test_braking_counts_as_speeding_up_does() -> None:
    up, down = motion_cost(plans(10.0, acceleration=1.5), PAPER), motion_cost(plans(17.5, acceleration=-1.5), PAPER)
    assert up.parts["mean_acceleration"] == pytest.approx([1.5])
    assert up.weighted == pytest.approx(down.weighted)


def test_a_bend_to_either_side_costs_the_same() -> None:
    left, right = motion_cost(plans(10.0, curvature=0.1), PAPER), motion_cost(plans(10.0, curvature=-0.1), PAPER)
    assert left.parts["max_curvature"] == right.parts["max_curvature"] == pytest.approx([0.1])


def test_the_farther_plan_costs_less_and_the_wanted_one_nothing() -> None:
    costs = motion_cost(plans(10.0, 15.0), PAPER, wanted_speed=15.0)
    assert costs.distance == pytest.approx([25.0, 0.0])


def test_weights_multiply_their_terms() -> None:
    costs = motion_cost(wavy(5, 2), CostSettings(weights=Weights(2.0, 3.0, 5.0, 7.0), safety=PAPER.safety, comfort=(("jerk", 0.1),)))
    for rank, legal in ((0, 0.0), (1, 100.0), (2, 1000.0)):
        terms = weigh(costs, 3, rank, added=4.0)
        assert terms.legal == legal
        assert terms.distance == pytest.approx(float(costs.distance[3]) + 4.0)
        assert terms.total == pytest.approx(2 * terms.legal + 3 * terms.safety + 5 * terms.comfort + 7 * terms.distance)
    assert terms.parts["jerk"] == pytest.approx(float(np.mean(wavy(5, 2).jerk[3] ** 2)))


def test_plans_are_ordered_by_cost_with_ties_in_their_own_order() -> None:
    costs = motion_cost(plans(10.0, 15.0, 10.0, 12.0), PAPER)
    assert costs.order().tolist() == [1, 3, 0, 2]
    assert costs.order(np.array([2, 0, 3])).tolist() == [3, 0, 2]


def test_settings_are_sound() -> None:
    assert settings("paper") is PAPER
    assert settings("default") is DEFAULT
    assert not PAPER.asks_for_others
    assert DEFAULT.asks_for_others
    assert {name for profile in (PAPER, DEFAULT) for name, _ in profile.safety + profile.comfort} <= set(UNITS)
    with pytest.raises(ValueError, match="not negative"):
        Weights(safety=-1.0)
    with pytest.raises(ValueError, match="no such part of a cost: politeness"):
        motion_cost(plans(1.0), CostSettings(comfort=(("politeness", 1.0),)))


def seen(*tracks: Track, path: ReferencePath = PATH, chosen: CostSettings = DEFAULT) -> UsersAlongPath:
    return users_along(path, ConstantVelocity().predict(tracks, TIME), HERE, FOOTPRINT, chosen)


def user(x: float, y: float, speed: float = 0.0, heading: float = 0.0) -> Track:
    return Track(f"{x} {y}", "car", x, y, heading, speed, 4.8, 1.8)


def test_clearance_costs_below_what_is_wanted() -> None:
    def short(gap: float) -> float:
        return float(motion_cost(plans(12.0), DEFAULT, users=seen(user(30.0, 1.8 + gap))).parts["clearance"][0])

    assert short(1.6) == 0.0
    assert short(0.75) == pytest.approx(0.5, abs=1e-5)
    assert short(0.0) == pytest.approx(1.0, abs=1e-5)
    assert short(0.9144) == pytest.approx(1 - 0.9144 / 1.5, abs=1e-5)


def test_following_too_near_is_short_of_the_safe_distance() -> None:
    gap = 20.0
    ahead = seen(user(FOOTPRINT.front + gap + 2.4, 0.0, 12.0))
    parts = motion_cost(plans(12.0), DEFAULT, users=ahead).parts
    needed = DEFAULT.safe.longitudinal(np.array([12.0]), np.array([12.0]))[0]
    assert parts["rss_longitudinal"] == pytest.approx([1 - gap / needed], abs=1e-5)
    assert parts["rss_lateral"] == pytest.approx([1.0])
    slower = motion_cost(plans(6.0), DEFAULT, users=ahead).parts
    assert slower["rss_longitudinal"][0] < parts["rss_longitudinal"][0]


def test_beside_one_another_nobody_is_in_danger_but_drifting_over_is() -> None:
    beside = seen(user(10.0, 3.5, 12.0))
    assert motion_cost(plans(12.0), DEFAULT, users=beside).parts["rss_longitudinal"].tolist() == [0.0]
    drift = plans(12.0)
    drift.offset[:] = 0.5 * TIME
    parts = motion_cost(drift, DEFAULT, users=beside).parts
    assert parts["rss_longitudinal"][0] > 0.0
    assert parts["rss_lateral"][0] > 0.0


def test_who_follows_us_keeps_his_own_distance() -> None:
    behind = seen(user(-8.0, 0.0, 12.0))
    assert motion_cost(plans(12.0), DEFAULT, users=behind).parts["rss_longitudinal"].tolist() == [0.0]


def test_pulling_out_before_a_fast_one_is_our_doing() -> None:
    fast = seen(user(-15.0, 3.5, 20.0))
    out = plans(10.0)
    out.offset[:] = np.minimum(TIME, 3.5)
    assert motion_cost(out, DEFAULT, users=fast).parts["rss_longitudinal"][0] > 0.3


def test_one_who_comes_towards_us_needs_both_stopping_ways() -> None:
    oncoming = seen(user(120.0, 0.0, 12.0, math.pi), chosen=CostSettings(nearby=150.0))
    same_way = seen(user(120.0, 0.0, 12.0), chosen=CostSettings(nearby=150.0))
    assert motion_cost(plans(12.0), DEFAULT, users=oncoming).parts["rss_longitudinal"][0] == 1.0
    assert motion_cost(plans(12.0), DEFAULT, users=same_way).parts["rss_longitudinal"][0] == 0.0


def test_only_the_nearest_are_looked_at() -> None:
    crowd = [user(10.0 * i, 3.0, 1.0) for i in range(29, 0, -1)]
    assert sorted(seen(*crowd).s[:, 0]) == pytest.approx([110, 120, 130, 140, 150, 160])
    assert sorted(seen(*crowd, chosen=CostSettings(nearby=25.0)).s[:, 0]) == pytest.approx([110, 120])
    assert len(seen()) == 0
    assert motion_cost(plans(5.0), DEFAULT, users=seen()).parts["clearance"].tolist() == [0.0]


@given(st.integers(0, 50), st.integers(1, 5))
def test_users_are_weighed_the_same_one_by_one_and_together(seed: int, count: int) -> None:
    dice = np.random.default_rng(seed)
    tracks = [user(*dice.uniform((-10, -5), (35, 5)), float(dice.uniform(0, 15)), float(dice.uniform(-1, 1))) for _ in range(count)]
    many = plans(*dice.uniform(0, 15, 8))
    many.offset[:] = np.cumsum(dice.normal(size=many.offset.shape), axis=1) * 0.03
    together = motion_cost(many, DEFAULT, users=seen(*tracks)).parts
    apart = [motion_cost(many, DEFAULT, users=seen(track)).parts for track in tracks]
    for name in ("clearance", "rss_longitudinal", "rss_lateral"):
        assert together[name] == pytest.approx(np.max([parts[name] for parts in apart], axis=0))
        assert np.all((together[name] >= 0.0) & (together[name] <= 1.0))
