"""Stops at lines: the phases of each (approach, held, check, released), remembered, so that the vehicle neither stops again nor creeps."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from regdb_runtime.decision import StopPhase
from regdb_runtime.maneuver import Junction
from regdb_runtime.observation import Indication
from regdb_runtime.planning.goal import StopPoint
from regdb_runtime.strategy.settings import StrategySettings


@dataclass(frozen=True, slots=True)
class StopMemory:
    """What is remembered of one line: its phase, and since when."""

    line: str = ""
    phase: StopPhase = ""
    since: float = 0.0


NO_STOP = StopMemory()


def line_of(junction: Junction) -> str:
    """The line's name, the same on every path that leads over it."""
    return f"{junction.id}:{junction.turn}"


def observe(memory: StopMemory, junction: Junction, front: float, speed: float, time: float, settings: StrategySettings) -> StopMemory:
    """The memory after another look at place and speed; chosen states come in through `chosen`.

    `held`: stands with the front bumper within the slack before the line. `check`: has stood so for the check time, in which signs and traffic were
    looked at. A vehicle pushed on or moved away from the line is approaching again.
    """
    line = line_of(junction)
    if memory.line != line:
        memory = StopMemory(line, "", time)
    if front > junction.stop_station:
        return memory
    near = junction.stop_station - front <= settings.stop_slack
    if memory.phase == "approach" and near and speed < settings.standstill:
        return StopMemory(line, "held", time)
    if memory.phase == "held" and time - memory.since >= settings.check_time - 1e-9:
        return replace(memory, phase="check")
    return memory


def chosen(memory: StopMemory, junction: Junction | None, stops: bool, enters: bool, time: float) -> StopMemory:
    """The memory after a choice: a stop begins an approach, entering releases, and a stop chosen after a release is a new one."""
    if junction is None:
        return NO_STOP
    if stops and memory.phase in ("", "released"):
        return StopMemory(line_of(junction), "approach", time)
    if enters and memory.phase != "released":
        return StopMemory(line_of(junction), "released", time)
    return memory


def stop_point(memory: StopMemory, junction: Junction, front: float, settings: StrategySettings) -> StopPoint:
    """Where to stand: at the line, or, once the vehicle stands at it, there (and the last millimetres it rolls)."""
    rule = f"stop:{line_of(junction)}"
    if memory.phase in ("held", "check"):
        return StopPoint(min(junction.stop_station, front + settings.stop_roll), rule, settings.stop_slack, 0.0)
    return StopPoint(junction.stop_station, rule, settings.stop_slack, settings.stop_margin)


def decision_distance(speed: float, settings: StrategySettings) -> float:
    """Metres before the line at which stopping or going on is decided: gentle braking after a tick, and a margin."""
    return speed * settings.decision_time + speed * speed / (2 * settings.decision_braking) + settings.decision_margin


def waiting_distance(speed: float, settings: StrategySettings) -> float:
    """Metres before the line up to which what is unknown may wait."""
    return speed * settings.decision_time + speed * speed / (2 * settings.waiting_braking) + settings.decision_margin


def must_stop_on_yellow(
    junction: Junction, signals: Mapping[str, Sequence[Indication]], front: float, speed: float, settings: StrategySettings, stopping: bool = False
) -> bool:
    """Whether a yellow is shown and the line still lies beyond what prudent braking needs: to go on would gamble on the red that follows.

    A stop that has begun (`stopping`) is kept as long as hard braking still reaches the line: who brakes and then goes on enters on red.
    """
    shown = [item for light in junction.lights for item in signals.get(light, ())]
    if not any(item.color == "yellow" and not item.flashing for item in shown):
        return False
    if any(item.color == "green" for item in shown):
        return False
    return junction.stop_station - front >= speed * speed / (2 * (settings.yellow_stopping if stopping else settings.yellow_braking))
