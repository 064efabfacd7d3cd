"""The planner in OpenCDA (CARLA): an agent with the methods of `opencda.core.plan.behavior_agent.BehaviorAgent`, nothing of CARLA imported.

`VehicleManager` calls `agent.update_information(ego_pos, ego_speed, objects)` and then `agent.run_step(target_speed)`, and hands what comes
back to `ControlManager.run_step(target_speed, target_pos)`. Set `vehicle_manager.agent = RegulationAgent(...)` and nothing else changes.

CARLA's world is left-handed: y points to the right and yaw runs clockwise in degrees; here y points to the left and headings run
anticlockwise in radians. OpenCDA's speeds are km/h.
"""

from __future__ import annotations

import datetime
import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any, NamedTuple, Protocol

from regdb.vocabulary import Value
from regdb_runtime.decision import Decision
from regdb_runtime.errors import NoRoute
from regdb_runtime.maps.lane_graph import LaneGraph
from regdb_runtime.maps.road_map import RoadMap
from regdb_runtime.maps.route import find_route
from regdb_runtime.observation import Color, EgoState, Footprint, Indication, Observation, Provenance, Track, TrackKind

KMH = 3.6
"""km/h in one m/s."""
COLORS: Mapping[str, Color] = {"Red": "red", "Yellow": "yellow", "Green": "green", "Off": "dark"}
"""CARLA's `TrafficLightState`, by the name it prints."""


class PlannerLike(Protocol):
    """What an adapter needs of the planner."""

    def step(self, observation: Observation) -> Decision: ...


class Location(NamedTuple):
    """A place in CARLA's frame, metres; stands in for `carla.Location`, which can be given instead (`location=carla.Location`)."""

    x: float
    y: float
    z: float


@dataclass(frozen=True, slots=True)
class AgentSettings:
    """`lookahead_time` s and `lookahead_least` m: how far along the plan the target place lies; `light_range` m: how far a detected light may be
    from the one on the map; `kinds`: words in an actor's `type_id` that tell what it is, tried in order."""

    lookahead_time: float = 0.6
    lookahead_least: float = 2.5
    light_range: float = 15.0
    kinds: tuple[tuple[str, TrackKind], ...] = (
        ("walker", "pedestrian"), ("bike", "bicycle"), ("crossbike", "bicycle"), ("omafiets", "bicycle"), ("century", "bicycle"),
        ("harley", "motorcycle"), ("kawasaki", "motorcycle"), ("yamaha", "motorcycle"), ("vespa", "motorcycle"), ("truck", "truck"),
        ("firetruck", "truck"), ("fusorosa", "bus"), ("bus", "bus"),
    )  # fmt: skip


