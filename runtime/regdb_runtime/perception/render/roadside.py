"""Houses and trees beside the roads of a map, so that a frame looks like a street; always the same for the same map, never on a road."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from regdb_runtime.maps.lines import at_stations, headings, offset, stations
from regdb_runtime.maps.road_map import RoadMap
from regdb_runtime.perception.render.canvas import Canvas
from regdb_runtime.perception.render.sign_faces import Colour
from regdb_runtime.planning.trajectory import Floats

EVERY = 17.0
"""Metres between places beside a road."""
SETBACK = 10.5
"""Metres from a road's edge to the middle of a house; trees stand nearer."""
CLEAR = 11.0
"""Metres that a house's middle keeps from the middle of every lane."""
WALLS: tuple[Colour, ...] = ((198, 178, 150), (176, 140, 120), (206, 204, 196), (150, 160, 168), (190, 164, 128))
ROOF: Colour = (112, 82, 72)
PANE: Colour = (76, 92, 108)
LEAVES: tuple[Colour, ...] = ((62, 98, 56), (78, 112, 60), (54, 88, 62))
TRUNK: Colour = (86, 70, 54)


@dataclass(frozen=True, slots=True)
class Roadside:
    """One house or tree: where, how it is turned, and a number from which its look follows."""

    x: float
    y: float
    heading: float
    number: int
    tree: bool


def roadside(road_map: RoadMap) -> tuple[Roadside, ...]:
    """Everything beside the roads of a map."""
    centers = np.concatenate([lane.center for lane in road_map.lanes.values()]) if road_map.lanes else np.zeros((0, 2))
    found = []
    for lane in road_map.lanes.values():
        if lane.right is None and lane.junction is None:
            along = np.arange(EVERY / 2, stations(lane.right_line)[-1], EVERY)
            for k, place in enumerate(along.tolist()):
                number = sum(map(ord, lane.id)) + 7 * k
                tree = number % 5 in {1, 3}
                back = 4.2 if tree else SETBACK
                near = at_stations(lane.right_line, np.array([place, place + 0.5]))
                (x, y), _ = offset(near, -back)
                if np.hypot(*(centers - (x, y)).T).min() > (5.5 if tree else CLEAR):
                    found.append(Roadside(float(x), float(y), headings(near)[0], number, tree))
    return tuple(found)


def draw_roadside(canvas: Canvas, item: Roadside) -> None:
    """One house or tree."""
    (_tree if item.tree else _house)(canvas, item)


def _tree(canvas: Canvas, item: Roadside) -> None:
    base, tall = np.array([item.x, item.y, 0.0]), 3.4 + item.number % 4 * 0.7
    leaf = LEAVES[item.number % len(LEAVES)]
    canvas.stroke(np.array([base, base + np.array([0, 0, tall])]), 0.28, TRUNK)
    for dx, dz, size in ((-0.7, 0.2, 1.1), (0.7, 0.1, 1.0), (0.0, 0.9, 1.3)):
        canvas.disc(base + np.array([dx * math.sin(item.heading), -dx * math.cos(item.heading), tall + dz]), size, leaf)


def _house(canvas: Canvas, item: Roadside) -> None:
    """Walls that face the camera, with windows, and a roof."""
    cos, sin = math.cos(item.heading), math.sin(item.heading)
    along, aside = np.array([cos, sin, 0.0]) * (5.0 + item.number % 3), np.array([-sin, cos, 0.0]) * 4.0
    tall = 3.2 + item.number % 2 * 2.8
    middle, up = np.array([item.x, item.y, 0.0]), np.array([0.0, 0.0, tall])
    wall = WALLS[item.number % len(WALLS)]
    sides = [(along, aside), (-along, -aside), (aside, -along), (-aside, along)]
    for normal, wide in sorted(sides, key=lambda side: -float(np.hypot(*(middle + side[0] - canvas.camera.place)[:2]))):
        face = middle + normal
        if float((canvas.camera.place - face) @ normal) <= 0:
            continue
        shade = 1.0 if normal is aside or normal is sides[3][0] else 0.86
        canvas.polygon(np.array([face - wide, face + wide, face + wide + up, face - wide + up]), _shaded(wall, shade))
        for storey in range(round(tall / 3.0)):
            for share in (-0.55, 0.0, 0.55):
                _window(canvas, face + wide * share, wide, 1.0 + 2.8 * storey)
    eaves, ridge = 1.12, up + np.array([0, 0, 1.7])
    for b in (1, -1) if float((canvas.camera.place - middle) @ aside) < 0 else (-1, 1):
        low = [middle + (along * a + aside * b) * eaves + up for a in (1, -1)]
        high = [middle + along * a * eaves + ridge for a in (-1, 1)]
        canvas.polygon(np.array([*low, *high]), _shaded(ROOF, 1.0 if b > 0 else 0.85))


def _window(canvas: Canvas, middle: Floats, wide: Floats, low: float) -> None:
    half = wide / np.hypot(*wide[:2]) * 0.6
    bottom, top = np.array([0, 0, low]), np.array([0, 0, low + 1.2])
    canvas.polygon(np.array([middle - half + bottom, middle + half + bottom, middle + half + top, middle - half + top]), PANE)


def _shaded(colour: Colour, share: float) -> Colour:
    red, green, blue = (min(255, round(part * share)) for part in colour)
    return red, green, blue
