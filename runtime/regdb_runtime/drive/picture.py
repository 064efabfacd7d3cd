"""The scene from above at an instant: streets with their markings, lights in their colours, road users, the plan, and the clearance kept."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from regdb.units import from_si
from regdb_runtime.drive.street_picture import Brush, paint_streets
from regdb_runtime.errors import MissingExtra
from regdb_runtime.geometry import boxes, distance
from regdb_runtime.maps.road_map import Floats, RoadMap
from regdb_runtime.observation import Footprint, Indication, Observation, Track
from regdb_runtime.planning.trajectory import Trajectory

if TYPE_CHECKING:
    from matplotlib.axes import Axes

GRASS, PLAN, EGO, CLEARANCE = "#e9ede4", "#27c4ff", "#1f7bf2", "#ff3d81"
USERS: Mapping[str, str] = {
    "car": "#dfe3e8", "truck": "#c3b8a5", "bus": "#c9a66b", "motorcycle": "#b8a1e3", "bicycle": "#ff9f43",
    "pedestrian": "#ff5c7a", "animal": "#a9744f", "obstacle": "#8d99a6",
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class PictureSettings:
    """Metres shown along and across, pixels of the width, the gap (m) below which a clearance line is drawn, and what the view is around:
    `center`, or a point `ahead` metres before the ego."""

    along: float = 90.0
    across: float = 56.0
    pixels: int = 1400
    clearance_within: float = 4.0
    ahead: float = 15.0
    center: tuple[float, float] | None = None


@dataclass(frozen=True)
class Instant:
    """What is drawn: an observation with the ego's footprint and plan. `tracks` and `lights` replace what was observed, to show all there is."""

    observation: Observation
    footprint: Footprint
    plan: Trajectory | None = None
    tracks: Sequence[Track] | None = None
    lights: Mapping[str, tuple[Indication, ...]] | None = None


def draw_scene(
    path: Path, road_map: RoadMap, instant: Instant, *, title: str = "", caption: str = "", settings: PictureSettings | None = None
) -> None:
    """Write a picture (PNG, SVG or PDF by the path's suffix). Raises MissingExtra without matplotlib."""
    figure_class, canvas, rc_context = _matplotlib()
    view = settings or PictureSettings()
    shape = _shape(instant.observation, view)
    width, bar = view.pixels / 100, 0.55
    figure = figure_class(figsize=(width, width * shape[1] / shape[0] + bar), dpi=100, facecolor="white")
    canvas(figure)
    top = 1.0 - bar / figure.get_figheight()
    paint_scene(figure.add_axes((0.0, 0.0, 1.0, top)), road_map, instant, settings=view)
    figure.text(0.012, (1.0 + top) / 2, title, fontsize=15, fontweight="bold", va="center", color="#1c1f23")
    figure.text(0.988, (1.0 + top) / 2, caption or _caption(instant.observation), fontsize=12, va="center", ha="right", color="#4a4f57")
    with rc_context({"svg.hashsalt": "regdb"}):
        figure.savefig(path, metadata=_without_date(path))


def paint_scene(axes: Axes, road_map: RoadMap, instant: Instant, *, scale: float = 1.0, settings: PictureSettings | None = None) -> None:
    """Paint onto axes that are there; `scale` is for lines and letters (1: the axes are about 1,400 pixels wide at 100 dpi)."""
    view, seen = settings or PictureSettings(), instant.observation
    brush = Brush(axes, scale)
    paint_streets(brush, road_map, seen.signals if instant.lights is None else instant.lights)
    for track in seen.tracks if instant.tracks is None else instant.tracks:
        _draw_track(brush, track)
    _draw_ego(brush, seen, instant.footprint, instant.plan)
    _draw_clearance(brush, seen, instant.footprint, view)
    middle = view.center or (seen.ego.x + view.ahead * math.cos(seen.ego.heading), seen.ego.y + view.ahead * math.sin(seen.ego.heading))
    shape = _shape(seen, view)
    _frame(axes, middle, shape)
    _draw_scale(brush, middle, shape)


