"""Plans of a manoeuvre with their limits and costs, before law is asked; manoeuvres of a tick that ask the same of the same path share them."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from regdb_runtime.maneuver import Maneuver
from regdb_runtime.maps.reference_path import ReferencePath
from regdb_runtime.observation import EgoState, Footprint, Observation
from regdb_runtime.planning.contacts import Sweeper
from regdb_runtime.planning.cost import Integers, MotionCosts, motion_cost
from regdb_runtime.planning.cost_settings import CostSettings
from regdb_runtime.planning.goal import Goal
from regdb_runtime.planning.kinematic_limits import Feasibility, Motion, check, keeps
from regdb_runtime.planning.lattice import Workspace, sample
from regdb_runtime.planning.prediction import Predictions
from regdb_runtime.planning.settings import LatticeSettings, VehicleLimits
from regdb_runtime.planning.users_along_path import UsersAlongPath, users_along
from regdb_runtime.scenes.history import History
from regdb_runtime.trajectory import Candidates, FrenetState


@dataclass(frozen=True, eq=False)
class Sampled:
    """Plans, which of them the vehicle can drive, what their motion costs, and their order by it."""

    candidates: Candidates
    feasible: Feasibility
    costs: MotionCosts
    order: Integers  # rows (N,) of the candidates, cheapest first


@dataclass(frozen=True, eq=False)
class Moment:
    """What all candidates of a tick share: what is seen, what was, where the next plan begins, where others will be, the speed wanted (m/s).

    The rest remembers what was worked out for one candidate and serves the next.
    """

    observation: Observation
    history: History
    start: EgoState
    predictions: Predictions
    sweeper: Sweeper
    wanted_speed: float
    states: dict[ReferencePath, FrenetState] = field(default_factory=dict, repr=False)
    users: dict[ReferencePath, UsersAlongPath] = field(default_factory=dict, repr=False)
    sampled: dict[tuple[ReferencePath, Goal], Sampled] = field(default_factory=dict, repr=False)


@dataclass(frozen=True, eq=False)
class Sampler:
    """The sampler with its numbers; `beyond_comfort` is added to C_comfort of plans outside the `comfortable` limits.

    Plans live in memory kept from tick to tick: those of a moment are valid until plans of the next moment are asked for.
    """

    footprint: Footprint
    lattice: LatticeSettings
    limits: VehicleLimits
    comfortable: VehicleLimits
    beyond_comfort: float
    cost: CostSettings
    rooms: list[Workspace] = field(default_factory=list, repr=False)

    def plans(self, maneuver: Maneuver, moment: Moment) -> Sampled:
        """Plans towards the manoeuvre's goal along its path."""
        path, goal = maneuver.lane_path.path, maneuver.goal
        found = moment.sampled.get((path, goal))
        if found is None:
            found = moment.sampled[path, goal] = self._plans(path, goal, moment)
        return found

    def _plans(self, path: ReferencePath, goal: Goal, moment: Moment) -> Sampled:
        start = moment.states.get(path)
        if start is None:
            start = moment.states[path] = path.frenet_state(moment.start)
        candidates = sample(path, start, goal, self.footprint, self.lattice, self._room(len(moment.sampled)))
        motion = Motion(candidates)
        feasible = check(candidates, self.limits, goal, self.footprint, motion)
        costs = motion_cost(candidates, self.cost, moment.wanted_speed, self._users(path, moment))
        costs = self._with_comfort(costs, candidates, goal, motion)
        return Sampled(candidates, feasible, costs, costs.order())

    def _room(self, number: int) -> Workspace:
        """The memory of the plans sampled as such a one of their moment."""
        if number == len(self.rooms):
            self.rooms.append(Workspace())
        return self.rooms[number]

    def _users(self, path: ReferencePath, moment: Moment) -> UsersAlongPath | None:
        if not self.cost.asks_for_others:
            return None
        found = moment.users.get(path)
        if found is None:
            place = moment.start.x, moment.start.y
            found = moment.users[path] = users_along(path, moment.predictions, place, self.footprint, self.cost)
        return found

    def _with_comfort(self, costs: MotionCosts, candidates: Candidates, goal: Goal, motion: Motion) -> MotionCosts:
        """Plans beyond what is comfortable, now or by leaving too little for what comes after the horizon, cost what nothing else makes up for:
        a plan that puts braking off looks cheap until its horizon ends."""
        beyond = (~keeps(candidates, self.comfortable, goal, self.footprint, motion)).astype(np.float64)
        return replace(costs, comfort=costs.comfort + self.beyond_comfort * beyond, parts={**costs.parts, "beyond_comfort": beyond})
