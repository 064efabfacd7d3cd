"""Symbols on signs as strokes and shapes in a unit square: x to the right, y down, 0 to 1."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

Point = tuple[float, float]
Draw = Any
"""Pillow's `ImageDraw.Draw`."""


class Pen:
    """Draws in unit coordinates onto a square of an image."""

    def __init__(self, draw: Draw, left: float, top: float, size: float, ink: tuple[int, int, int]) -> None:
        self._draw, self._left, self._top, self._size, self.ink = draw, left, top, size, ink

    def at(self, x: float, y: float) -> Point:
        """Pixels of a unit point."""
        return self._left + x * self._size, self._top + y * self._size

    def line(self, *points: Point, width: float = 0.09, ink: tuple[int, int, int] | None = None) -> None:
        """A stroke with round joints."""
        wide = max(1, round(width * self._size))
        self._draw.line([self.at(*p) for p in points], fill=ink or self.ink, width=wide, joint="curve")
        for point in (points[0], points[-1]):
            self.dot(point, width / 2, ink)

    def dot(self, middle: Point, radius: float, ink: tuple[int, int, int] | None = None) -> None:
        """A filled circle."""
        (x, y), r = self.at(*middle), radius * self._size
        self._draw.ellipse([x - r, y - r, x + r, y + r], fill=ink or self.ink)

    def ring(self, middle: Point, radius: float, width: float, ink: tuple[int, int, int] | None = None) -> None:
        """A circle's line."""
        (x, y), r = self.at(*middle), radius * self._size
        self._draw.ellipse([x - r, y - r, x + r, y + r], outline=ink or self.ink, width=max(1, round(width * self._size)))

    def shape(self, *points: Point, ink: tuple[int, int, int] | None = None) -> None:
        """A filled polygon."""
        self._draw.polygon([self.at(*p) for p in points], fill=ink or self.ink)

    def head(self, tip: Point, degrees: float, size: float = 0.16) -> None:
        """An arrow's head that points to `degrees`: 0 right, 90 up."""
        turn = math.radians(degrees)
        ahead, aside = (math.cos(turn), -math.sin(turn)), (math.sin(turn), math.cos(turn))
        back = tip[0] - size * ahead[0], tip[1] - size * ahead[1]
        wide = size * 0.75
        self.shape(tip, (back[0] + aside[0] * wide, back[1] + aside[1] * wide), (back[0] - aside[0] * wide, back[1] - aside[1] * wide))

    def arrow(self, *points: Point, width: float = 0.09, size: float = 0.18) -> None:
        """A stroke that ends in a head."""
        (ax, ay), (bx, by) = points[-2:]
        degrees = math.degrees(math.atan2(ay - by, bx - ax))
        reach = math.hypot(bx - ax, by - ay)
        stop = bx - (bx - ax) / reach * size * 0.8, by - (by - ay) / reach * size * 0.8
        self.line(*points[:-1], stop, width=width)
        self.head((bx, by), degrees, size)


def _turn(side: float) -> Callable[[Pen], None]:
    def draw(pen: Pen) -> None:
        pen.arrow((0.5 - side * 0.15, 0.85), (0.5 - side * 0.15, 0.42), (0.5 + side * 0.32, 0.42))

    return draw


def _turn_above(side: float) -> Callable[[Pen], None]:
    def draw(pen: Pen) -> None:
        pen.arrow((0.5 - side * 0.12, 0.6), (0.5 - side * 0.12, 0.28), (0.5 + side * 0.3, 0.28), width=0.08)

    return draw


def _u_turn(pen: Pen) -> None:
    points = [(0.5 + 0.17 * math.cos(a), 0.4 - 0.17 * math.sin(a)) for a in [k * math.pi / 10 for k in range(11)]]
    pen.line((0.67, 0.82), *points, (0.33, 0.5))
    pen.head((0.33, 0.72), -90, 0.2)


def _keep(side: float) -> Callable[[Pen], None]:
    def draw(pen: Pen) -> None:
        pen.shape((0.5 - side * 0.3, 0.6), (0.5 - side * 0.12, 0.5), (0.5 - side * 0.05, 0.92), (0.5 - side * 0.35, 0.92))
        pen.arrow((0.5 - side * 0.22, 0.42), (0.5 + side * 0.1, 0.55), (0.5 + side * 0.18, 0.88), width=0.09)
        pen.line((0.5 - side * 0.22, 0.12), (0.5 - side * 0.22, 0.42))

    return draw


