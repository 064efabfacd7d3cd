"""A straight road with two lanes one way and one the other, its law on one day, and manoeuvres on it: what the assessment's tests judge."""

from __future__ import annotations

import datetime
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np
from regdb_runtime.assessment.assessed import Assessed
from regdb_runtime.assessment.assessor import Assessor
from regdb_runtime.assessment.settings import AssessmentSettings
from regdb_runtime.database import RegulationDatabase
from regdb_runtime.maneuver import LanePath, Maneuver
from regdb_runtime.maps.lane_path import lane_path
from regdb_runtime.maps.road_map import Marking, RoadMap
from regdb_runtime.observation import EgoState, Footprint, Observation, Track
from regdb_runtime.planning.contacts import Sweeper
from regdb_runtime.planning.cost import MotionCosts, motion_cost
from regdb_runtime.planning.cost_settings import DEFAULT
from regdb_runtime.planning.goal import Goal
from regdb_runtime.planning.kinematic_limits import check
from regdb_runtime.planning.lattice import sample
from regdb_runtime.planning.prediction import ConstantVelocity, Predictions
from regdb_runtime.planning.settings import VehicleLimits
from regdb_runtime.scenes.stretch import Stretch
from regdb_runtime.trajectory import Candidates, FrenetState
from regdb_runtime.worlds.road_builder import build_road_map
from regdb_runtime.worlds.road_spec import Piece, RoadSpec, StreetsSpec

from regdb.front import database
from regdb.situation import Scene, quiet_facts
from regdb.vocabulary import Value

MPH = 0.44704
FOOTPRINT = Footprint()
CLOCK = datetime.datetime(2026, 3, 2, 10)
PLACE = "los_angeles"
GO = "lane_following.go_straight"
PASS = "overtaking.go_straight"
RIGHT, LEFT, ONCOMING = "main.e.1", "main.e.2", "main.w.1"
WIDTH = 3.5
RIGHT_Y, LEFT_Y = -1.5 * WIDTH, -0.5 * WIDTH
POSTED: dict[str, Value] = {"sign.speed_limit": True, "posted.speed": 35 * MPH, "local.speed_declared": True}
SCHOOL: dict[str, Value] = {**POSTED, "sign.school": True, "school.present": True, "school.children_going": True}


@lru_cache(maxsize=1)
def law() -> RegulationDatabase:
    return RegulationDatabase.open(database())


@lru_cache(maxsize=8)
def road(forward: int = 2, center: Marking = "double_solid", divider: Marking = "dashed") -> RoadMap:
    main = RoadSpec("main", (Piece(500),), forward=forward, backward=1, center=center, divider=divider)
    return build_road_map(StreetsSpec((main,)), law().vocabulary)


@lru_cache(maxsize=8)
def along(lane: str = RIGHT) -> LanePath:
    return lane_path(road(), None, lane, 400.0, 0.0)


def stretch(
    start: float, end: float, facts: Mapping[str, Value], roles: Mapping[str, Value] | None = None, unknown: Sequence[str] = (), **more: Any
) -> Stretch:
    """A stretch in which everything is quiet but the facts told."""
    told = {**quiet_facts(law().vocabulary), "lane.same_direction_available": False, **facts}
    scene = Scene({name: value for name, value in told.items() if not name.startswith("plan.") and name not in unknown})
    view = law().at(PLACE, CLOCK.date())
    return Stretch(start, end, PLACE, CLOCK, view, scene, law().prepare(scene), roles or {}, RIGHT, **more)


def maneuver(current: str = GO, following: str = GO, lane: str = RIGHT, goal: Goal | None = None, **more: Any) -> Maneuver:
    return Maneuver(current, following, lane, along(lane), goal or Goal(cruise_speed=20.0), **more)


def bicycle(ahead: float, y: float, speed: float = 4.0) -> Track:
    return Track("bike", "bicycle", ahead, y, 0.0, speed, 1.8, 0.6)


def car(name: str, x: float, y: float, speed: float) -> Track:
    return Track(name, "car", x, y, 0.0, speed, 4.8, 1.8)


@dataclass(frozen=True, eq=False)
class Case:
    """One manoeuvre's plans, ready to be assessed."""

    maneuver: Maneuver
    stretches: tuple[Stretch, ...]
    candidates: Candidates
    costs: MotionCosts
    ok: np.ndarray  # type: ignore[type-arg]
    predictions: Predictions
    observation: Observation
    assessor: Assessor

    def best(self) -> Assessed:
        return self.assessor.best(
            self.maneuver, self.stretches, self.candidates, self.costs.order(), self.costs.weighted, self.observation, self.predictions,
            self.ok, Sweeper(self.predictions, FOOTPRINT),
        )  # fmt: skip


def case(
    planned: Maneuver, stretches: Sequence[Stretch], tracks: Sequence[Track] = (), start: FrenetState | None = None, profile: str | None = "rss",
    settings: AssessmentSettings | None = None, *, capped: bool = True,
) -> Case:  # fmt: skip
    """Sample a manoeuvre's plans. `capped` False leaves the law's limits to the judging alone."""
    begin = start or FrenetState(60.0, 15.0)
    assessor = Assessor(law(), FOOTPRINT, settings, law().interpretations[profile] if profile else None, road())
    if capped:
        planned = replace(planned, goal=replace(planned.goal, caps=assessor.caps(planned, stretches)))
    candidates = sample(planned.lane_path.path, begin, planned.goal, FOOTPRINT)
    ok = check(candidates, VehicleLimits(), planned.goal, FOOTPRINT).ok
    seen = ConstantVelocity().predict(tuple(tracks), candidates.time)
    ego = EgoState(float(candidates.x[0, 0]), float(candidates.y[0, 0]), float(candidates.heading[0, 0]), begin.s_dot)
    observation = Observation(0.0, CLOCK, ego, tuple(tracks))
    return Case(planned, tuple(stretches), candidates, motion_cost(candidates, DEFAULT, 20.0), ok, seen, observation, assessor)
