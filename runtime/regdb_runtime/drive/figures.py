"""The paper's three figures: downtrack distance over time with their event lines, the speed under the limit in force, and the scene beside it.

Drawn from the log alone. The cyclist figure has two lines (overtaking begins, back in lane), the right-on-red figure two (stopped, released), the
speed figure a red line (zone detected, braking begins) and a yellow dashed one (reduced speed, kept through the zone).
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from regdb.units import from_si
from regdb_runtime.drive.events import Event, events_of, limit_at
from regdb_runtime.drive.log import Log
from regdb_runtime.drive.picture import Instant, PictureSettings, paint_scene
from regdb_runtime.drive.scene_pictures import FAR
from regdb_runtime.errors import MissingExtra
from regdb_runtime.maps.road_map import RoadMap

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Record = Mapping[str, Any]
PICTURE_INCHES = 4.0
"""Width of a scene beside a figure; lines and letters are painted for 14."""
MPH = float(from_si(1.0, "mph"))
BEFORE, AFTER = 9.0, 8.0
"""Seconds shown before the first and after the last event."""
RED, YELLOW, INK, SOFT, BLUE, GREEN = "#c62828", "#f0a500", "#1a1a1a", "#8a8f98", "#1f5fa8", "#2e7d32"
_STATE_COLORS = {"lane_following": "#cfdced", "intersection_handling": "#f2d4bb", "overtaking": "#c6e3c8", "emergency_stop": "#efb4b4"}
_LABELS = {
    "overtaking_begins": "overtaking begins", "alongside": "alongside", "back_in_lane": "back in lane", "stopped": "full stop",
    "released": "turn begins", "zone_detected": "zone detected,\nbraking begins", "reduced_speed": "limit reached,\nkept in the zone",
}  # fmt: skip
_LINES = {"zone_detected": (RED, "-"), "reduced_speed": (YELLOW, "--")}


@dataclass(frozen=True)
class Sheet:
    """One figure: its file's name, its title, the events it marks, and those whose scene stands beside it."""

    name: str
    title: str
    events: tuple[str, str]
    pictures: tuple[str, ...]


@dataclass(frozen=True)
class Scenes:
    """The scenes that stand beside the figures: event -> what is drawn at it, on the map of the drive."""

    road_map: RoadMap
    instants: Mapping[str, Instant]

    def paint(self, axes: Axes, name: str, count: int) -> None:
        """The scene at an event, onto axes that are there; the more stand above each other, the flatter each is."""
        along, ahead = (100.0, 36.0) if name in FAR else (58.0, 14.0)
        view = PictureSettings(along=along, across=along * (0.6 if count < 3 else 0.36), ahead=ahead)
        paint_scene(axes, self.road_map, self.instants[name], scale=PICTURE_INCHES / 14.0, settings=view)


SHEETS = (
    Sheet("cyclist", "Overtaking a cyclist", ("overtaking_begins", "back_in_lane"), ("overtaking_begins", "alongside", "back_in_lane")),
    Sheet("right-on-red", "Right turn on red", ("stopped", "released"), ("stopped", "released")),
    Sheet("speed", "Reduced speed past a school", ("zone_detected", "reduced_speed"), ("zone_detected", "reduced_speed")),
)


def draw_all(log: Log, folder: Path, scenes: Scenes | None = None) -> tuple[Path, ...]:
    """Every figure whose events the drive has, as PNG files in a folder; with `scenes` the scene at each event stands beside it.

    Raises MissingExtra without matplotlib.
    """
    drawn = []
    found = {event.name: event for event in events_of(log.run, log.ticks)}
    for sheet in SHEETS:
        marked = [found[name] for name in sheet.events if name in found]
        if marked:
            path = folder / f"{sheet.name}.png"
            _save(draw(log, sheet, marked, scenes), path)
            drawn.append(path)
    return tuple(drawn)


def _save(figure: Figure, path: Path) -> None:
    """As PNG without a date, so that equal drives give equal files."""
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=150, metadata={"Software": None})