def _no_entry(pen: Pen) -> None:
    pen.dot((0.5, 0.5), 0.48, (187, 30, 40))
    pen.shape((0.16, 0.42), (0.84, 0.42), (0.84, 0.58), (0.16, 0.58))


def _bicycle(pen: Pen, y: float = 0.62, r: float = 0.19) -> None:
    pen.ring((0.24, y), r, 0.05)
    pen.ring((0.76, y), r, 0.05)
    pen.line((0.24, y), (0.4, y - 0.28), (0.68, y - 0.28), (0.5, y), (0.24, y), width=0.045)
    pen.line((0.5, y), (0.38, y - 0.34), width=0.045)
    pen.line((0.31, y - 0.36), (0.45, y - 0.36), width=0.05)
    pen.line((0.76, y), (0.65, y - 0.4), (0.76, y - 0.4), width=0.045)


def _bicycle_above(pen: Pen) -> None:
    _bicycle(pen, 0.49, 0.14)


def _pedestrian(pen: Pen, x: float = 0.5, top: float = 0.12, tall: float = 0.76) -> None:
    def at(dx: float, dy: float) -> Point:
        return x + dx * tall, top + dy * tall

    pen.dot(at(0.0, 0.09), 0.095 * tall)
    pen.line(at(0.0, 0.24), at(0.0, 0.56), width=0.17 * tall)
    pen.line(at(0.0, 0.26), at(0.18, 0.46), width=0.075 * tall)
    pen.line(at(0.0, 0.26), at(-0.16, 0.5), width=0.075 * tall)
    pen.line(at(0.02, 0.58), at(0.14, 0.97), width=0.09 * tall)
    pen.line(at(-0.02, 0.58), at(-0.15, 0.95), width=0.09 * tall)


def _children(pen: Pen) -> None:
    _pedestrian(pen, 0.4, 0.26, 0.62)
    _pedestrian(pen, 0.68, 0.4, 0.48)


def _truck(pen: Pen) -> None:
    pen.shape((0.1, 0.32), (0.62, 0.32), (0.62, 0.66), (0.1, 0.66))
    pen.shape((0.65, 0.44), (0.8, 0.44), (0.9, 0.55), (0.9, 0.66), (0.65, 0.66))
    pen.dot((0.26, 0.7), 0.075)
    pen.dot((0.76, 0.7), 0.075)


def _arrow_bar(pen: Pen) -> None:
    pen.shape((-0.75, 0.3), (1.3, 0.3), (1.3, 0.12), (1.8, 0.5), (1.3, 0.88), (1.3, 0.7), (-0.75, 0.7))


def _arrow_down_left(pen: Pen) -> None:
    pen.arrow((0.8, 0.9), (0.25, 1.14), width=0.1, size=0.22)


def _two_way_left(pen: Pen) -> None:
    pen.arrow((0.46, 1.2), (0.46, 0.98), (0.12, 0.98), width=0.07, size=0.16)
    pen.arrow((0.54, 0.84), (0.54, 1.06), (0.88, 1.06), width=0.07, size=0.16)


def _curve_right(pen: Pen) -> None:
    points = [(0.36 + 0.3 * (1 - math.cos(a)), 0.58 - 0.34 * math.sin(a)) for a in [k * math.pi / 20 for k in range(11)]]
    pen.arrow((0.36, 0.85), *points, (0.78, 0.22), width=0.11, size=0.22)


def _crossroads(pen: Pen) -> None:
    pen.line((0.5, 0.15), (0.5, 0.85), width=0.12)
    pen.line((0.15, 0.5), (0.85, 0.5), width=0.12)


def _side_road(pen: Pen) -> None:
    pen.line((0.45, 0.15), (0.45, 0.85), width=0.12)
    pen.line((0.45, 0.5), (0.82, 0.5), width=0.09)


def _t_junction(pen: Pen) -> None:
    pen.line((0.5, 0.32), (0.5, 0.85), width=0.12)
    pen.line((0.15, 0.32), (0.85, 0.32), width=0.12)


def _roundabout(pen: Pen) -> None:
    for start in (90, 210, 330):
        arc = [math.radians(start + k * 9) for k in range(10)]
        pen.arrow(*[(0.5 + 0.27 * math.cos(a), 0.5 - 0.27 * math.sin(a)) for a in arc], width=0.08, size=0.16)


