"""Small streets with one vehicle on them, for tests that look at what scenes are made of map, road users and history."""

from __future__ import annotations

import datetime
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import Any

from regdb_runtime.database import RegulationDatabase
from regdb_runtime.maneuver import Maneuver
from regdb_runtime.maps.lane_path import LanePath, next_junction, path_along
from regdb_runtime.observation import EgoState, Footprint, Indication, Observation, Track, TurnSignal
from regdb_runtime.planning.goal import Goal
from regdb_runtime.scenes.history import History
from regdb_runtime.scenes.settings import SceneSettings
from regdb_runtime.scenes.stretch import Stretch
from regdb_runtime.scenes.stretches import Scenes
from regdb_runtime.scenes.tellers import eye_facts
from regdb_runtime.verdict import Verdict
from regdb_runtime.worlds.road_builder import build_road_map
from regdb_runtime.worlds.road_spec import Arm, JunctionSpec, Piece, Pose, RoadSpec, SignalPhase, StreetsSpec

from regdb.front import database
from regdb.situation import Plan, quiet_facts
from regdb.vocabulary import Value

NOON = datetime.datetime(2026, 3, 4, 12, 0)
CAR = Footprint()
GO = "lane_following.go_straight"
APPROACH = "intersection_handling.go_straight"
STOP = "intersection_handling.stop"
RIGHT = "intersection_handling.turn_right"
LEFT = "intersection_handling.turn_left"
LIGHT = "x.e.light"
PHASES = (SignalPhase(("e", "w"), 20.0), SignalPhase(("n", "s"), 20.0))


@lru_cache(maxsize=1)
def law() -> RegulationDatabase:
    """The shipped codes."""
    return RegulationDatabase.open(database())


@lru_cache(maxsize=1)
def quiet_eye() -> Mapping[str, Value]:
    """What a complete eye reports where nothing is to be seen."""
    quiet = quiet_facts(law().vocabulary)
    return {name: quiet[name] for name in sorted(eye_facts(law().vocabulary)) if name in quiet}


def read(facts: Mapping[str, object]) -> dict[str, Value]:
    """Facts as people write them, in SI."""
    found = {name: law().vocabulary.fact(name).read(text) for name, text in facts.items()}
    return {name: value for name, value in found.items() if value is not None}


def road(**changes: Any) -> StreetsSpec:
    """One straight road to the east, 400 m from x = 0, its forward lanes south of y = 0; `zones`, `signs`, `facts` are the streets'."""
    streets = {name: changes.pop(name) for name in ("zones", "signs", "facts", "jurisdiction") if name in changes}
    return StreetsSpec((RoadSpec("main", (Piece(400.0),), facts=changes.pop("facts_of_road", {}), **changes),), **streets)


def cross(
    control: str = "signal", arms: Mapping[str, Mapping[str, Any]] | None = None, roads: Mapping[str, Any] | None = None, **streets: Any
) -> StreetsSpec:
    """Four roads of 200 m that meet at the origin in junction `x`, 10 m from the middle. `arms`: changes by the road's name."""
    places = {"west": Pose(-210, 0, 0), "east": Pose(10, 0, 0), "south": Pose(0, -210, 90), "north": Pose(0, 10, 90)}
    ends = {"west": "end", "east": "start", "south": "end", "north": "start"}
    laid = tuple(RoadSpec(name, (Piece(200.0),), pose, **(roads or {})) for name, pose in places.items())
    met = tuple(Arm(name, end, **(arms or {}).get(name, {})) for name, end in ends.items())  # type: ignore[arg-type]
    return StreetsSpec(laid, (JunctionSpec("x", met, control, PHASES if control == "signal" else ()),), **streets)  # type: ignore[arg-type]