def _shape(observation: Observation, view: PictureSettings) -> tuple[float, float]:
    """Metres from left to right and from bottom to top: longer in the direction the ego drives in."""
    if abs(math.cos(observation.ego.heading)) > 0.6:
        return view.along, view.across
    return view.across * 1.25, view.along * 0.8


def _matplotlib() -> tuple[Callable[..., Any], Callable[..., Any], Callable[..., Any]]:
    try:
        from matplotlib import rc_context
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
    except ImportError:
        raise MissingExtra("matplotlib", "plots", "a picture of a scene") from None
    return Figure, FigureCanvasAgg, rc_context


def _without_date(path: Path) -> dict[str, None]:
    """No time of writing in the file, so that the same scene gives the same bytes."""
    return {".png": {}, ".svg": {"Date": None}, ".pdf": {"CreationDate": None}}.get(path.suffix, {})


def _caption(observation: Observation) -> str:
    ego = observation.ego
    return f"{observation.clock:%H:%M:%S}   t = {observation.time:.1f} s   {ego.speed:.1f} m/s ({ego.speed / 0.44704:.0f} mph)"


def _corners(x: float, y: float, heading: float, length: float, width: float) -> Floats:
    ahead = np.array([math.cos(heading), math.sin(heading)])
    left = np.array([-ahead[1], ahead[0]])
    signs = ((1, 1), (1, -1), (-1, -1), (-1, 1))
    return np.array([(x, y) + along * ahead * length / 2 + across * left * width / 2 for along, across in signs])


def _draw_track(brush: Brush, track: Track) -> None:
    corners = _corners(track.x, track.y, track.heading, track.length, track.width)
    brush.axes.fill(*corners.T, facecolor=USERS[track.kind], edgecolor="#20242a", linewidth=brush.points(1.0), zorder=3)
    if track.kind == "pedestrian":
        brush.disc((track.x, track.y), max(track.width, 0.7) / 2, USERS["pedestrian"], 3.1, "#20242a")
        return
    _draw_windscreen(brush, track.x, track.y, track.heading, track.length, track.width, 3.05)
    if track.warning_lights != "none":
        size = brush.points(16)
        brush.axes.plot(track.x, track.y, marker="*", markersize=size, color="#ff3b30", markeredgecolor="#1f7bf2", zorder=3.2)
    if track.turn_signal in ("left", "right", "hazard"):
        _draw_blinkers(brush, corners, track.turn_signal)


def _draw_windscreen(brush: Brush, x: float, y: float, heading: float, length: float, width: float, order: float) -> None:
    if length < 3.0:
        return
    at = length * 0.18
    screen = _corners(x + at * math.cos(heading), y + at * math.sin(heading), heading, length * 0.16, width * 0.82)
    brush.axes.fill(*screen.T, color="#2b3138", linewidth=0, zorder=order)


def _draw_blinkers(brush: Brush, corners: Floats, signal: str) -> None:
    places = {"left": (0, 3), "right": (1, 2), "hazard": (0, 1, 2, 3)}.get(signal, ())
    for place in places:
        brush.disc((float(corners[place, 0]), float(corners[place, 1])), 0.2, "#ffb000", 4.2, "#7a4b00")


def _draw_ego(brush: Brush, observation: Observation, footprint: Footprint, plan: Trajectory | None) -> None:
    ego = observation.ego
    if plan is not None and len(plan.time) > 1:
        fronts = np.column_stack([plan.x + footprint.front * np.cos(plan.heading), plan.y + footprint.front * np.sin(plan.heading)])
        brush.axes.plot(*fronts.T, color=PLAN, linewidth=brush.points(4.5), alpha=0.85, solid_capstyle="round", zorder=2.5)
        whole = np.isclose(plan.time, np.round(plan.time), atol=0.02)
        brush.axes.plot(*fronts[whole].T, linestyle="none", marker="o", markersize=brush.points(5), color="white", markeredgecolor=PLAN, zorder=2.6)
    x, y = ego.box_center(footprint)
    corners = _corners(x, y, ego.heading, footprint.length, footprint.width)
    brush.axes.fill(*corners.T, facecolor=EGO, edgecolor="white", linewidth=brush.points(1.4), zorder=4)
    _draw_windscreen(brush, x, y, ego.heading, footprint.length, footprint.width, 4.05)
    _draw_blinkers(brush, corners, ego.turn_signal)


