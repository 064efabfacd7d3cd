"""The events of a drive as the paper marks them in its figures, read from the log's records; nothing here asks the planner.

| event | when | paper |
|---|---|---|
| `overtaking_begins` | the state enters the super-state overtaking | cyclist figure, first line |
| `back_in_lane` | it is in lane following again, what was passed behind | cyclist figure, second line |
| `stopped` | the vehicle stands with its front bumper at most 2 m before a stop line | right-on-red figure, first line |
| `released` | it leaves the stop | right-on-red figure, second line |
| `zone_detected` | braking for a zone ahead begins | speed figure, red line |
| `reduced_speed` | the speed is reached that is kept through the zone | speed figure, yellow line |

An overtaking that is broken off before the other is passed is `overtaking_given_up`.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

STANDS = 0.1
"""m/s under which the vehicle stands (acceptance of the right-on-red figure)."""
BEFORE_LINE = 2.0
"""Metres before a stop line within which standing is stopping at it."""
BRAKES = -0.1
"""m/s2 under which the vehicle brakes."""
REACHED = 0.05
"""m/s above a speed at which it counts as reached: what a tick at 10 Hz cannot tell apart while braking gently."""
LOWER = 0.5
"""m/s by which a zone's speed must be lower than the one before it to be a reduced speed: about one mile per hour."""

Record = Mapping[str, Any]


@dataclass(frozen=True, slots=True)
class Event:
    """One event: its word, when (seconds from the start), and the downtrack distance of the front bumper in metres."""

    name: str
    time: float
    station: float


def events_of(run: Record, ticks: Sequence[Record]) -> tuple[Event, ...]:
    """Every event in order of time. `run` holds the marks of the route (`marks`: stop lines, zones)."""
    marks = run["marks"]
    found = [*_overtakings(ticks)]
    for line in marks["stop_lines"]:
        found += _stops(ticks, line["station"])
    for zone in marks["zones"]:
        found += _zone(ticks, zone["start"], zone["end"])
    return tuple(sorted(found, key=lambda event: event.time))


def _event(name: str, tick: Record) -> Event:
    return Event(name, tick["time"], tick["ego"]["front"])


def _overtakings(ticks: Iterable[Record]) -> Iterable[Event]:
    begun: Record | None = None
    ahead: set[str] = set()
    for tick in ticks:
        inside = tick["state"].startswith("overtaking.")
        if inside and begun is None:
            begun, ahead = tick, {track["id"] for track in tick["tracks"] if _along(tick, track) > 0}
            yield _event("overtaking_begins", tick)
        elif not inside and begun is not None:
            passed = any(track["id"] in ahead and _along(tick, track) < 0 for track in tick["tracks"])
            yield _event("back_in_lane" if passed else "overtaking_given_up", tick)
            begun = None


def _along(tick: Record, track: Record) -> float:
    """How far a track's middle lies ahead of the rear axle, metres along the vehicle's heading."""
    ego = tick["ego"]
    return float((track["x"] - ego["x"]) * math.cos(ego["heading"]) + (track["y"] - ego["y"]) * math.sin(ego["heading"]))


def _stops(ticks: Iterable[Record], line: float) -> Iterable[Event]:
    standing = False
    for tick in ticks:
        at_line = line - BEFORE_LINE <= tick["ego"]["front"] <= line
        if not standing and at_line and tick["ego"]["speed"] < STANDS:
            standing = True
            yield _event("stopped", tick)
        elif standing and (not at_line or not tick["state"].endswith(".stop")) and tick["phase"] not in {"held", "check"}:
            yield _event("released", tick)
            return


def _zone(ticks: Sequence[Record], start: float, end: float) -> Iterable[Event]:
    """Braking for a zone is what leads up to the speed kept in it: found backwards from its beginning."""
    inside = [index for index, tick in enumerate(ticks) if start <= tick["ego"]["front"] <= end]
    if not inside:
        return
    kept = max(ticks[index]["ego"]["speed"] for index in inside) + REACHED
    reached = inside[0]
    while reached > 0 and ticks[reached - 1]["ego"]["speed"] <= kept:
        reached -= 1
    last = next((i for i in range(reached, -1, -1) if ticks[i]["ego"]["acceleration"] < BRAKES), None)
    if last is None or reached == 0:
        return
    first = next((i + 1 for i in range(last, -1, -1) if ticks[i]["ego"]["acceleration"] >= BRAKES), 0)
    if ticks[first]["ego"]["speed"] > kept + LOWER:
        yield _event("zone_detected", ticks[first])
        yield _event("reduced_speed", ticks[reached])


def limit_at(tick: Record) -> float | None:
    """The strictest speed limit in force that the verdict on the chosen plan states, m/s."""
    law = tick["law"]
    found = law["limits"].get("max_speed") if law else None
    return None if found is None else float(found[0])
