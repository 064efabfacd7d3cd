"""Words of the log for what changed from one tick to the next."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from regdb_runtime.planning.goal import SpeedCap
from regdb_runtime.strategy.memory import Memory

BRAKES = -0.1
"""m/s2 under which the plan brakes."""
LOWER = 0.5
"""m/s by which a limit ahead must lie under the present one to be a lower zone."""


@dataclass(frozen=True, slots=True)
class ZoneWatch:
    """The lower limit ahead for which braking has begun: its rule (empty for none) and its speed; one rule may bring every posted limit."""

    rule: str = ""
    speed: float = 0.0


def state_events(before: Memory, after: Memory, offset: float, settled: float) -> tuple[str, ...]:
    """`overtaking_begins`, `back_in_lane`, `stopped`, `released`."""
    found = []
    was, now = (memory.state.startswith("overtaking.") for memory in (before, after))
    if now and not was:
        found.append("overtaking_begins")
    if after.stop.phase == "held" and before.stop.phase != "held":
        found.append("stopped")
    if after.stop.phase == "released" and before.stop.phase in ("held", "check", "approach"):
        found.append("released")
    if before.returning and not after.returning and abs(offset) <= settled and not now:
        found.append("back_in_lane")
    return tuple(found)


def zone_events(watch: ZoneWatch, caps: Sequence[SpeedCap], front: float, acceleration: float) -> tuple[ZoneWatch, tuple[str, ...]]:
    """`zone_seen` when braking for a lower limit ahead begins, `zone_entered` when the front bumper is within it."""
    here = min((cap.speed for cap in caps if cap.start <= front < cap.end), default=float("inf"))
    if watch.rule:
        if any(cap.rule == watch.rule and cap.speed <= watch.speed + LOWER and cap.start <= front < cap.end for cap in caps):
            return ZoneWatch(), ("zone_entered",)
        return watch, ()
    lower = min((cap for cap in caps if cap.start > front and cap.speed < here - LOWER), key=lambda cap: cap.start, default=None)
    if lower is not None and acceleration < BRAKES:
        return ZoneWatch(lower.rule, lower.speed), ("zone_seen",)
    return watch, ()
