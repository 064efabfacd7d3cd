"""Changes of speed and ways to a point: their ends, and that the rest of one is one."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from regdb_runtime.planning.polynomials import Chains, change_speed, change_time, change_way, quintic

SPEEDS, CHANGES, TIMES = st.floats(0, 40), st.floats(-5, 3), st.floats(0.3, 15)


def values(pieces: np.ndarray, time: float) -> tuple[float, float, float]:
    chain = Chains(np.zeros((1, 1)), pieces.reshape(1, 1, 6)).at(np.array([time]))
    return tuple(float(row[0, 0]) for row in chain)  # type: ignore[return-value]


@given(SPEEDS, CHANGES, SPEEDS, TIMES)
def test_change_of_speed_meets_both_ends(speed: float, acceleration: float, end: float, duration: float) -> None:
    pieces = change_speed(speed, acceleration, end, duration)
    assert values(pieces, 0.0) == pytest.approx((0.0, speed, acceleration), abs=1e-9)
    assert values(pieces, duration) == pytest.approx((float(change_way(duration, speed, acceleration, end)), end, 0.0), abs=1e-6)


@given(SPEEDS, CHANGES, st.floats(-50, 300), SPEEDS, CHANGES, TIMES)
def test_quintic_meets_both_ends(speed: float, acceleration: float, way: float, end: float, last: float, duration: float) -> None:
    pieces = quintic((1.0, speed, acceleration), (way, end, last), duration)
    assert values(pieces, 0.0) == pytest.approx((1.0, speed, acceleration), abs=1e-9)
    assert values(pieces, duration) == pytest.approx((way, end, last), rel=1e-6, abs=1e-5)


@given(st.floats(1, 40), st.floats(0, 0.9), st.floats(5, 300), st.floats(0.05, 0.95))
def test_the_rest_of_a_change_is_the_change_over_the_rest(speed: float, share: float, way: float, part: float) -> None:
    """What makes planning anew stable: half way to the line, the plan to the line is the rest of the old plan."""
    end = speed * share
    duration = float(change_time(way, speed, 0.0, end))
    done, now, rate = values(change_speed(speed, 0.0, end, duration), part * duration)
    assert float(change_time(way - done, now, rate, end)) == pytest.approx((1 - part) * duration, rel=1e-4)


def test_no_change_where_the_way_is_none() -> None:
    assert math.isnan(float(change_time(-1.0, 10.0, 0.0, 0.0)))
    assert math.isnan(float(change_time(50.0, 5.0, -2.0, 0.0)))  # at 2 m/s^2 it stands long before 50 m
    assert float(change_time(20.0, 10.0, 0.0, 0.0)) == pytest.approx(4.0)


def test_chains_change_piece_at_the_seam() -> None:
    chain = Chains(np.array([[0.0, 1.0, 2.0]]), np.array([[[0, 1.0, 0, 0, 0, 0], [1.0, 1.0, 1.0, 0, 0, 0], [3.0, 3.0, 0, 0, 0, 0]]]))
    value, first, second = chain.at(np.array([0.0, 0.5, 1.0, 1.5, 2.0, 4.0]))
    assert value[0].tolist() == [0.0, 0.5, 1.0, 1.75, 3.0, 9.0]
    assert first[0].tolist() == [1.0, 1.0, 1.0, 2.0, 3.0, 3.0]
    assert second[0].tolist() == [0.0, 0.0, 2.0, 2.0, 0.0, 0.0]
