"""Road users as a person would recognise them: bodies with windows and lamps, riders and walkers of rounded limbs."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from regdb_runtime.observation import Track
from regdb_runtime.perception.render.canvas import Canvas
from regdb_runtime.perception.render.sign_faces import Colour
from regdb_runtime.planning.trajectory import Floats

PAINTS: tuple[Colour, ...] = ((176, 30, 36), (232, 232, 234), (42, 62, 110), (30, 32, 36), (130, 136, 144), (214, 210, 200), (52, 96, 74))
"""Car colours; which one a car has follows from its id."""
GLASS: Colour = (38, 46, 58)
TYRE: Colour = (28, 28, 30)
TAIL: Colour = (196, 24, 28)
BRAKE: Colour = (255, 54, 44)
AMBER: Colour = (255, 168, 30)
SKIN: Colour = (196, 148, 118)
COATS: tuple[Colour, ...] = ((34, 70, 128), (150, 44, 54), (60, 104, 70), (198, 150, 48), (90, 70, 120))
GROWN_UP = 0.45
"""Pedestrians shorter than this along, metres, are drawn as children."""
HEIGHTS: Mapping[str, tuple[float, float]] = {
    "car": (0.85, 1.45), "truck": (1.2, 3.4), "bus": (1.0, 3.1), "obstacle": (0.9, 0.9), "animal": (0.8, 1.4)
}  # fmt: skip
"""Kind -> height of the body and of the whole, metres."""


def draw_road_user(canvas: Canvas, track: Track) -> None:
    """One road user."""
    if track.kind == "pedestrian":
        _walker(canvas, track)
    elif track.kind in {"bicycle", "motorcycle"}:
        _rider(canvas, track)
    else:
        _vehicle(canvas, track)


def _frame(track: Track) -> tuple[Floats, Floats, Floats]:
    """Middle on the ground, ahead and left as unit vectors of the world, each (3,)."""
    cos, sin = math.cos(track.heading), math.sin(track.heading)
    return np.array([track.x, track.y, 0.0]), np.array([cos, sin, 0.0]), np.array([-sin, cos, 0.0])


def _number(track: Track) -> int:
    return sum(map(ord, track.id))


def _vehicle(canvas: Canvas, track: Track) -> None:
    middle, ahead, left = _frame(track)
    body, top = HEIGHTS.get(track.kind, HEIGHTS["car"])
    paint = PAINTS[_number(track) % len(PAINTS)]
    half, side = track.length / 2, track.width / 2
    up = np.array([0.0, 0.0, 1.0])
    shadow = [middle + ahead * a * (half + 0.1) + left * b * (side + 0.1) + up * 0.01 for a, b in ((1, 1), (1, -1), (-1, -1), (-1, 1))]
    canvas.polygon(np.array(shadow), (58, 60, 62))
    for a in (0.62, -0.62):
        for b in (1, -1):
            canvas.disc(middle + ahead * a * half + left * b * (side - 0.05) + up * 0.33, 0.33, TYRE)
    if track.kind in {"truck", "bus", "obstacle"}:
        _box(canvas, middle + up * 0.3, ahead, left, half, side, top - 0.3, paint)
        _windows(canvas, middle, ahead, left, track, top)
    else:
        _box(canvas, middle + up * 0.28, ahead, left, half, side, body - 0.28, paint)
        _cabin(canvas, middle + up * body, ahead, left, track, top - body, paint)
    _lamps(canvas, track, middle, ahead, left, body)


def _box(canvas: Canvas, base: Floats, ahead: Floats, left: Floats, half: float, side: float, tall: float, paint: Colour) -> None:
    """An upright box, its farther faces first."""
    up = np.array([0.0, 0.0, tall])
    faces = []
    for normal, along, reach, wide in ((ahead, left, half, side), (-ahead, left, half, side), (left, ahead, side, half), (-left, ahead, side, half)):
        middle = base + normal * reach
        corners = np.array([middle + along * wide, middle - along * wide, middle - along * wide + up, middle + along * wide + up])
        light = 0.82 + 0.18 * float(normal @ np.array([-0.5, 0.4, 0.0]))
        faces.append((float(np.hypot(*(middle - canvas.camera.place)[:2])), corners, light))
    for _, corners, light in sorted(faces, key=lambda face: -face[0]):
        canvas.polygon(corners, _lit(paint, light))
    roof = [base + up + ahead * a * half + left * b * side for a, b in ((1, 1), (1, -1), (-1, -1), (-1, 1))]
    canvas.polygon(np.array(roof), _lit(paint, 1.12))


def _cabin(canvas: Canvas, base: Floats, ahead: Floats, left: Floats, track: Track, tall: float, paint: Colour) -> None:
    """The narrower upper part with its windows."""
    up = np.array([0.0, 0.0, tall])
    low = {a: base + ahead * track.length * a for a in (0.22, -0.42)}
    high = {a: base + up + ahead * track.length * b for a, b in ((0.22, 0.06), (-0.42, -0.3))}
    wide, narrow = track.width / 2 - 0.06, track.width / 2 - 0.22
    quads = [
        (low[a] + left * wide, low[a] - left * wide, high[a] - left * narrow, high[a] + left * narrow) for a in (0.22, -0.42)
    ]  # fmt: skip
    quads += [
        (low[0.22] + left * wide * b, low[-0.42] + left * wide * b, high[-0.42] + left * narrow * b, high[0.22] + left * narrow * b) for b in (1, -1)
    ]  # fmt: skip
    order = sorted(quads, key=lambda quad: -float(np.hypot(*(sum(quad) / 4 - canvas.camera.place)[:2])))
    for quad in order:
        corners = np.array(quad)
        canvas.polygon(corners, _lit(paint, 0.9))
        canvas.polygon(corners.mean(axis=0) + (corners - corners.mean(axis=0)) * 0.84, GLASS)
    roof = [high[a] + left * narrow * b for a, b in ((0.22, 1), (0.22, -1), (-0.42, -1), (-0.42, 1))]
    canvas.polygon(np.array(roof), _lit(paint, 1.1))


def _windows(canvas: Canvas, middle: Floats, ahead: Floats, left: Floats, track: Track, top: float) -> None:
    """The rear or front window of a bus, the doors of a truck, whichever end is turned to the camera."""
    towards = -1.0 if float((canvas.camera.place - middle) @ ahead) < 0 else 1.0
    face = middle + ahead * towards * (track.length / 2 + 0.01)
    low, high = (1.6, top - 0.4) if track.kind == "bus" or towards > 0 else (0.7, top - 0.15)
    wide = track.width / 2 - 0.15
    corners = np.array([face + left * wide * b + np.array([0, 0, z]) for b, z in ((1, low), (-1, low), (-1, high), (1, high))])
    canvas.polygon(corners, GLASS if track.kind == "bus" or towards > 0 else (168, 170, 172), (90, 92, 96))


def _lamps(canvas: Canvas, track: Track, middle: Floats, ahead: Floats, left: Floats, body: float) -> None:
    """Tail or head lamps on the end that is turned to the camera; brake lamps lit while slowing; turn signals and warning lights."""
    rear = float((canvas.camera.place - middle) @ ahead) < 0
    end = middle + ahead * (track.length / 2 + 0.02) * (-1 if rear else 1)
    braking = track.acceleration < -0.6 or track.speed < 0.05
    for b in (1, -1):
        lamp = end + left * b * (track.width / 2 - 0.2) + np.array([0, 0, min(body, 1.0) - 0.15])
        canvas.disc(lamp, 0.11, (BRAKE if braking else TAIL) if rear else (250, 248, 224))
        side = "left" if b == 1 else "right"
        if track.turn_signal in {side, "hazard"}:
            canvas.disc(lamp + np.array([0, 0, -0.16]), 0.08, AMBER)
            canvas.glow(lamp + np.array([0, 0, -0.16]), 0.5, AMBER)
    if track.warning_lights == "emergency_lights":
        for b, colour in ((1, (40, 80, 255)), (-1, (255, 30, 30))):
            beacon = middle + left * b * 0.3 + np.array([0, 0, HEIGHTS.get(track.kind, HEIGHTS["car"])[1] + 0.1])
            canvas.disc(beacon, 0.12, colour)
            canvas.glow(beacon, 0.8, colour)


def _walker(canvas: Canvas, track: Track) -> None:
    middle, ahead, left = _frame(track)
    coat = COATS[_number(track) % len(COATS)]
    step = 0.28 if track.speed > 0.1 else 0.06
    size = 0.72 if track.length < GROWN_UP else 1.0

    def at(forward: float, aside: float, tall: float) -> Floats:
        return np.array(middle + (ahead * forward + left * aside + np.array([0, 0, tall])) * size)

    for b in (1, -1):
        canvas.stroke(np.array([at(0, b * 0.1, 0.9), at(b * step / 2, b * 0.1, 0.45), at(b * step, b * 0.1, 0.05)]), 0.15 * size, (48, 50, 60))
        canvas.stroke(np.array([at(0, b * 0.24, 1.4), at(-b * step / 2, b * 0.28, 1.1), at(-b * step, b * 0.26, 0.85)]), 0.11 * size, coat)
    canvas.stroke(np.array([at(0, 0.02, 1.38), at(0, 0, 0.95)]), 0.38 * size, coat)
    canvas.disc(at(0.02, 0, 1.63), 0.13, SKIN)
    canvas.disc(at(-0.02, 0, 1.7), 0.115, (58, 42, 32))


def _rider(canvas: Canvas, track: Track) -> None:
    """A two-wheeler with its rider, from whatever side it is seen."""
    middle, ahead, left = _frame(track)
    coat = COATS[_number(track) % len(COATS)]
    wheel = 0.34
    reach = track.length / 2 - wheel

    def at(forward: float, aside: float, tall: float) -> Floats:
        return np.array(middle + ahead * forward + left * aside + np.array([0, 0, tall]))

    round_ = np.linspace(0, math.tau, 17)
    for hub in (reach, -reach):
        ring = np.array([at(hub + wheel * math.cos(a), 0.0, wheel + wheel * math.sin(a)) for a in round_])
        canvas.stroke(ring, 0.06 if track.kind == "bicycle" else 0.16, TYRE)
    canvas.stroke(np.array([at(-reach, 0, wheel), at(-0.15, 0, 0.75), at(reach * 0.7, 0, 0.8), at(reach, 0, wheel)]), 0.06, coat)
    canvas.stroke(np.array([at(reach * 0.75, 0.28, 1.0), at(reach * 0.75, -0.28, 1.0)]), 0.05, TYRE)
    for b in (1, -1):
        canvas.stroke(np.array([at(-0.2, b * 0.12, 0.92), at(0.12, b * 0.14, 0.62 + b * 0.1), at(0.0, b * 0.13, 0.3 + b * 0.12)]), 0.14, (40, 42, 52))
        canvas.stroke(np.array([at(0.1, b * 0.2, 1.42), at(reach * 0.72, b * 0.26, 1.03)]), 0.1, coat)
    canvas.stroke(np.array([at(-0.2, 0, 0.98), at(0.1, 0, 1.42)]), 0.36, coat)
    canvas.disc(at(0.2, 0, 1.66), 0.13, SKIN)
    canvas.disc(at(0.18, 0, 1.73), 0.14, (226, 226, 222))
    if float((canvas.camera.place - middle) @ ahead) < 0:
        canvas.disc(at(-track.length / 2 + 0.1, 0, 0.75), 0.06, BRAKE)


def _lit(colour: Colour, share: float) -> Colour:
    red, green, blue = (min(255, max(0, round(part * share))) for part in colour)
    return red, green, blue
