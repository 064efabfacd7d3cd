"""What a drive's log shows when it is measured: clearances, speeds against limits, the stop, the sections that decided; SI."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

from regdb_runtime.drive.events import Event, events_of, limit_at
from regdb_runtime.drive.log import Log

Record = Mapping[str, Any]
Passes = Literal["", "same_lane", "next_lane"]


@dataclass(frozen=True)
class Measures:
    """A drive in numbers. None: there was nothing to measure.

    `clearance`: least distance edge to edge to the road user passed, while overtaking. `nearest`: to anybody, over the drive. `excess`: most by
    which the speed was over the limit in force, negative when it never was. `stop_gap`: from the front bumper to the line when it stood.
    `waited`: seconds from stopping to going on. `zone_speed`: most within a zone. `crosses`: what the light showed as the line was crossed.
    """

    events: tuple[Event, ...]
    ended: str
    reason: str
    time: float
    distance: float
    top_speed: float
    excess: float | None
    clearance: float | None
    nearest: float | None
    stop_gap: float | None
    waited: float | None
    zone_speed: float | None
    least_acceleration: float
    passes: Passes
    crosses: str
    sections: tuple[str, ...]
    states: tuple[str, ...]


def measure(log: Log) -> Measures:
    """All measures of a drive."""
    ticks, marks = log.ticks, log.run["marks"]
    events = events_of(log.run, ticks)
    line = marks["stop_lines"][0] if marks["stop_lines"] else None
    return Measures(
        events=events, ended=log.end["ended"], reason=log.end["reason"], time=log.end["time"],
        distance=ticks[-1]["ego"]["front"] - ticks[0]["ego"]["front"],
        top_speed=max(tick["ego"]["speed"] for tick in ticks), excess=_most(_excess(ticks)), clearance=_least(_passing(ticks)),
        nearest=_least(track["clearance"] for tick in ticks for track in tick["tracks"]), stop_gap=_stop_gap(events, line), waited=_waited(events),
        zone_speed=_most(_zone_speeds(ticks, marks["zones"])), least_acceleration=min(tick["ego"]["acceleration"] for tick in ticks),
        passes=_passes(log, events), crosses="" if line is None else _crosses(ticks, line), sections=sections(ticks), states=trace(ticks),
    )  # fmt: skip


def _least(values: Iterable[float]) -> float | None:
    return min(values, default=None)


def _most(values: Iterable[float]) -> float | None:
    return max(values, default=None)


def _excess(ticks: Sequence[Record]) -> Iterable[float]:
    """Speed less the limit in force, tick by tick: the limit that the verdict on what is driven states."""
    for tick in ticks:
        limit = limit_at(tick)
        if limit is not None:
            yield tick["ego"]["speed"] - limit


def _passing(ticks: Sequence[Record]) -> Iterable[float]:
    """Clearances to bicycles while the state is one of overtaking."""
    return (
        track["clearance"] for tick in ticks if tick["state"].startswith("overtaking.") for track in tick["tracks"] if track["kind"] == "bicycle"
    )  # fmt: skip


def _stop_gap(events: Iterable[Event], line: Record | None) -> float | None:
    stop = next((event for event in events if event.name == "stopped"), None)
    return None if stop is None or line is None else line["station"] - stop.station


def _waited(events: Iterable[Event]) -> float | None:
    times = {event.name: event.time for event in events if event.name in ("stopped", "released")}
    return times["released"] - times["stopped"] if len(times) == 2 else None


def _zone_speeds(ticks: Sequence[Record], zones: Sequence[Record]) -> Iterable[float]:
    """Speeds while the front bumper is within a zone."""
    return (tick["ego"]["speed"] for tick in ticks for zone in zones if zone["start"] <= tick["ego"]["front"] <= zone["end"])


def _passes(log: Log, events: Iterable[Event]) -> Passes:
    """From which lane the cyclist was passed: whether the vehicle's side left its lane at any instant of the overtaking."""
    times = {event.name: event.time for event in events}
    if "back_in_lane" not in times:
        return ""
    half = log.run["footprint"]["width"] / 2
    for tick in log.ticks:
        if times["overtaking_begins"] <= tick["time"] <= times["back_in_lane"]:
            ego = tick["ego"]
            width = next((lane["width"] for lane in log.run["marks"]["lanes"] if lane["start"] <= ego["station"] <= lane["end"]), None)
            if width is not None and abs(ego["offset"]) + half > width / 2:
                return "next_lane"
    return "same_lane"


def _crosses(ticks: Sequence[Record], line: Record) -> str:
    """The colour of what governs the movement as the front bumper crosses the line: an arrow where one is shown, else the circular head."""
    for tick in ticks:
        if tick["ego"]["front"] > line["station"]:
            shown = [lens for light in line["lights"] for lens in tick["signals"].get(light, ())]
            arrows = [color for color, shape, _ in shown if shape == "right_arrow"]
            return str(next(iter(arrows or [color for color, _, _ in shown]), ""))
    return ""


def sections(ticks: Sequence[Record]) -> tuple[str, ...]:
    """Citations that decided, in order of first appearance: of what was not lawful, of what allowed, and of the limit in force."""
    found: dict[str, None] = {}
    for tick in ticks:
        for item in tick["candidates"]:
            for rejection in item["rejections"]:
                if " " in rejection["rule"]:
                    found.setdefault(rejection["rule"])
            if item["law"]:
                found.update(dict.fromkeys(citation for _, citation in item["law"]["deciding"]))
        if tick["law"]:
            found.update(dict.fromkeys(entry[2] for entry in tick["law"]["limits"].values()))
    return tuple(found)


def trace(ticks: Sequence[Record]) -> tuple[str, ...]:
    """The states in force, one after the other, micro-steps included, without repetition."""
    found: list[str] = []
    for tick in ticks:
        for state in (*tick["steps"], tick["state"]):
            if not found or found[-1] != state:
                found.append(state)
    return tuple(found)


def super_states(states: Iterable[str]) -> tuple[str, ...]:
    """The super-states of a trace, without repetition."""
    found: list[str] = []
    for state in states:
        name = state.partition(".")[0]
        if not found or found[-1] != name:
            found.append(name)
    return tuple(found)
