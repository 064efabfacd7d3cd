"""What one tick of the planner decides, and everything one needs to see why."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from regdb_runtime.emergency import EmergencyReport
from regdb_runtime.observation import TurnSignal
from regdb_runtime.planning.cost import CostTerms as CostTerms
from regdb_runtime.trajectory import Trajectory
from regdb_runtime.verdict import Verdict

StopPhase = Literal["", "approach", "held", "check", "released"]
Flag = Literal["", "unknown", "least_violation", "no_trajectory", "emergency"]


@dataclass(frozen=True, slots=True)
class Rejection:
    """Why a plan or a candidate state fell out: what bound it (a rule's citation, or `limit:curvature`, `collision`, `route`, `gap` …), the value
    measured and the bound in SI with their unit; `count` plans of the candidate fell out for it."""

    rule: str
    measured: float | None = None
    bound: float | None = None
    unit: str = ""
    count: int = 1
    because: str = ""


@dataclass(frozen=True)
class CandidateReport:
    """One candidate state: its best plan, the law's verdict on it, its cost, and why its other plans (or all of them) fell out.

    `verdict` is that of the worst stretch the plan crosses; `rank` 0 lawful, 1 unknown, 2 unlawful, 3 without a plan.
    """

    current: str
    next: str
    rank: int
    cost: CostTerms | None
    verdict: Verdict | None
    trajectory: Trajectory | None
    turn_signal: TurnSignal = "off"
    stations: int = 0
    sampled: int = 0
    rejections: tuple[Rejection, ...] = ()


@dataclass(frozen=True)
class Decision:
    """The planner's answer to one observation.

    `state` is the one now in force; `steps` the micro-steps that led there in this tick. `chosen` indexes `candidates` (None in an
    emergency). `margin`: the runner-up's weighted cost less the chosen one's, None without a runner-up of the same rank. `events` are words of
    the log (`stopped`, `released`, `overtaking_begins` …). `strategic` says whether this tick chose among states or only moved on in one.
    """

    time: float
    state: str
    steps: tuple[str, ...]
    trajectory: Trajectory
    turn_signal: TurnSignal
    stop_phase: StopPhase
    strategic: bool
    candidates: tuple[CandidateReport, ...]
    chosen: int | None
    margin: float | None
    flag: Flag
    emergency: EmergencyReport
    events: tuple[str, ...] = ()
    reason: str = ""