def _draw_clearance(brush: Brush, observation: Observation, footprint: Footprint, view: PictureSettings) -> None:
    """The shortest line between the ego and the nearest cyclist or pedestrian, with its length."""
    ego = observation.ego
    x, y = ego.box_center(footprint)
    own = boxes(x, y, ego.heading, footprint.length, footprint.width)
    weak = [track for track in observation.tracks if track.kind in ("bicycle", "pedestrian")]
    gaps = [float(distance(own, boxes(item.x, item.y, item.heading, item.length, item.width))) for item in weak]
    if not gaps or min(gaps) > view.clearance_within or min(gaps) == 0.0:
        return
    other = weak[gaps.index(min(gaps))]
    mine = _corners(x, y, ego.heading, footprint.length, footprint.width)
    a, b = _nearest_points(mine, _corners(other.x, other.y, other.heading, other.length, other.width))
    brush.axes.plot((a[0], b[0]), (a[1], b[1]), color=CLEARANCE, linewidth=brush.points(2.2), zorder=4.5, marker="|", markersize=brush.points(9))
    middle = (a + b) / 2
    text = f"{min(gaps):.2f} m ({float(from_si(min(gaps), 'ft')):.1f} ft)"
    box = {"boxstyle": "round,pad=0.25", "facecolor": "white", "edgecolor": CLEARANCE, "alpha": 0.95}
    brush.axes.annotate(
        text, (float(middle[0]), float(middle[1])), xytext=(brush.points(46), 0), textcoords="offset points",
        fontsize=brush.points(12), fontweight="bold", color=CLEARANCE, ha="left", va="center", bbox=box,
        arrowprops={"arrowstyle": "-", "color": CLEARANCE, "linewidth": brush.points(1.2)}, zorder=7, annotation_clip=True,
    )  # fmt: skip


def _nearest_points(first: Floats, second: Floats) -> tuple[Floats, Floats]:
    """The nearest pair of points of two rectangles that are apart: one of them is a corner."""
    best: tuple[float, Floats, Floats] | None = None
    for corners, edges, swapped in ((first, second, False), (second, first, True)):
        for corner in corners:
            for begin, end in zip(edges, np.roll(edges, -1, axis=0), strict=True):
                along = float(np.clip(np.dot(corner - begin, end - begin) / np.dot(end - begin, end - begin), 0.0, 1.0))
                foot = begin + along * (end - begin)
                gap = float(np.hypot(*(corner - foot)))
                if best is None or gap < best[0] - 1e-12:
                    best = (gap, foot, corner) if swapped else (gap, corner, foot)
    assert best is not None
    return best[1], best[2]


def _frame(axes: Axes, middle: tuple[float, float], shape: tuple[float, float]) -> None:
    axes.set_facecolor(GRASS)
    axes.set_xlim(middle[0] - shape[0] / 2, middle[0] + shape[0] / 2)
    axes.set_ylim(middle[1] - shape[1] / 2, middle[1] + shape[1] / 2)
    axes.set_aspect("equal")
    axes.set_xticks([])
    axes.set_yticks([])
    for spine in axes.spines.values():
        spine.set_visible(False)


def _draw_scale(brush: Brush, middle: tuple[float, float], shape: tuple[float, float]) -> None:
    x, y = middle[0] - shape[0] / 2 + 2.5, middle[1] - shape[1] / 2 + 2.2
    brush.axes.plot((x, x + 10.0), (y, y), color="#1c1f23", linewidth=brush.points(3), solid_capstyle="butt", zorder=8)
    brush.axes.text(x + 5.0, y + 0.6, "10 m", fontsize=brush.points(11), ha="center", color="#1c1f23", zorder=8)
