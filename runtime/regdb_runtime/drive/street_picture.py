"""The streets of a picture from above: asphalt, kerbs, markings in their styles, crosswalks, limit lines, zones, lights in their colours."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from regdb_runtime.maps.road_map import Floats, Lane, Marking, RoadMap
from regdb_runtime.observation import Indication

if TYPE_CHECKING:
    from matplotlib.axes import Axes

ASPHALT, PAINT, YELLOW, KERB = "#5b6068", "#f5f5f2", "#f2b632", "#b9bcc0"
BICYCLE_LANE = "#4f7a5c"
ZONES: Mapping[str, str] = {"school": "#f6c945", "work": "#f28e2b", "jurisdiction": "#9b7fd4"}
LIGHTS: Mapping[str, str] = {"red": "#ff3b30", "yellow": "#ffcc00", "green": "#34d058", "dark": "#30343a", "unknown": "#9aa0a6"}
_ARROWS: Mapping[str, str] = {"left_arrow": "\N{LEFTWARDS ARROW}", "right_arrow": "\N{RIGHTWARDS ARROW}", "straight_arrow": "\N{UPWARDS ARROW}"}


@dataclass(frozen=True)
class Brush:
    """What is painted on, and how thick lines and letters are: 1 for a picture 1,400 pixels wide."""

    axes: Axes
    scale: float = 1.0

    def points(self, size: float) -> float:
        """A width or letter size in points."""
        return size * self.scale

    def disc(self, at: tuple[float, float], radius: float, color: str, height: float, edge: str = "none") -> None:
        """A filled circle, metres."""
        turns = np.linspace(0.0, 2 * math.pi, 33)
        x, y = at[0] + radius * np.cos(turns), at[1] + radius * np.sin(turns)
        self.axes.fill(x, y, facecolor=color, edgecolor=edge, linewidth=self.points(0.8), zorder=height)

    def box(self, corner: tuple[float, float], width: float, height: float, color: str, order: float) -> None:
        """A filled rectangle from its lower left corner, metres."""
        (x, y), right, top = corner, corner[0] + width, corner[1] + height
        self.axes.fill((x, right, right, x), (y, y, top, top), color=color, linewidth=0, zorder=order)


def paint_streets(brush: Brush, road_map: RoadMap, lights: Mapping[str, tuple[Indication, ...]]) -> None:
    for zone in road_map.zones:
        color = ZONES.get(zone.kind, "#8fb8de")
        brush.axes.fill(*zone.polygon.T, color=color, alpha=0.16, zorder=0.5, linewidth=0)
        border = np.vstack([zone.polygon, zone.polygon[:1]])
        brush.axes.plot(*border.T, color=color, linewidth=brush.points(1.6), linestyle=(0, (6, 4)), alpha=0.9, zorder=0.6)
        x, y = zone.polygon.max(axis=0)
        brush.axes.text(x - 1.0, y + 0.6, zone.kind, fontsize=brush.points(11), ha="right", va="bottom", color="#7a6a1f", clip_on=True, zorder=6)
    inner = [lane for lane in road_map.lanes.values() if lane.junction is not None]
    for junction in dict.fromkeys(lane.junction for lane in inner):
        _draw_junction(brush, [lane for lane in inner if lane.junction == junction])
    for lane in road_map.lanes.values():
        color = BICYCLE_LANE if "bicycle_lane" in lane.kinds else ASPHALT
        brush.axes.fill(*_outline(lane).T, color=color, linewidth=brush.points(0.6), zorder=1.0 if lane.junction is None else 0.9)
    for crosswalk in road_map.crosswalks:
        _draw_crosswalk(brush, crosswalk.polygon)
    for lane in road_map.lanes.values():
        if lane.junction is None:
            _draw_markings(brush, lane)
    for name, shown in lights.items():
        _draw_light(brush, road_map, name, shown)


def _outline(lane: Lane) -> Floats:
    return np.vstack([lane.left_line, lane.right_line[::-1]])


def _draw_junction(brush: Brush, lanes: Sequence[Lane]) -> None:
    """The paved area between the arms: its lanes' ends in a ring, joined by kerbs that round the corners."""
    ends: list[tuple[Floats, Floats]] = []
    for lane in lanes:
        for line in (lane.left_line, lane.right_line):
            ends.append((line[0], lane.center[1] - lane.center[0]))
            ends.append((line[-1], lane.center[-2] - lane.center[-1]))
    middle = np.mean([point for point, _ in ends], axis=0)
    ends.sort(key=lambda end: math.atan2(end[0][1] - middle[1], end[0][0] - middle[0]))
    ring = np.vstack([_corner(*first, *second) for first, second in zip(ends, [*ends[1:], ends[0]], strict=True)])
    brush.axes.fill(*ring.T, color=ASPHALT, linewidth=brush.points(0.8), zorder=0.8)
    for first, second in zip(ends, [*ends[1:], ends[0]], strict=True):
        corner = _corner(*first, *second)
        if len(corner) > 1:
            brush.axes.plot(*np.vstack([corner, second[0]]).T, color=KERB, linewidth=brush.points(3.0), zorder=1.2)


