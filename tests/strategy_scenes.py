"""Streets, tracks and a strategist for the tests of strategy and planner: a straight road with two lanes that meets a junction."""

from __future__ import annotations

import datetime
from functools import cache
from typing import Any

from regdb_runtime.database import RegulationDatabase
from regdb_runtime.maps.road_map import Marking, RoadMap, Turn
from regdb_runtime.maps.route import Route, route_along
from regdb_runtime.observation import EgoState, Footprint, Indication, Observation, Track
from regdb_runtime.scenes.tellers import tellers
from regdb_runtime.strategy.machine import Machine
from regdb_runtime.strategy.maneuvers import Strategist
from regdb_runtime.strategy.memory import Memory
from regdb_runtime.strategy.paths import paths_of
from regdb_runtime.strategy.settings import StrategySettings
from regdb_runtime.worlds.road_builder import build_road_map, follow_turns
from regdb_runtime.worlds.road_spec import Arm, Control, JunctionSpec, Piece, Pose, RoadSpec, SignalPhase, StreetsSpec

from regdb.front import database
from regdb.situation import quiet_facts
from regdb.vocabulary import Value

CLOCK = datetime.datetime(2026, 3, 4, 12, 0)  # local time, as an observation has it
LENGTH = 300.0
HALF = 16.0
WEST = "first.e.1"
"""The right-hand lane of the road that leads east to the junction, which begins at x = 0; the limit line lies a little before it."""


@cache
def law() -> RegulationDatabase:
    """The shipped codes."""
    return RegulationDatabase.open(database())


@cache
def quiet_eye() -> dict[str, Value]:
    """What an eye reports that sees nothing of note: the quiet value of every fact that is the eye's to tell."""
    asked = tellers(law().vocabulary)
    return {name: value for name, value in quiet_facts(law().vocabulary).items() if asked[name] == "eye"}


def crossing(control: Control = "signal", lanes: int = 2, width: float = 3.5, divider: Marking = "dashed") -> RoadMap:
    """A road of 300 m from the west, two roads across, one on to the east; every way with `lanes` lanes, the ones across with one."""
    roads = (
        RoadSpec("first", (Piece(LENGTH),), Pose(-LENGTH, 0.0, 0.0), lanes, lanes, width, center="double_solid", divider=divider),
        RoadSpec("ahead", (Piece(LENGTH),), Pose(2 * HALF, 0.0, 0.0), lanes, lanes, width, center="double_solid", divider=divider),
        RoadSpec("north", (Piece(LENGTH),), Pose(HALF, HALF + LENGTH, 270.0), 1, 1, 3.5, center="double_solid"),
        RoadSpec("south", (Piece(LENGTH),), Pose(HALF, -HALF, 270.0), 1, 1, 3.5, center="double_solid"),
    )
    arms = (Arm("first", "end"), Arm("ahead", "start"), Arm("north", "end"), Arm("south", "start"))
    phases = (SignalPhase(("e", "w"), 30.0), SignalPhase(("n", "s"), 30.0)) if control == "signal" else ()
    return build_road_map(StreetsSpec(roads, (JunctionSpec("crossing", arms, control, phases),)), law().vocabulary)


def straight(lanes: int = 2, length: float = 1500.0, **changes: Any) -> RoadMap:
    """A straight road without junctions, from x = 0 on."""
    road = RoadSpec("first", (Piece(length),), Pose(0.0, 0.0, 0.0), lanes, lanes, **changes)
    return build_road_map(StreetsSpec((road,)), law().vocabulary)


def route(road_map: RoadMap, *turns: Turn, lane: str = WEST) -> Route:
    """From a lane on, with these turns."""
    return route_along(road_map, follow_turns(road_map, lane, turns))


def strategist(road_map: RoadMap, *turns: Turn, lane: str = WEST, settings: StrategySettings | None = None) -> Strategist:
    """A strategist for a route."""
    settings = settings or StrategySettings()
    way = route(road_map, *turns, lane=lane)
    machine = Machine(law().machine)
    return Strategist(machine, road_map, way, Footprint(), settings, paths_of(road_map, way, Footprint(), settings))


def ego(x: float, speed: float = 15.0, y: float | None = None, lane: int = 1, width: float = 3.5, lanes: int = 2) -> EgoState:
    """The vehicle driving east with its rear axle at x, in a lane counted from the right."""
    return EgoState(x, center(lane, width, lanes) if y is None else y, 0.0, speed)


def center(lane: int = 1, width: float = 3.5, lanes: int = 2) -> float:
    """y of a lane's centre on the road that leads east."""
    return -(lanes - lane + 0.5) * width


def car(name: str, x: float, speed: float, lane: int = 1, **changes: Any) -> Track:
    """A car whose middle is at x."""
    return Track(name, "car", x, center(lane), 0.0, speed, 4.6, 1.8, **changes)


def cyclist(x: float, speed: float = 4.5, lane: int = 1, from_edge: float = 0.1, width: float = 3.5, lanes: int = 2) -> Track:
    """A cyclist near the right-hand edge of a lane."""
    return Track("cyclist", "bicycle", x, center(lane, width, lanes) - width / 2 + from_edge + 0.3, 0.0, speed, 1.8, 0.6)


def seen(state: EgoState, *tracks: Track, time: float = 0.0, light: str = "", road_map: RoadMap | None = None, **facts: Any) -> Observation:
    """An observation; `light`: the colour that every light of the map shows."""
    signals = {name: (Indication(light),) for name in road_map.lights} if light and road_map else {}  # type: ignore[arg-type]
    eye = quiet_eye() | {name.replace("__", "."): value for name, value in facts.items()}
    return Observation(time, CLOCK + datetime.timedelta(seconds=time), state, tracks, signals, eye)


def offers(plans: Strategist, observation: Observation, state: str = "lane_following.go_straight", **memory: Any) -> dict[str, str]:
    """Next state -> why it is refused, empty when it is offered."""
    picture = plans.picture(observation, Memory(state, **memory), 15.6464)
    return {item.next: item.refused for item in plans.maneuvers(picture)}
