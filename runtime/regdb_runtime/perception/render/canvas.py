"""The picture being drawn: world polygons, strokes and pasted faces in the order of distance, and beside it who covers which pixel."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from regdb_runtime.perception.render.camera import Camera
from regdb_runtime.perception.render.draw_sign import pillow
from regdb_runtime.perception.render.sign_faces import Colour
from regdb_runtime.planning.trajectory import Floats

FAR_OUT = 8000.0
"""Pixels beyond which corners are drawn in: the drawing library takes no larger ones."""
COARSE = 4
"""Pixels of the frame to one pixel of the picture that tells who covers what."""


@dataclass(frozen=True, slots=True)
class Extent:
    """Where a thing appeared: its box in pixels (left, top, right, bottom), clipped to the frame, and the share of it that something hides."""

    box: tuple[float, float, float, float]
    hidden: float


class Canvas:
    """Draws one frame. `owner`: number of the thing being drawn; 0 for the ground, -1 for what hides things without being one of them."""

    def __init__(self, camera: Camera) -> None:
        self.camera, self.library = camera, pillow()
        settings = camera.settings
        self.size = settings.width, settings.height
        self.image = self.library.Image.new("RGB", self.size)
        self._draw = self.library.ImageDraw.Draw(self.image)
        self._owners = self.library.Image.new("I", (settings.width // COARSE, settings.height // COARSE), 0)
        self._owned = self.library.ImageDraw.Draw(self._owners)
        self._drawn: dict[int, list[Floats]] = {}
        self.owner = 0

    def band(self, top: float, bottom: float, above: Colour, below: Colour) -> None:
        """Rows of the whole width, blended from one colour to the other."""
        first, last = max(0, math.floor(top)), min(self.size[1], math.ceil(bottom))
        if last <= first:
            return
        share = np.linspace(0, 1, last - first)[:, None]
        rows = (np.array(above) * (1 - share) + np.array(below) * share).astype(np.uint8)
        whole = np.broadcast_to(rows[:, None, :], (last - first, self.size[0], 3))
        self.image.paste(self.library.Image.fromarray(np.ascontiguousarray(whole)), (0, first))

    def polygon(self, points: Floats, colour: Colour, edge: Colour | None = None) -> None:
        """A filled world polygon (n, 3)."""
        pixels = self.camera.polygon(points)
        if pixels is not None:
            self.fill(pixels, colour, edge)

    def fill(self, pixels: Floats, colour: Colour, edge: Colour | None = None) -> None:
        """A filled polygon of pixels (n, 2)."""
        corners = pixels.tolist()
        columns, rows = [x for x, _ in corners], [y for _, y in corners]
        if max(columns) < 0 or max(rows) < 0 or min(columns) > self.size[0] or min(rows) > self.size[1]:
            return
        flat = [(min(max(x, -FAR_OUT), FAR_OUT), min(max(y, -FAR_OUT), FAR_OUT)) for x, y in corners]
        self._draw.polygon(flat, fill=colour, outline=edge)
        if self.owner:
            self._own(pixels)

    def stroke(self, points: Floats, thickness: float, colour: Colour) -> None:
        """A line through world points (n, 3), `thickness` metres wide, with round ends; nothing when any part is behind the camera."""
        seen = self.camera.seen(points)
        if (seen[:, 2] < 0.5).any():
            return
        pixels = self.camera.pixels(seen)
        widths = thickness * self.camera.focal / seen[:, 2]
        for (ax, ay), (bx, by), wa, wb in zip(pixels[:-1], pixels[1:], widths[:-1], widths[1:], strict=True):
            reach = math.hypot(bx - ax, by - ay) or 1.0
            nx, ny = -(by - ay) / reach / 2, (bx - ax) / reach / 2
            quad = np.array([(ax + nx * wa, ay + ny * wa), (bx + nx * wb, by + ny * wb), (bx - nx * wb, by - ny * wb), (ax - nx * wa, ay - ny * wa)])
            self._draw.polygon([tuple(p) for p in quad.tolist()], fill=colour)
            self._own(quad)
        for (x, y), wide in zip(pixels.tolist(), widths.tolist(), strict=True):
            self._circle(x, y, wide / 2, colour)

    def disc(self, middle: Floats, radius: float, colour: Colour, edge: Colour | None = None) -> None:
        """A ball of the world, drawn as a circle."""
        seen = self.camera.seen(middle[None, :])
        if seen[0, 2] > 0.5:
            (x, y), r = self.camera.pixels(seen)[0], radius * self.camera.focal / float(seen[0, 2])
            self._circle(float(x), float(y), r, colour, edge)

    def glow(self, middle: Floats, radius: float, colour: Colour) -> None:
        """A lamp's light around it."""
        seen = self.camera.seen(middle[None, :])
        if seen[0, 2] < 1.0:
            return
        (x, y), r = self.camera.pixels(seen)[0], max(3.0, radius * self.camera.focal / float(seen[0, 2]))
        size = 2 * math.ceil(r) + 1
        apart = np.hypot(*np.meshgrid(np.linspace(-1, 1, size), np.linspace(-1, 1, size)))
        mask = self.library.Image.fromarray((np.clip(1 - apart, 0, 1) ** 2 * 150).astype(np.uint8))
        self.image.paste(self.library.Image.new("RGB", (size, size), colour), (round(float(x) - size / 2), round(float(y) - size / 2)), mask)

    def face(self, corners: Floats, picture: Any) -> None:
        """A picture with transparency laid on a world rectangle (4, 3): top left, top right, bottom right, bottom left."""
        seen = self.camera.seen(corners)
        if (seen[:, 2] < 0.5).any():
            return
        pixels = self.camera.pixels(seen)
        if not self._visible(pixels):
            return
        left, top = np.floor(pixels.min(axis=0)).astype(int)
        right, bottom = np.ceil(pixels.max(axis=0)).astype(int) + 1
        if right - left < 2 or bottom - top < 2 or right - left > 4000:
            return
        while picture.width > 2.5 * (right - left) and picture.width > 8:
            picture = picture.reduce(2)
        bent = picture.transform(
            (int(right - left), int(bottom - top)), self.library.Image.Transform.PERSPECTIVE,
            _perspective(pixels - (left, top), picture.size), self.library.Image.Resampling.BICUBIC,
        )  # fmt: skip
        self.image.paste(bent, (int(left), int(top)), bent)
        self._own(pixels)

    def extent(self, owner: int) -> Extent | None:
        """Where the thing of a number appeared; None when no part of it lies in the frame."""
        parts = self._drawn.get(owner)
        if not parts:
            return None
        points = np.concatenate(parts)
        (left, top), (right, bottom) = np.clip(points.min(axis=0), 0, self.size), np.clip(points.max(axis=0), 0, self.size)
        if right - left < 1 or bottom - top < 1:
            return None
        alone = self.library.Image.new("1", self._owners.size)
        draw = self.library.ImageDraw.Draw(alone)
        for part in parts:
            draw.polygon([tuple(p) for p in (part / COARSE).tolist()], fill=1)
        covered = int(np.count_nonzero(np.asarray(alone)))
        own = int(np.count_nonzero(np.asarray(self._owners) == owner))
        hidden = 1 - min(1.0, own / covered) if covered else 0.0
        return Extent((float(left), float(top), float(right), float(bottom)), hidden)

    def _circle(self, x: float, y: float, r: float, colour: Colour, edge: Colour | None = None) -> None:
        self._draw.ellipse([x - r, y - r, x + r, y + r], fill=colour, outline=edge)
        self._own(np.array([(x - r, y - r), (x + r, y - r), (x + r, y + r), (x - r, y + r)]))

    def _own(self, pixels: Floats) -> None:
        """Note who covers these pixels; things without a number (`scenery`) cover them for nobody."""
        if self.owner > 0:
            self._drawn.setdefault(self.owner, []).append(pixels)
        self._owned.polygon([tuple(p) for p in (np.clip(pixels, -FAR_OUT, FAR_OUT) / COARSE).tolist()], fill=self.owner)

    def _visible(self, pixels: Floats) -> bool:
        low, high = pixels.min(axis=0), pixels.max(axis=0)
        return bool(high[0] >= 0 and high[1] >= 0 and low[0] < self.size[0] and low[1] < self.size[1])


def _perspective(corners: Floats, size: tuple[int, int]) -> Sequence[float]:
    """Pillow's eight numbers that take a pixel of the frame to one of the picture."""
    width, height = size
    rows, wanted = [], []
    for (x, y), (u, v) in zip(corners, [(0, 0), (width, 0), (width, height), (0, height)], strict=True):
        rows += [[x, y, 1, 0, 0, 0, -u * x, -u * y], [0, 0, 0, x, y, 1, -v * x, -v * y]]
        wanted += [u, v]
    return [float(n) for n in np.linalg.lstsq(np.array(rows, dtype=float), np.array(wanted, dtype=float), rcond=None)[0]]