def draw(log: Log, sheet: Sheet, marked: Sequence[Event], scenes: Scenes | None = None) -> Figure:
    """One figure: distance above, speed and limit below, the scene at each event beside them."""
    try:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
    except ModuleNotFoundError as error:
        raise MissingExtra("matplotlib", "plots", "drawing figures") from error
    shown = () if scenes is None else tuple(name for name in sheet.pictures if name in scenes.instants)
    figure = Figure(figsize=(10.8 if shown else 6.4, 4.9), layout="constrained")
    FigureCanvasAgg(figure)
    ticks = _window(log.ticks, marked)
    columns = figure.add_gridspec(1, 2 if shown else 1, width_ratios=(1.6, 1) if shown else None)
    rows = columns[0, 0].subgridspec(3, 1, height_ratios=(1.3, 0.085, 1), hspace=0.03)
    above = figure.add_subplot(rows[0])
    strip, below = figure.add_subplot(rows[1], sharex=above), figure.add_subplot(rows[2], sharex=above)
    _distance(above, ticks, marked, log)
    _states(strip, ticks)
    _speed(below, ticks, log.run["marks"]["zones"])
    for axes in (above, below):
        _event_lines(axes, marked)
        _plain(axes)
    _labels(above, marked)
    above.set_title(f"{sheet.title}: {_place(log)}", loc="left", fontsize=10, color=INK)
    above.tick_params(labelbottom=False)
    below.set_xlabel(f"time, s   (perception: {log.run['provenance']}; world: {log.run['world']}{_lights(log)})", fontsize=8.5, color=INK)
    beside = columns[0, 1].subgridspec(len(shown), 1) if shown else None
    for row, name in enumerate(shown):
        assert beside is not None
        assert scenes is not None
        axes = figure.add_subplot(beside[row])
        scenes.paint(axes, name, len(shown))
        said = _LABELS[name].replace("\n", " ")
        axes.set_title(f"{said}, {scenes.instants[name].observation.time:.1f} s", fontsize=8.5, loc="left", color=INK)
    return figure


def _lights(log: Log) -> str:
    """Where the lights' phases came from, for drives that say so."""
    return f"; lights: {log.run['lights']}" if "lights" in log.run else ""


def _place(log: Log) -> str:
    law = next((tick["law"] for tick in log.ticks if tick["law"]), None)
    return f"{log.run['variant']}" if law is None else f"{law['place'].replace('_', ' ').title()}, {law['date']}"


def _window(ticks: Sequence[Record], marked: Sequence[Event]) -> list[Record]:
    """The ticks around the events."""
    first, last = min(event.time for event in marked) - BEFORE, max(event.time for event in marked) + AFTER
    return [tick for tick in ticks if first <= tick["time"] <= last]


def _tick_at(ticks: Sequence[Record], time: float) -> Record:
    return min(ticks, key=lambda tick: abs(tick["time"] - time))


def _distance(axes: Axes, ticks: Sequence[Record], marked: Sequence[Event], log: Log) -> None:
    """Downtrack distance of the front bumper, states behind it, what is passed, stop lines and zones as levels."""
    times, fronts = [tick["time"] for tick in ticks], [tick["ego"]["front"] for tick in ticks]
    low, high = min(fronts), max(fronts)
    _levels(axes, log.run["marks"], times, low, high)
    if any(event.name == "overtaking_begins" for event in marked):
        _bicycles(axes, ticks)
    axes.plot(times, fronts, color=INK, linewidth=1.9, label="vehicle (front bumper)", zorder=4)
    axes.set_ylabel("downtrack distance, m", fontsize=8.5, color=INK)
    room = 0.06 * (high - low)
    axes.set_ylim(low - room, high + 2.6 * room)
    axes.set_xlim(times[0], times[-1])
    axes.legend(loc="best", fontsize=7.5, frameon=False)


def _states(axes: Axes, ticks: Sequence[Record]) -> None:
    """A strip of the super-states in force, each named where it has room."""
    whole, start = ticks[-1]["time"] - ticks[0]["time"], 0
    for index in range(1, len(ticks) + 1):
        name = ticks[start]["state"].partition(".")[0]
        if index == len(ticks) or ticks[index]["state"].partition(".")[0] != name:
            left, right = ticks[start]["time"], ticks[min(index, len(ticks) - 1)]["time"]
            axes.axvspan(left, right, color=_STATE_COLORS.get(name, "#eeeeee"), linewidth=0)
            if right - left > 0.14 * whole:
                said = name.replace("_", " ")
                axes.text((left + right) / 2, 0.5, said, ha="center", va="center", fontsize=7.5, color=INK, transform=axes.get_xaxis_transform())
            start = index
    axes.set_axis_off()


def _levels(axes: Axes, marks: Record, times: Sequence[float], low: float, high: float) -> None:
    """Stop lines as a level, zones as a band of the distances they cover."""
    for line in marks["stop_lines"]:
        if low <= line["station"] <= high:
            axes.axhline(line["station"], color=RED, linewidth=0.8, alpha=0.7, zorder=2)
            axes.annotate("stop line", (times[0], line["station"]), (4, 2), textcoords="offset points", fontsize=7, color=RED)
    for zone in marks["zones"]:
        start, end = max(zone["start"], low), min(zone["end"], high)
        if start < end:
            axes.axhspan(start, end, facecolor="none", edgecolor=YELLOW, hatch="///", alpha=0.35, linewidth=0, zorder=1)
            axes.annotate(f"{zone['kind']} zone", (times[0], start), (4, 3), textcoords="offset points", fontsize=7, color="#8a6100")


