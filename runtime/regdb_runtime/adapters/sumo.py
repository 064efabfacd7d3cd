"""The planner in a SUMO simulation of yours: one of its vehicles is driven by us, through libsumo or TraCI, which have the same calls.

    ego = SumoEgo(libsumo, "ego", planner, road_map, start, eye)
    while running:
        ego.step()                     # observe, plan, move the vehicle along the plan
        libsumo.simulationStep()

The map is `maps.sumo_net.read_sumo(net file)`, whose lane ids are SUMO's and whose light ids are `<tls>/<index>`.
"""

from __future__ import annotations

import datetime
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from regdb.vocabulary import Value
from regdb_runtime.decision import Decision
from regdb_runtime.maps.road_map import RoadMap
from regdb_runtime.maps.sumo_links import COLORS
from regdb_runtime.observation import Color, EgoState, Footprint, Indication, Observation, Provenance, Track
from regdb_runtime.worlds.sumo.terms import KINDS, bits_of, heading_of, move, track_of

_COLORS: Mapping[str, Color] = {"green": "green", "yellow": "yellow", "red": "red", "red_yellow": "red", "inactive": "dark"}


class PlannerLike(Protocol):
    """What an adapter needs of the planner."""

    def step(self, observation: Observation) -> Decision: ...


@dataclass(frozen=True, slots=True)
class SumoEgoSettings:
    """`sensor_range`, `lights_range` metres; `rear_overhang`, `wheelbase` shares of the vehicle's length, which SUMO does not know."""

    sensor_range: float = 200.0
    lights_range: float = 120.0
    rear_overhang: float = 0.2
    wheelbase: float = 0.58


class SumoEgo:
    """Held by whoever runs the simulation; calls `simulationStep` never itself. `eye`: time and ego -> (facts, silent), as `Eye.look`.

    The vehicle must be in the simulation when `step` is first called; SUMO's own driver is switched off for it.
    """

    def __init__(
        self, simulation: Any, vehicle: str, planner: PlannerLike, road_map: RoadMap, start: datetime.datetime,
        eye: Callable[[float, EgoState], tuple[Mapping[str, Value], frozenset[str]]], provenance: Provenance,
        settings: SumoEgoSettings | None = None,
    ) -> None:  # fmt: skip
        self.simulation, self.vehicle, self.planner, self.road_map, self.start = simulation, vehicle, planner, road_map, start
        self.settings = settings or SumoEgoSettings()
        self.decision: Decision | None = None
        self._eye, self._provenance = eye, provenance
        self._ego: EgoState | None = None
        self.footprint = self.footprint_of(simulation, vehicle, self.settings)

    @staticmethod
    def footprint_of(simulation: Any, vehicle: str, settings: SumoEgoSettings | None = None) -> Footprint:
        """The vehicle's rectangle, to make the planner with."""
        given = settings or SumoEgoSettings()
        length, width = simulation.vehicle.getLength(vehicle), simulation.vehicle.getWidth(vehicle)
        return Footprint(length, width, given.wheelbase * length, given.rear_overhang * length)

    def observe(self) -> Observation:
        """What surrounds the vehicle now."""
        time = float(self.simulation.simulation.getTime())
        ego = self._ego or self._seen_ego()
        facts, silent = self._eye(time, ego)
        x, y = ego.box_center(self.footprint)
        names = [name for name in self.simulation.vehicle.getIDList() if name != self.vehicle]
        others = [self._track(name) for name in names]
        near = tuple(track for track in others if math.hypot(track.x - x, track.y - y) <= self.settings.sensor_range)
        clock = self.start + datetime.timedelta(seconds=time)
        return Observation(time, clock, ego, near, self._signals(ego), facts, silent, self._provenance)

    def step(self) -> Decision:
        """Observe, plan, and put the vehicle where the plan has it one simulation step on."""
        if self._ego is None:
            self.simulation.vehicle.setSpeedMode(self.vehicle, 0)
            self.simulation.vehicle.setLaneChangeMode(self.vehicle, 0)
        self.decision = self.planner.step(self.observe())
        plan, ahead = self.decision.trajectory, float(self.simulation.simulation.getDeltaT())
        x, y, heading, speed, acceleration, curvature = (
            float(np.interp(ahead, plan.time, row))
            for row in (plan.x, plan.y, np.unwrap(plan.heading), plan.speed, plan.acceleration, plan.curvature)
        )
        self._ego = EgoState(x, y, math.remainder(heading, math.tau), speed, acceleration, curvature, self.decision.turn_signal)
        move(self.simulation.vehicle, self.vehicle, self._ego.front_bumper(self.footprint), self._ego.heading, speed)
        self.simulation.vehicle.setSignals(self.vehicle, bits_of(self.decision.turn_signal))
        return self.decision

    def _seen_ego(self) -> EgoState:
        vehicles = self.simulation.vehicle
        (x, y), heading = vehicles.getPosition(self.vehicle), heading_of(vehicles.getAngle(self.vehicle))
        reach = self.footprint.front
        return EgoState(x - reach * math.cos(heading), y - reach * math.sin(heading), heading, vehicles.getSpeed(self.vehicle))

    def _track(self, name: str) -> Track:
        vehicles = self.simulation.vehicle
        kind = KINDS.get(vehicles.getVehicleClass(name), "car")
        return track_of(vehicles, name, kind, (vehicles.getLength(name), vehicles.getWidth(name)))

    def _signals(self, ego: EgoState) -> dict[str, tuple[Indication, ...]]:
        """Every light in range; SUMO names no lens, so what it shows counts as circular."""
        states: dict[str, str] = {}
        found: dict[str, tuple[Indication, ...]] = {}
        for light in self.road_map.lights.values():
            if light.position is None or math.dist(light.position, (ego.x, ego.y)) > self.settings.lights_range:
                continue
            signal, _, index = light.id.rpartition("/")
            if signal not in states:
                states[signal] = self.simulation.trafficlight.getRedYellowGreenState(signal)
            found[light.id] = (Indication(_COLORS[COLORS[states[signal][int(index)]]]),)
        return found
