"""A sign's face as a picture with transparent corners, drawn once per code and number and kept."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any

from regdb_runtime.errors import MissingExtra
from regdb_runtime.perception.render.sign_faces import Colour, Face, face_of, with_number
from regdb_runtime.perception.render.symbols import SYMBOLS, Pen, Point

RESOLUTION = 320
"""Pixels of the longer side."""
RING: Colour = (187, 30, 40)


def pillow() -> Any:
    """The drawing library. Raises MissingExtra with the command that installs it."""
    try:
        import PIL.Image
        import PIL.ImageDraw
        import PIL.ImageFont
    except ModuleNotFoundError as error:
        raise MissingExtra("Pillow", "vlm", "drawing camera frames") from error
    return PIL


@lru_cache(maxsize=256)
def sign_picture(code: str, number: str = "") -> Any | None:
    """The face of a sign as an RGBA image; None for a code that cannot be drawn."""
    face = face_of(code)
    return None if face is None else draw_face(with_number(face, number))


def draw_face(face: Face) -> Any:
    """A face as an RGBA image, twice supersampled."""
    library = pillow()
    scale = 2 * RESOLUTION / max(face.width, face.height)
    width, height = round(face.width * scale), round(face.height * scale)
    image = library.Image.new("RGBA", (width, height), (0, 0, 0, 0))
    draw = library.ImageDraw.Draw(image)
    _plate(draw, face, width, height)
    if face.symbol:
        size = min(width, height) * (0.94 if face.outline != "diamond" else 0.66)
        down = height * 0.04 if face.symbol.endswith("_above") else (height - size) / 2
        SYMBOLS[face.symbol](Pen(draw, (width - size) / 2, down, size, face.ink))
    _legend(library, draw, face, width, height)
    if face.slashed:
        pen = Pen(draw, 0, 0, min(width, height), RING)
        pen.ring((0.5, 0.5), 0.44, 0.07)
        pen.line((0.2, 0.2), (0.8, 0.8), width=0.07)
    return image.resize((width // 2, height // 2), library.Image.Resampling.LANCZOS)


def _plate(draw: Any, face: Face, width: int, height: int) -> None:
    """Ground and border in the sign's outline."""
    if face.outline == "circle":
        draw.ellipse([0, 0, width - 1, height - 1], fill=face.border or face.ground)
        edge = width * 0.035
        draw.ellipse([edge, edge, width - 1 - edge, height - 1 - edge], fill=face.ground)
        return
    if face.outline == "cross":
        for ends in (((0.05, 0.15), (0.95, 0.85)), ((0.95, 0.15), (0.05, 0.85))):
            draw.line([(x * width, y * height) for x, y in ends], fill=face.ground, width=round(height * 0.17))
        return
    points = _corners(face.outline)
    thick = {"triangle_down": 0.2, "octagon": 0.045}.get(face.outline, 0.035)
    draw.polygon([(x * (width - 1), y * (height - 1)) for x, y in points], fill=face.border or face.ground)
    inner = _shrunk(points, thick if face.border else 0.0, width, height)
    draw.polygon(inner, fill=face.ground)


def _corners(outline: str) -> list[Point]:
    cut = 1 / (2 + math.sqrt(2))
    corners: dict[str, list[Point]] = {
        "rectangle": [(0, 0), (1, 0), (1, 1), (0, 1)],
        "octagon": [(cut, 0), (1 - cut, 0), (1, cut), (1, 1 - cut), (1 - cut, 1), (cut, 1), (0, 1 - cut), (0, cut)],
        "triangle_down": [(0, 0), (1, 0), (0.5, 1)],
        "diamond": [(0.5, 0), (1, 0.5), (0.5, 1), (0, 0.5)],
        "pentagon": [(0.5, 0), (1, 0.45), (1, 1), (0, 1), (0, 0.45)],
        "pennant": [(0, 0), (1, 0.5), (0, 1)],
    }
    return corners[outline]


def _shrunk(points: list[Point], by: float, width: int, height: int) -> list[Point]:
    """The corners drawn towards the middle by a share of the shorter side."""
    middle = sum(x for x, _ in points) / len(points), sum(y for _, y in points) / len(points)
    edge = by * min(width, height)
    found = []
    for x, y in points:
        px, py = x * (width - 1), y * (height - 1)
        dx, dy = middle[0] * width - px, middle[1] * height - py
        reach = math.hypot(dx, dy)
        found.append((px + dx / reach * edge * 1.41, py + dy / reach * edge * 1.41))
    return found


def _legend(library: Any, draw: Any, face: Face, width: int, height: int) -> None:
    """The rows of the legend, each as large as its share and the outline's width at its height allow."""
    total = sum(share for _, share in face.lines)
    if not total:
        return
    gap = min(0.05, (0.92 - total) / max(1, len(face.lines)))
    used = total + gap * (len(face.lines) - 1)
    top = (1 - used) / 2 if face.legend_top is None else face.legend_top
    for text, share in face.lines:
        if text:
            _line(library, draw, face, text, (top, share), (width, height))
        top += share + gap


def _line(library: Any, draw: Any, face: Face, text: str, row: tuple[float, float], size: tuple[int, int]) -> None:
    (top, share), (width, height) = row, size
    font = _font(library, text, share * height, _room(face.outline, top, top + share) * width)
    left, up, right, down = draw.textbbox((0, 0), text, font=font)
    middle = 0.38 if face.outline == "pennant" else 0.5
    place = middle * width - (left + right) / 2, (top + share / 2) * height - (up + down) / 2
    ink = face.legend or face.ink
    draw.text(place, text, font=font, fill=ink, stroke_width=_bold(share * height), stroke_fill=ink)


def _room(outline: str, top: float, bottom: float) -> float:
    """The share of the width that a row may fill between two heights."""
    if outline == "diamond":
        return 2 * min(top, 1 - bottom, 0.4) * 0.9
    if outline == "triangle_down":
        return (1 - bottom) * 0.72
    return {"pennant": 0.5, "octagon": 0.86}.get(outline, 0.88)


def _bold(pixels: float) -> int:
    return max(1, round(pixels * 0.03))


def _font(library: Any, text: str, tall: float, room: float) -> Any:
    """Pillow's own scalable font at the size at which the text is `tall` pixels high and no wider than `room`."""
    size = tall * 1.38
    font = library.ImageFont.load_default(size)
    wide = font.getlength(text) + 2 * _bold(tall)
    return font if wide <= room else library.ImageFont.load_default(size * room / wide)
