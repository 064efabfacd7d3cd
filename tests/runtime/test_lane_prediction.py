"""Road users predicted along their lanes."""

import math
from dataclasses import replace

import numpy as np
import pytest
from regdb_runtime.maps.lane_graph import LaneGraph
from regdb_runtime.maps.lane_path import LanePaths
from regdb_runtime.observation import Track
from regdb_runtime.planning.prediction import ConstantVelocity
from regdb_runtime.strategy.lane_prediction import AlongLanes
from strategy_scenes import car, crossing, cyclist

TIMES = np.arange(51) * 0.1


@pytest.fixture(scope="module")
def predictor() -> AlongLanes:
    road = crossing()
    return AlongLanes(LaneGraph(road), LanePaths(road))


def test_a_car_on_a_straight_lane_goes_on_at_its_speed_and_offset(predictor):
    found = predictor.predict([replace(car("a", -150.0, 12.0), y=-5.0, heading=0.05)], TIMES)
    assert found.x[0] == pytest.approx(-150.0 + 12.0 * TIMES, abs=0.01)
    assert found.y[0] == pytest.approx(-5.0, abs=0.01)


def test_who_signals_right_is_taken_to_turn_right(predictor):
    turning = replace(car("a", -8.0, 6.0), turn_signal="right")
    found = predictor.predict([turning], TIMES)
    assert found.heading[0, -1] == pytest.approx(-math.pi / 2, abs=0.2)
    assert predictor.predict([replace(turning, turn_signal=None)], TIMES).heading[0, -1] == pytest.approx(0.0, abs=0.1)


def test_who_is_within_the_turn_follows_it(predictor):
    path = predictor.built.along(("crossing.e.right",)).path
    half = path.length / 2
    (x, y), heading = path.to_plane(half)[0], float(path.heading(half))
    found = predictor.predict([Track("a", "car", float(x), float(y), heading, 5.0, 4.6, 1.8)], TIMES)
    within = slice(0, int(half / 0.5))
    stations, offsets = path.project(np.stack((found.x[0, within], found.y[0, within]), axis=1))
    assert offsets == pytest.approx(0.0, abs=0.05)
    assert np.diff(stations) == pytest.approx(0.5, abs=0.02)
    assert found.heading[0, -1] == pytest.approx(-math.pi / 2, abs=0.1)


@pytest.mark.parametrize("track", [
    Track("walker", "pedestrian", -50.0, -5.0, 1.5, 1.4, 0.5, 0.5), replace(car("standing", -50.0, 0.0)),
    replace(car("across", -50.0, 8.0), heading=1.2), replace(car("off the road", -50.0, 8.0), y=80.0),
])  # fmt: skip
def test_everybody_else_goes_straight_on(predictor, track):
    found, plain = predictor.predict([track], TIMES), ConstantVelocity().predict([track], TIMES)
    for name in ("x", "y", "heading", "speed", "reach"):
        assert getattr(found, name).tobytes() == getattr(plain, name).tobytes()


def test_the_first_instant_is_where_they_are_and_the_same_input_gives_the_same_bytes(predictor):
    tracks = [car("a", -20.0, 9.0), cyclist(-60.0), car("b", -100.0, 14.0, lane=2)]
    first, second = predictor.predict(tracks, TIMES), predictor.predict(tracks, TIMES)
    assert first.x[:, 0] == pytest.approx([track.x for track in tracks], abs=1e-9)
    assert first.y[:, 0] == pytest.approx([track.y for track in tracks], abs=1e-9)
    assert first.x.tobytes() == second.x.tobytes()