@dataclass
class Street:
    """A map with one vehicle on it: where it is, what it sees, where it goes; `now` gives the stretches of its path."""

    spec: StreetsSpec
    lanes: tuple[str, ...]
    """Of the path, in order."""
    interpretation: str = "planner"
    eye: dict[str, Value] = field(default_factory=lambda: dict(quiet_eye()))
    settings: SceneSettings = field(default_factory=SceneSettings)

    def __post_init__(self) -> None:
        self.road_map = build_road_map(self.spec, law().vocabulary)
        self.scenes = Scenes(self.road_map, law(), CAR, self.settings, self.interpretation)
        self.path: LanePath = path_along(self.road_map, self.lanes)
        self.history: History = self.scenes.history()
        self.time = 0.0
        self.observation: Observation | None = None

    def see(
        self, front: float, speed: float = 10.0, tracks: Sequence[Track] = (), lights: Mapping[str, Sequence[Indication]] | None = None,
        signal: TurnSignal = "off", clock: datetime.datetime = NOON, offset: float = 0.0, wait: float = 0.1, silent: frozenset[str] = frozenset(),
    ) -> Observation:  # fmt: skip
        """Observe with the front bumper at a station of the path, `wait` seconds after the last time, and remember it."""
        station = front - CAR.front
        x, y = self.path.path.to_plane(station, offset)[0]
        ego = EgoState(float(x), float(y), float(self.path.path.heading(station)), speed, turn_signal=signal)
        self.time += wait
        shown = {name: tuple(items) for name, items in (lights or {}).items()}
        self.observation = Observation(self.time, clock, ego, tuple(tracks), shown, dict(self.eye), silent, "scripted")
        self.history.update(self.observation, self.path, next_junction(self.road_map, self.path, front - CAR.length))
        return self.observation

    def drive(self, start: float, end: float, speed: float, step: float = 1.0, **seen: Any) -> None:
        """Observe every `step` metres on the way from one station of the front bumper to another."""
        at = start
        while at < end:
            self.see(at, speed, wait=step / speed, **seen)
            at += step
        self.see(end, speed, wait=step / speed, **seen)

    def maneuver(self, current: str = GO, following: str = GO, **changes: Any) -> Maneuver:
        """A manoeuvre along the path from where the vehicle was seen last."""
        assert self.observation is not None
        ego = self.observation.ego
        station = float(self.path.path.project([(ego.x, ego.y)], extend=True)[0][0])
        junction = next_junction(self.road_map, self.path, station - CAR.rear_overhang)
        made = Maneuver(current, following, self.path.lane_at(station).lane, self.path, Goal(), ego.turn_signal, junction=junction)
        return replace(made, **changes)

    def stretches(self, current: str = GO, following: str = GO, **changes: Any) -> tuple[Stretch, ...]:
        """The stretches of such a manoeuvre."""
        assert self.observation is not None
        return self.scenes.stretches(self.observation, self.maneuver(current, following, **changes), self.history)

    def first(self, current: str = GO, following: str = GO, **changes: Any) -> Stretch:
        """The first of them."""
        return self.stretches(current, following, **changes)[0]

    def fact(self, name: str, **changes: Any) -> Value | None:
        """What the first stretch says of a fact, roles before the scene."""
        return told(self.first(**changes), name)


def told(stretch: Stretch, name: str) -> Value | None:
    """What a stretch says of a fact: its roles, else its scene, None unknown."""
    value = stretch.roles.get(name)
    return stretch.scene.facts.get(name) if value is None else value


def judge(stretch: Stretch, current: str, following: str, **plan: Value) -> Verdict:
    """The verdict on a plan with these facts of its own (`speed=10.0` for plan.speed)."""
    facts = {f"plan.{name}": value for name, value in plan.items()}
    return stretch.view.judge(stretch.prepared, Plan(current, following, {**stretch.roles, **facts}))


def worst(stretches: Sequence[Stretch], current: str, following: str, **plan: Value) -> str:
    """The worst verdict over all stretches."""
    order = ("legal", "unknown", "illegal")
    return max((judge(item, current, following, **plan).verdict for item in stretches), key=order.index)


def car(name: str, x: float, y: float, heading: float = 0.0, speed: float = 10.0, kind: Any = "car", **more: Any) -> Track:
    """A road user by the middle of its box; sizes by kind."""
    length, width = {"bicycle": (1.8, 0.6), "pedestrian": (0.5, 0.5), "truck": (10.0, 2.5)}.get(kind, (4.6, 1.8))
    return Track(name, kind, x, y, heading, speed, more.pop("length", length), more.pop("width", width), **more)