class RegulationAgent:
    """An OpenCDA behaviour agent that plans under the law.

    `planner_for`: makes the planner of a route, such as `lambda route: Planner(database, road_map, route)`. `vehicle`: the `carla.Vehicle`
    (asked for its world's time alone). `start`: local date and time at simulation time 0. `eye`: what perception's model reports, as a
    function of time and ego -> (facts, silent), such as an `Eye.look` of `regdb_runtime.worlds.eye`.
    """

    def __init__(
        self, planner_for: Callable[[tuple[str, ...]], PlannerLike], road_map: RoadMap, vehicle: Any, start: datetime.datetime,
        eye: Callable[[float, EgoState], tuple[Mapping[str, Value], frozenset[str]]], provenance: Provenance,
        footprint: Footprint | None = None, location: Callable[[float, float, float], Any] = Location, settings: AgentSettings | None = None,
    ) -> None:  # fmt: skip
        self.planner_for, self.road_map, self.vehicle, self.start = planner_for, road_map, vehicle, start
        self.planner: PlannerLike | None = None
        self.footprint = footprint or Footprint()
        self.settings = settings or AgentSettings()
        self.decision: Decision | None = None
        self._eye, self._provenance, self._location = eye, provenance, location
        self._graph = LaneGraph(road_map)
        self._observation: Observation | None = None
        self._height = 0.0

    def update_information(self, ego_pos: Any, ego_speed: float, objects: Mapping[str, Iterable[Any]]) -> None:
        """OpenCDA's hook: `ego_pos` a `carla.Transform`, `ego_speed` km/h, `objects` with `vehicles` and `traffic_lights`."""
        time = float(self.vehicle.get_world().get_snapshot().timestamp.elapsed_seconds)
        ego = self._ego(ego_pos, ego_speed / KMH)
        facts, silent = self._eye(time, ego)
        self._height = float(ego_pos.location.z)
        vehicles = tuple(self._track(item) for item in objects.get("vehicles", ()))
        lights = self._signals(objects.get("traffic_lights", ()))
        clock = self.start + datetime.timedelta(seconds=time)
        self._observation = Observation(time, clock, ego, vehicles, lights, facts, silent, self._provenance)

    def set_destination(
        self, start_location: Any, end_location: Any, clean: bool = False, end_reset: bool = True, clean_history: bool = False  # noqa: ARG002
    ) -> None:
        """OpenCDA's hook: the route between two places (the last three are OpenCDA's own and say nothing here). Raises NoRoute."""
        start, end = (self._graph.nearest(place.x, -place.y) for place in (start_location, end_location))
        if start is None or end is None:
            raise NoRoute("the map has no lane to start from or to drive to")
        route = find_route(self.road_map, start[0], end[0])
        self.planner = self.planner_for(route.lanes)

    def run_step(
        self, target_speed: float | None = None, collision_detector_enabled: bool = True, lane_change_allowed: bool = True  # noqa: ARG002
    ) -> tuple[float, Any]:
        """OpenCDA's hook: the speed to reach (km/h; `target_speed` is an upper bound) and the place to steer to. Raises RuntimeError before
        `set_destination` and `update_information`."""
        if self._observation is None or self.planner is None:
            raise RuntimeError("run_step before set_destination and update_information: there is nothing to plan from")
        self.decision = self.planner.step(self._observation)
        plan, settings = self.decision.trajectory, self.settings
        index = int(plan.time.searchsorted(settings.lookahead_time).clip(1, len(plan.time) - 1))
        ahead = (plan.station >= plan.station[0] + settings.lookahead_least).nonzero()[0]
        place = max(index, int(ahead[0])) if len(ahead) else len(plan.time) - 1
        speed = float(plan.speed[index]) * KMH
        if target_speed is not None:
            speed = min(speed, target_speed)
        heading = float(plan.heading[place])
        reach = self.footprint.center
        x, y = float(plan.x[place]) + reach * math.cos(heading), float(plan.y[place]) + reach * math.sin(heading)
        return speed, self._location(x, -y, self._height)

    def _ego(self, transform: Any, speed: float) -> EgoState:
        """The rear axle from the actor's middle; acceleration and curvature as last planned, which OpenCDA does not report."""
        heading = -math.radians(transform.rotation.yaw)
        x = transform.location.x - self.footprint.center * math.cos(heading)
        y = -transform.location.y - self.footprint.center * math.sin(heading)
        ego = EgoState(x, y, heading, speed)
        if self.decision is None:
            return ego
        plan = self.decision.trajectory
        return replace(ego, acceleration=float(plan.acceleration[1]), curvature=float(plan.curvature[1]), turn_signal=self.decision.turn_signal)

    def _track(self, actor: Any) -> Track:
        transform, velocity, extent = actor.get_transform(), actor.get_velocity(), actor.bounding_box.extent
        name = str(getattr(actor, "type_id", "") or "")
        kind: TrackKind = next((kind for word, kind in self.settings.kinds if word in name), "car")
        return Track(
            str(getattr(actor, "carla_id", getattr(actor, "id", ""))), kind, transform.location.x, -transform.location.y,
            -math.radians(transform.rotation.yaw), math.hypot(velocity.x, velocity.y), 2 * extent.x, 2 * extent.y,
        )  # fmt: skip

    def _signals(self, lights: Iterable[Any]) -> dict[str, tuple[Indication, ...]]:
        """Detected lights laid on those of the map: the nearest within range; a light no map knows is left out."""
        found: dict[str, tuple[Indication, ...]] = {}
        for item in lights:
            place = item.get_location()
            near = [
                (math.hypot(light.position[0] - place.x, light.position[1] + place.y), light.id)
                for light in self.road_map.lights.values()
                if light.position is not None
            ]
            distance, name = min(near, default=(math.inf, ""))
            if distance <= self.settings.light_range:
                found[name] = (Indication(COLORS.get(str(item.get_state()), "unknown")),)
        return found
