"""What stands beside and above the road: traffic lights with their lamps, signs on posts."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from regdb_runtime.maps.road_map import Light
from regdb_runtime.observation import Indication, Shape
from regdb_runtime.perception.render.canvas import Canvas
from regdb_runtime.perception.render.draw_sign import sign_picture
from regdb_runtime.perception.render.sign_faces import Colour, face_of
from regdb_runtime.planning.trajectory import Floats

POST: Colour = (112, 114, 116)
HOUSING: Colour = (34, 34, 36)
LENSES: dict[str, tuple[Colour, Colour]] = {
    "red": ((255, 42, 34), (74, 20, 20)), "yellow": ((255, 196, 30), (76, 62, 18)), "green": ((36, 232, 140), (16, 62, 44))
}  # fmt: skip
"""Colour -> lit and dark lens."""
LENS = 0.15
"""Radius of a 12-inch lens, metres."""
HEAD_FROM_GROUND = 5.2
"""Height of a head's lowest lens over the roadway, metres (15 ft to 25.6 ft, MUTCD 4D.15)."""
SIGN_FROM_GROUND = 2.1
"""From the ground to a sign's lower edge, metres (7 ft where people walk, MUTCD 2A.18)."""
_ARROWS: dict[Shape, float] = {"left_arrow": 180.0, "right_arrow": 0.0, "straight_arrow": 90.0, "u_arrow": 270.0}


def facing(place: tuple[float, float], heading: float) -> tuple[Floats, Floats]:
    """Middle on the ground (3,) and the unit vector to the right as seen by traffic of a heading, (3,)."""
    return np.array([*place, 0.0]), np.array([math.sin(heading), -math.cos(heading), 0.0])


def draw_light(canvas: Canvas, light: Light, heading: float, shown: Sequence[Indication]) -> None:
    """A head that faces traffic of `heading`: three lenses, of arrows where what it shows is arrows; dark where nothing is known."""
    if light.position is None:
        return
    base, right = facing(light.position, heading)
    shape: Shape = next((item.shape for item in shown if item.shape != "circular"), "circular")
    if light.arrow and shape == "circular":
        shape = {"right": "right_arrow", "left": "left_arrow", "straight": "straight_arrow"}.get(light.direction, "circular")  # type: ignore[assignment]
    canvas.stroke(np.array([base, base + np.array([0, 0, HEAD_FROM_GROUND])]), 0.16, POST)
    low, high = HEAD_FROM_GROUND - 0.22, HEAD_FROM_GROUND + 0.94
    corners = [base + right * b * 0.24 + np.array([0, 0, z]) for b, z in ((-1, high), (1, high), (1, low), (-1, low))]
    canvas.polygon(np.array(corners), HOUSING, (70, 70, 72))
    lit = {item.color for item in shown}
    for index, colour in enumerate(("green", "yellow", "red")):
        middle = base + np.array([0, 0, HEAD_FROM_GROUND + index * 0.36])
        bright, dark = LENSES[colour]
        if colour in lit:
            canvas.glow(middle, 0.55, bright)
        _lens(canvas, middle, right, shape, bright if colour in lit else dark)


def _lens(canvas: Canvas, middle: Floats, right: Floats, shape: Shape, colour: Colour) -> None:
    if shape == "circular":
        canvas.disc(middle, LENS, colour)
        return
    turn = math.radians(_ARROWS[shape])
    ahead = right * math.cos(turn) + np.array([0, 0, math.sin(turn)])
    aside = np.cross(ahead, np.cross(right, np.array([0, 0, 1.0])))
    points = ((0.13, 0.0), (0.0, 0.12), (0.0, 0.045), (-0.13, 0.045), (-0.13, -0.045), (0.0, -0.045), (0.0, -0.12))
    canvas.polygon(np.array([middle + ahead * a + aside * b for a, b in points]), colour)


def draw_sign(canvas: Canvas, code: str, number: str, place: tuple[float, float], heading: float, height: float = SIGN_FROM_GROUND) -> None:
    """A sign on its post that faces traffic of `heading`; codes that cannot be drawn are left out."""
    face, picture = face_of(code), sign_picture(code, number)
    if face is None or picture is None:
        return
    base, right = facing(place, heading)
    if float((canvas.camera.place - base) @ np.array([math.cos(heading), math.sin(heading), 0.0])) > 0:
        return
    owner, canvas.owner = canvas.owner, -1  # the post is no part of the sign
    canvas.stroke(np.array([base, base + np.array([0, 0, height + 0.3])]), 0.07, POST)
    canvas.owner = owner
    wide, low, high = face.width / 2, height, height + face.height
    corners = [base + right * b * wide + np.array([0, 0, z]) for b, z in ((-1, high), (1, high), (1, low), (-1, low))]
    canvas.face(np.array(corners), picture)
