"""Safe distances on arrays: the numbers worked out by hand from the article's definitions, and one at a time from the formulas."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from regdb_runtime import formulas
from regdb_runtime.planning.safe_distance import SafeDistances, shortfall

SAFE = SafeDistances()
SPEEDS = st.floats(0, 40)


def test_definition_1_by_hand() -> None:
    """20 m/s behind 10 m/s: 20 + 1.75 + 23.5^2 / 8 - 10^2 / 16."""
    assert SAFE.longitudinal(np.array([20.0]), np.array([10.0])) == pytest.approx([20 + 1.75 + 23.5**2 / 8 - 100 / 16])
    assert SAFE.longitudinal(np.array([0.0]), np.array([30.0])) == pytest.approx([0.0])


def test_definition_6_by_hand() -> None:
    """0.5 m/s towards the right, the other still: 0.1 + (0.6 + 0.7^2/1.6) + (0.1 + 0.2^2/1.6)."""
    assert SAFE.lateral(np.array([0.5]), np.array([0.0])) == pytest.approx([0.1 + 0.6 + 0.49 / 1.6 + 0.1 + 0.04 / 1.6])


def test_two_who_part_need_the_margin_alone() -> None:
    assert SAFE.lateral(np.array([-3.0]), np.array([-3.0])) == pytest.approx([0.1])


@given(SPEEDS, SPEEDS, st.floats(-3, 3), st.floats(-3, 3))
def test_arrays_agree_with_the_formulas_of_interpretations(rear: float, front: float, left: float, right: float) -> None:
    one = formulas.rss_longitudinal(rear, front, response_time=1.0, max_acceleration=3.5, min_braking=4.0, max_braking=8.0)
    assert SAFE.longitudinal(np.array([rear]), np.array([front]))[0] == pytest.approx(one, abs=1e-9)
    aside = formulas.rss_lateral(
        left, right, response_time=1.0, max_lateral_acceleration=0.2, min_lateral_braking=0.8, fluctuation_margin=0.1
    )
    assert SAFE.lateral(np.array([left]), np.array([-right]))[0] == pytest.approx(aside, abs=1e-9)


def test_stopping_distance_on_arrays() -> None:
    """35 mph: AASHTO's design value of 250 ft at 2.5 s and 11.2 ft/s^2 (Green Book, table 3-1: 246.2 ft calculated)."""
    speeds = np.array([0.0, 35 * 0.44704])
    found = formulas.stopping_distance(speeds, response_time=2.5, min_braking=11.2 * 0.3048)
    assert found == pytest.approx([0.0, 246.2 * 0.3048], rel=2e-3)


def test_shortfall_is_the_missing_share() -> None:
    gaps, safe = np.array([10.0, 5.0, 0.0, -1.0, 1.0]), np.array([10.0, 10.0, 10.0, 10.0, 0.0])
    assert shortfall(gaps, safe).tolist() == [0.0, 0.5, 1.0, 1.0, 0.0]
