"""Four roads of one lane each way that meet, with lights or all-way stops: streets for tests of SUMO."""

from __future__ import annotations

import math
from typing import Any

from regdb_runtime.worlds.road_spec import Arm, JunctionSpec, Piece, Pose, RoadSpec, SignalPhase, StreetsSpec
from regdb_runtime.worlds.scene_spec import EgoSpec, SceneSpec

HALF = 14.0
"""From the junction's middle to the mouths of its roads, metres."""


def _road(name: str, degrees: float, **more: Any) -> RoadSpec:
    """A road of 200 m away from the junction towards `degrees`."""
    turn = math.radians(degrees)
    return RoadSpec(name, (Piece(200.0),), Pose(HALF * math.cos(turn), HALF * math.sin(turn), degrees), 1, 1, **more)


ROADS = tuple(_road(name, degrees) for name, degrees in (("east", 0), ("north", 90), ("west", 180), ("south", 270)))
SIGNALS = JunctionSpec(
    "cross", tuple(Arm(road.id, "start") for road in ROADS), "signal", (SignalPhase(("n", "s"), 20.0), SignalPhase(("e", "w"), 20.0)))  # fmt: skip
ALL_WAY = JunctionSpec("cross", tuple(Arm(road.id, "start") for road in ROADS), "all_way_stop")


def scene(junction: JunctionSpec, **more: Any) -> SceneSpec:
    """The ego stands on the south road, out of everybody's way."""
    return SceneSpec("sumo", StreetsSpec(ROADS, (junction,)), EgoSpec("south.n.1", 10.0), **more)
