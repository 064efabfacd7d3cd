"""Logs of drives made by hand, for what reads logs: a straight road along x, a vehicle that does what its plan of (time, speed) says."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from regdb_runtime.drive.log import SCHEMA, Log
from regdb_runtime.observation import Footprint

MPH = 0.44704
Record = dict[str, Any]


def made_tick(time: float, x: float, speed: float, *, state: str = "lane_following.go_straight", **changes: Any) -> Record:
    """A tick with the rear axle at (x, 0); `limit` (m/s), `offset`, `acceleration`, `phase`, `tracks`, `signals` as given."""
    limit = changes.get("limit", 35 * MPH)
    law = {"verdict": "legal", "place": "los_angeles", "date": "2026-03-02", "deciding": [], "facts": {}, "missing": [],
           "limits": {"max_speed": [limit, f"{limit / MPH:.0f} mph", changes.get("citation", "CVC 22349(b)")]}}  # fmt: skip
    offset = changes.get("offset", 0.0)
    return {
        "kind": "tick", "time": round(time, 3), "clock": "2026-03-02T07:40:00.000", "state": state, "steps": changes.get("steps", []),
        "phase": changes.get("phase", ""), "strategic": True, "flag": "", "reason": changes.get("reason", ""),
        "ego": {"x": x, "y": offset, "heading": 0.0, "speed": speed, "acceleration": changes.get("acceleration", 0.0), "curvature": 0.0,
                "turn_signal": "off", "station": x, "front": x + Footprint().front, "offset": offset},
        "law": law, "chosen": 0, "margin": None, "candidates": changes.get("candidates", []), "plan": None,
        "emergency": {"active": False, "gap": None, "required": 3.0, "track": None}, "tracks": changes.get("tracks", []),
        "signals": changes.get("signals", {}), "facts": {}, "silent": [], "events": [],
    }  # fmt: skip


def made_track(x: float, y: float, clearance: float, name: str = "cyclist", kind: str = "bicycle") -> Record:
    return {"id": name, "kind": kind, "x": x, "y": y, "heading": 0.0, "speed": 4.5, "length": 1.8, "width": 0.6, "clearance": clearance}


def made_log(
    ticks: Sequence[Record], *, stop_lines: Sequence[float] = (), zones: Sequence[tuple[float, float]] = (), ended: str = "destination"
) -> Log:
    """A log of ticks on a lane 3.5 m wide and 1,000 m long."""
    run = {
        "kind": "run", "schema": SCHEMA, "variant": "made", "provenance": "scripted", "world": "none", "length": 1000.0,
        "footprint": {"length": 4.8, "width": 1.8, "wheelbase": 2.8, "rear_overhang": 0.95},
        "marks": {"stop_lines": [{"station": item, "lights": ["e"]} for item in stop_lines], "junctions": [],
                  "zones": [{"id": "school", "kind": "school", "start": start, "end": end} for start, end in zones],
                  "lanes": [{"start": 0.0, "end": 1000.0, "width": 3.5, "posted": 35 * MPH}]},
    }  # fmt: skip
    return Log(run, tuple(ticks), {"kind": "end", "time": ticks[-1]["time"], "ended": ended, "reason": ""})


def driven(
    seconds: float, acceleration: Callable[[float, float, float], float], tick: Callable[[float, float, float, float], Record],
    speed: float = 35 * MPH, period: float = 0.1,
) -> list[Record]:  # fmt: skip
    """Ticks of a vehicle under `acceleration(time, x, speed)`; `tick(time, x, speed, acceleration)` makes each record."""
    x, found = 0.0, []
    for count in range(round(seconds / period) + 1):
        time = count * period
        change = acceleration(time, x, speed)
        found.append(tick(time, x, speed, change))
        following = max(0.0, speed + change * period)
        x += (speed + following) / 2 * period
        speed = following
    return found