def _corner(start: Floats, ahead: Floats, end: Floats, back: Floats) -> Floats:
    """From one end towards the next: round the corner where the two roads' edges meet, else straight (the start alone)."""
    cross = float(ahead[0] * back[1] - ahead[1] * back[0])
    if abs(cross) < 0.2 * float(np.hypot(*ahead) * np.hypot(*back)):
        return start[None, :]
    reach = end - start
    along, across = float(reach[0] * back[1] - reach[1] * back[0]) / cross, float(reach[0] * ahead[1] - reach[1] * ahead[0]) / cross
    if along <= 0.0 or across <= 0.0:
        return start[None, :]
    turn = start + along * ahead
    t = np.linspace(0.0, 1.0, 13)[:-1, None]
    return np.asarray((1 - t) ** 2 * start + 2 * t * (1 - t) * turn + t**2 * end)


def _draw_crosswalk(brush: Brush, polygon: Floats) -> None:
    """Bars along the direction of travel across the whole width."""
    a, b, c, d = polygon
    beyond = (b - a) / np.hypot(*(b - a)) * 1.1
    brush.axes.fill(*np.array([a, b + beyond, c + beyond, d]).T, color=ASPHALT, linewidth=0, zorder=1.35)
    count = max(2, round(float(np.hypot(*(d - a))) / 1.2))
    for index in range(count):
        first, second = (index + 0.2) / count, (index + 0.72) / count
        corners = np.array([a + (d - a) * first, b + (c - b) * first, b + (c - b) * second, a + (d - a) * second])
        brush.axes.fill(*corners.T, color=PAINT, alpha=0.92, linewidth=0, zorder=1.4)


def _draw_markings(brush: Brush, lane: Lane) -> None:
    opposite = lane.left is not None and not lane.left_same_direction
    _draw_marking(brush, lane.left_line, lane.left_marking, YELLOW if opposite or lane.left is None else PAINT, inward=-1.0)
    if lane.right is None or "bicycle_lane" in lane.kinds:
        _draw_marking(brush, lane.right_line, lane.right_marking, PAINT, inward=1.0)
    elif lane.right_marking == "solid":
        _draw_marking(brush, lane.right_line, "solid", PAINT, inward=0.0)
    if lane.stop_line is not None and lane.stop_line.marked:
        (ax, ay), (bx, by) = lane.stop_line.start, lane.stop_line.end
        brush.axes.plot((ax, bx), (ay, by), color=PAINT, linewidth=brush.points(4.5), solid_capstyle="butt", zorder=1.5)


def _draw_marking(brush: Brush, line: Floats, marking: Marking, color: str, inward: float) -> None:
    """One boundary; of a double line the lane draws its own, nearer half, its neighbour the other."""
    if marking in ("none", "unknown"):
        return
    if marking == "curb":
        brush.axes.plot(*line.T, color=KERB, linewidth=brush.points(3.0), zorder=1.2)
        return
    double = marking in ("double_solid", "solid_dashed", "dashed_solid", "double_dashed")
    dashed = marking in ("dashed", "dashed_solid", "double_dashed")
    shift = 0.13 * inward if double else 0.0
    steps = np.gradient(line, axis=0)
    normal = np.column_stack([-steps[:, 1], steps[:, 0]]) / np.hypot(*steps.T)[:, None]
    moved = line + shift * normal
    if dashed:
        _draw_dashes(brush, moved, color)
    else:
        brush.axes.plot(*moved.T, color=color, linewidth=brush.points(1.6), zorder=1.3)


def _draw_dashes(brush: Brush, line: Floats, color: str, dash: float = 3.0, gap: float = 9.0) -> None:
    """Dashes of 10 ft and gaps of 30 ft, as on the road (CA MUTCD 3A.06), so that both directions' dashes coincide."""
    stations = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))))
    start = (stations[-1] % (dash + gap)) / 2
    while start + dash <= stations[-1]:
        at = np.linspace(start, start + dash, 4)
        x, y = (np.interp(at, stations, line[:, axis]) for axis in (0, 1))
        brush.axes.plot(x, y, color=color, linewidth=brush.points(1.6), solid_capstyle="butt", zorder=1.3)
        start += dash + gap


def _draw_light(brush: Brush, road_map: RoadMap, name: str, shown: Sequence[Indication]) -> None:
    light = road_map.lights.get(name)
    if light is None or light.position is None:
        return
    x, y = light.position
    for place, indication in enumerate(shown):
        at = (x + 1.5 * place, y)
        brush.box((at[0] - 0.75, at[1] - 0.75), 1.5, 1.5, "#22262b", 5.0)
        brush.disc(at, 0.55, LIGHTS[indication.color], 5.1)
        if indication.shape in _ARROWS:
            arrow, size = _ARROWS[indication.shape], brush.points(12)
            brush.axes.text(*at, arrow, fontsize=size, fontweight="bold", ha="center", va="center", zorder=5.2, clip_on=True)