def _bicycles(axes: Axes, ticks: Sequence[Record]) -> None:
    """The cyclist's own distance, and the least clearance while it is passed."""
    lines: dict[str, tuple[list[float], list[float]]] = {}
    nearest: tuple[float, float, float] | None = None
    for tick in ticks:
        ego = tick["ego"]
        for track in tick["tracks"]:
            if track["kind"] == "bicycle":
                along = (track["x"] - ego["x"]) * math.cos(ego["heading"]) + (track["y"] - ego["y"]) * math.sin(ego["heading"])
                held = lines.setdefault(track["id"], ([], []))
                held[0].append(tick["time"])
                held[1].append(ego["station"] + along)
                if tick["state"].startswith("overtaking.") and (nearest is None or track["clearance"] < nearest[0]):
                    nearest = track["clearance"], tick["time"], ego["station"] + along
    for name, (times, stations) in lines.items():
        axes.plot(times, stations, color=GREEN, linewidth=1.3, linestyle=(0, (4, 2)), label=name.replace("_", " "), zorder=3)
    if nearest is not None:
        axes.annotate(
            f"least clearance\n{nearest[0]:.2f} m = {nearest[0] / 0.3048:.1f} ft", nearest[1:], (14, -30), textcoords="offset points", fontsize=7.5,
            color=GREEN, arrowprops={"arrowstyle": "-", "color": GREEN, "linewidth": 0.8},
        )  # fmt: skip


def _speed(axes: Axes, ticks: Sequence[Record], zones: Sequence[Record]) -> None:
    """Speed, and the limit in force as a stair with the section it stands in."""
    times, speeds = [tick["time"] for tick in ticks], [tick["ego"]["speed"] * MPH for tick in ticks]
    limits = [limit_at(tick) for tick in ticks]
    stair = [float("nan") if item is None else item * MPH for item in limits]
    axes.step(times, stair, where="post", color=RED, linewidth=1.2, label="limit in force")
    axes.plot(times, speeds, color=BLUE, linewidth=1.7, label="speed", zorder=4)
    _cite(axes, ticks, limits)
    for zone in zones:
        inside = [tick["time"] for tick in ticks if zone["start"] <= tick["ego"]["front"] <= zone["end"]]
        if inside:
            axes.axvspan(inside[0], inside[-1], facecolor="none", edgecolor=YELLOW, hatch="///", alpha=0.35, linewidth=0, zorder=1)
    top = max([*speeds, *(item * MPH for item in limits if item is not None)])
    axes.set_ylim(-1.0, top * 1.22 + 1)
    axes.set_ylabel("speed, mph", fontsize=8.5, color=INK)
    axes.legend(loc="best", fontsize=7.5, frameon=False)


def _cite(axes: Axes, ticks: Sequence[Record], limits: Sequence[float | None]) -> None:
    """The section of each limit, written where its stair begins."""
    last, written = None, ticks[0]["time"] - 99.0
    for tick, limit in zip(ticks, limits, strict=True):
        if limit is not None and limit != last and tick["time"] - written > 2.0:
            _, shown, citation = tick["law"]["limits"]["max_speed"]
            axes.annotate(f"{shown}, {citation}", (tick["time"], limit * MPH), (3, 4), textcoords="offset points", fontsize=7, color=RED)
            written = tick["time"]
        last = limit


def _event_lines(axes: Axes, marked: Sequence[Event]) -> None:
    for event in marked:
        color, style = _LINES.get(event.name, (RED, "--"))
        axes.axvline(event.time, color=color, linestyle=style, linewidth=1.4, zorder=3)


def _labels(axes: Axes, marked: Sequence[Event]) -> None:
    """Each event's words beside its line, at the top, on the side with room."""
    left, right = axes.get_xlim()
    for event in marked:
        color, _ = _LINES.get(event.name, (RED, "--"))
        place = (event.time - left) / (right - left)
        near_right = place > 0.76 or (event is marked[0] and place > 0.24)
        axes.annotate(
            f"{_LABELS[event.name]}\n{event.time:.1f} s", (event.time, 0.985), (-4 if near_right else 4, 0), xycoords=axes.get_xaxis_transform(),
            textcoords="offset points", fontsize=7.5, ha="right" if near_right else "left", va="top", color="#8a6100" if color == YELLOW else color,
        )  # fmt: skip


def _plain(axes: Axes) -> None:
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    axes.grid(color="#e6e8ec", linewidth=0.7)
    axes.set_axisbelow(True)
    axes.tick_params(labelsize=8, colors=INK)
