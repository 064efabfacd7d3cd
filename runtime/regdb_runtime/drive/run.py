"""The closed loop of planner and world: observe, decide, move on, until the destination is reached or the drive ends for a stated reason."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator, Mapping
from dataclasses import asdict, dataclass
from typing import Any, Protocol

from regdb_runtime.decision import Decision
from regdb_runtime.drive.downtrack import Downtrack, Span
from regdb_runtime.drive.log import SCHEMA, Log, plain
from regdb_runtime.drive.records import Recorder
from regdb_runtime.maps.road_map import RoadMap
from regdb_runtime.observation import Observation
from regdb_runtime.worlds.world import World

Record = dict[str, Any]


@dataclass(frozen=True, slots=True)
class DriveSettings:
    """When the loop turns and when it ends; seconds, metres, m/s.

    `period`: the motion planner's 10 Hz (the paper asks for 5 Hz or more; the planner itself chooses states at 2 Hz). `standstill_limit`: 60 s, after
    which a drive that has no reason to stand is taken to be stuck; a full signal cycle is longer, so a stop at a red light has a limit of its own.
    """

    period: float = 0.1
    time_limit: float = 240.0
    standstill: float = 0.1
    standstill_limit: float = 60.0
    arrived_within: float = 40.0


class Steps(Protocol):
    """Whatever decides: a `Planner`."""

    def step(self, observation: Observation) -> Decision:
        """The decision on one observation."""
        ...


def run_record(world: World, about: Mapping[str, Any], settings: DriveSettings) -> Record:
    """The log's first record: `about` (variant, scene, law, planner's settings), the loop's settings, and the marks of the route."""
    downtrack = Downtrack(world.road_map, world.route)
    return {
        "kind": "run", "schema": SCHEMA, **about, "settings": asdict(settings), "footprint": asdict(world.footprint), "route": list(world.route),
        "length": downtrack.length, "marks": marks_of(world.road_map, downtrack, world.route),
    }  # fmt: skip


def marks_of(road_map: RoadMap, downtrack: Downtrack, route: tuple[str, ...]) -> Record:
    """Stations that figures and measurements need: stop lines with their lights, junctions, zones, and each lane's width and posted limit (m/s)."""
    spans = downtrack.lane_spans()
    zones = [
        {"id": zone.id, "kind": zone.kind, "start": span.start, "end": span.end} for zone in road_map.zones for span in downtrack.within(zone)
    ]
    return {
        "stop_lines": [line for before, after in itertools.pairwise(route) for line in _stop_line(road_map, downtrack, before, after)],
        "junctions": [_span(spans[name]) for name in route if road_map.lanes[name].junction is not None],
        "zones": sorted(zones, key=lambda item: (item["start"], item["id"])),
        "lanes": [
            {"start": spans[name].start, "end": spans[name].end, "width": float(lane.widths.min()), "posted": lane.speed_limit}
            for name in route for lane in (road_map.lanes[name],)
        ],
    }  # fmt: skip


def _stop_line(road_map: RoadMap, downtrack: Downtrack, before: str, after: str) -> list[Record]:
    """The stop line at the end of a lane, with the lights that speak to the lane that follows on the route."""
    station = downtrack.stop_line(before)
    lights = road_map.lanes[after].lights or road_map.lanes[before].lights
    return [] if station is None else [{"station": station, "lights": list(lights)}]


def _span(span: Span) -> list[float]:
    return [span.start, span.end]


def drive(
    world: World, planner: Steps, about: Mapping[str, Any], settings: DriveSettings | None = None, told: Callable[[float], None] | None = None
) -> Log:
    """One drive from the world's first instant to its end. `told` hears the time after each tick. The log is complete but not yet written."""
    settings = settings or DriveSettings()
    run = run_record(world, about, settings)
    ticks: list[Record] = []
    end: Record = {}
    for record, ended in _ticks(world, planner, settings, run["length"]):
        ticks.append(plain(record))
        if ended is not None:
            end = {"kind": "end", "time": record["time"], **ended}
        if told is not None:
            told(record["time"])
    return Log(plain(run), tuple(ticks), plain(end))


def _ticks(world: World, planner: Steps, settings: DriveSettings, length: float) -> Iterator[tuple[Record, Record | None]]:
    """Every tick's record, with the end of the drive beside the last one's."""
    recorder = Recorder(Downtrack(world.road_map, world.route), world.footprint)
    stood_since: float | None = None
    while True:
        observation = world.observe()
        decision = planner.step(observation)
        record = recorder.tick(observation, decision)
        stood_since = _standing(observation, stood_since, settings)
        ended = _ending(observation, decision, record, stood_since, settings, length)
        yield record, ended
        if ended is not None:
            return
        world.step(decision.trajectory, decision.turn_signal, settings.period)


def _standing(observation: Observation, since: float | None, settings: DriveSettings) -> float | None:
    """Since when the vehicle has been standing, None while it moves."""
    if observation.ego.speed >= settings.standstill:
        return None
    return observation.time if since is None else since


def _ending(
    observation: Observation, decision: Decision, record: Record, stood_since: float | None, settings: DriveSettings, length: float
) -> Record | None:
    """Why the drive ends now, None while it goes on: a collision, the destination, the time, or a standstill with its reason."""
    hit = touched(record)
    if hit is not None:
        return {"ended": "collision", "reason": f"touches {hit}"}
    if record["ego"]["front"] >= length - settings.arrived_within:
        return {"ended": "destination", "reason": ""}
    if observation.time >= settings.time_limit - 1e-9:
        return {"ended": "time", "reason": standing_reason(record) if stood_since is not None else "still on its way"}
    if stood_since is not None and observation.time - stood_since > settings.standstill_limit and not decision.emergency.active:
        return {"ended": "standstill", "reason": standing_reason(record)}
    return None


def touched(record: Record) -> str | None:
    """The id of a road user that the vehicle touches, None when there is none."""
    return next((str(track["id"]) for track in record["tracks"] if track["clearance"] <= 0.0), None)


def standing_reason(record: Record) -> str:
    """Why the vehicle stands: the planner's own reason, with the sections for which going on is not lawful."""
    unlawful = [item["law"] for item in record["candidates"] if item["law"] and item["rank"] in ("unlawful", "unknown")]
    cited = dict.fromkeys(citation for law in unlawful for _, citation in law["deciding"])
    missing = dict.fromkeys(fact for law in unlawful for fact in law["missing"])
    parts = [record["reason"], f"not lawful: {', '.join(cited)}" if cited else "", f"not known: {', '.join(missing)}" if missing else ""]
    return "; ".join(part for part in parts if part) or "no reason given"
