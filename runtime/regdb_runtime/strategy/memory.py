"""What the strategist remembers from tick to tick: the state in force, what it is passing, where it is changing to, the line it stops at."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from regdb_runtime.strategy.stop_line import NO_STOP, StopMemory

PassMode = Literal["in_lane", "by_lane"]


@dataclass(frozen=True, slots=True)
class Pass:
    """An overtaking under way: the track passed, on which side, within the lane or by the lane beside it, the lane to go back to."""

    track: str
    side: Literal["left", "right"]
    mode: PassMode
    home: str


@dataclass(frozen=True, slots=True)
class Memory:
    """The strategist's memory; a new one for each tick.

    `entered`: time the state was entered; `left`: the state left then. `target_lane`: of a change of lane under way.
    `followed`: the track followed at last. `stop`: the line ahead.
    """

    state: str
    entered: float = 0.0
    left: str = ""
    lane: str = ""
    target_lane: str | None = None
    followed: str | None = None
    passing: Pass | None = None
    stop: StopMemory = NO_STOP
    handling: bool = False
    returning: bool = False