def _stop_ahead(pen: Pen) -> None:
    corners = [(0.5 + 0.2 * math.cos(math.radians(22.5 + 45 * k)), 0.38 + 0.2 * math.sin(math.radians(22.5 + 45 * k))) for k in range(8)]
    pen.shape(*corners, ink=(187, 30, 40))
    pen.arrow((0.5, 0.9), (0.5, 0.62), width=0.08, size=0.14)


def _signal_ahead(pen: Pen) -> None:
    pen.shape((0.36, 0.14), (0.64, 0.14), (0.64, 0.86), (0.36, 0.86))
    for y, ink in ((0.27, (187, 30, 40)), (0.5, (250, 204, 28)), (0.73, (0, 150, 80))):
        pen.dot((0.5, y), 0.095, ink)


def _merge(pen: Pen) -> None:
    pen.arrow((0.42, 0.88), (0.42, 0.14), width=0.1)
    pen.line((0.72, 0.85), (0.46, 0.48), width=0.08)


def _lane_ends(pen: Pen) -> None:
    pen.line((0.34, 0.86), (0.34, 0.14), width=0.07)
    pen.line((0.74, 0.86), (0.74, 0.6), (0.54, 0.34), (0.54, 0.14), width=0.07)


def _divided(pen: Pen) -> None:
    pen.arrow((0.36, 0.15), (0.36, 0.85), width=0.08)
    pen.arrow((0.64, 0.85), (0.64, 0.15), width=0.08)
    pen.line((0.5, 0.14), (0.5, 0.4), width=0.1)


def _two_way(pen: Pen) -> None:
    pen.arrow((0.36, 0.15), (0.36, 0.85), width=0.1)
    pen.arrow((0.64, 0.85), (0.64, 0.15), width=0.1)


def _grade(pen: Pen) -> None:
    pen.shape((0.12, 0.45), (0.88, 0.75), (0.12, 0.75))
    pen.shape((0.3, 0.3), (0.62, 0.43), (0.58, 0.53), (0.26, 0.4))


def _slippery(pen: Pen) -> None:
    pen.shape((0.34, 0.2), (0.66, 0.2), (0.72, 0.42), (0.28, 0.42))
    for x in (0.36, 0.64):
        pen.line((x, 0.48), (x - 0.1, 0.6), (x + 0.06, 0.7), (x - 0.06, 0.84), width=0.05)


def _railroad(pen: Pen) -> None:
    pen.line((0.2, 0.2), (0.8, 0.8), width=0.09)
    pen.line((0.8, 0.2), (0.2, 0.8), width=0.09)
    for x in (0.12, 0.74):
        pen.line((x, 0.6), (x, 0.4), (x + 0.1, 0.42), (x + 0.1, 0.49), (x, 0.5), width=0.035)
        pen.line((x + 0.04, 0.5), (x + 0.12, 0.6), width=0.035)


def _worker(pen: Pen) -> None:
    _pedestrian(pen, 0.42, 0.14, 0.7)
    pen.line((0.5, 0.42), (0.78, 0.72), width=0.05)
    pen.shape((0.66, 0.86), (0.92, 0.86), (0.8, 0.68))


SYMBOLS: Mapping[str, Callable[[Pen], None]] = {
    "turn_right": _turn(1), "turn_left": _turn(-1), "turn_right_above": _turn_above(1), "turn_left_above": _turn_above(-1), "u_turn": _u_turn,
    "keep_right": _keep(1), "keep_left": _keep(-1), "no_entry": _no_entry, "bicycle": _bicycle, "bicycle_above": _bicycle_above,
    "pedestrian": _pedestrian, "children": _children, "truck": _truck, "arrow_bar": _arrow_bar, "arrow_down_left": _arrow_down_left,
    "two_way_left": _two_way_left, "curve_right": _curve_right, "crossroads": _crossroads, "side_road": _side_road, "t_junction": _t_junction,
    "roundabout": _roundabout, "stop_ahead": _stop_ahead, "signal_ahead": _signal_ahead, "merge": _merge, "lane_ends": _lane_ends,
    "divided": _divided, "two_way": _two_way, "grade": _grade, "slippery": _slippery, "railroad": _railroad, "worker": _worker,
}  # fmt: skip
