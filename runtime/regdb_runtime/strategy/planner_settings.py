"""Everything that can be set about the planner, in one object; each part's numbers are explained where they stand."""

from __future__ import annotations

from dataclasses import dataclass, field

from regdb_runtime.emergency import EmergencySettings
from regdb_runtime.planning.cost_settings import DEFAULT, CostSettings
from regdb_runtime.planning.settings import LatticeSettings, VehicleLimits
from regdb_runtime.strategy.continuation import TrackingSettings
from regdb_runtime.strategy.settings import StrategySettings


@dataclass(frozen=True)
class PlannerSettings:
    """Everything that can be set.

    `interpretation`: the profile that decides facts for which the law has no number. Default `planner`: `rss`, and the care of its own plans;
    `conservative` leaves passing undecided above 30 mph, and `statute_only` decides nothing.

    `strategic_period`: seconds between choices among states (2 Hz, as in the paper). Motion is planned at every call of `step`, 10 Hz or as the
    caller likes.

    `limits` are what the vehicle can do, `comfortable` what is kept where law and safety leave it; `beyond_comfort` is what C_comfort grows by
    else. `margin`: metres kept to everybody's predicted body, for what tracking and sensing leave.
    """

    interpretation: str = "planner"
    strategic_period: float = 0.5
    margin: float = 0.1
    strategy: StrategySettings = field(default_factory=StrategySettings)
    lattice: LatticeSettings = field(default_factory=LatticeSettings)
    limits: VehicleLimits = field(default_factory=VehicleLimits)
    comfortable: VehicleLimits = field(default_factory=VehicleLimits.comfortable)
    beyond_comfort: float = 10.0
    cost: CostSettings = DEFAULT
    tracking: TrackingSettings = field(default_factory=TrackingSettings)
    emergency: EmergencySettings = field(default_factory=EmergencySettings)
