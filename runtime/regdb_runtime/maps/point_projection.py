"""One point on a reference path, in plain numbers: what `ReferencePath` does for many at once, bit by bit the same, faster for a few."""

from __future__ import annotations

from regdb_runtime.maps.smoothing import PathTable


def project_one(table: PathTable, px: float, py: float, index: int, coarse: float) -> tuple[float, float, float]:
    """Station, offset and 1 - curvature * offset of a point of finite numbers; beyond the ends the path goes on straight, as with `extend`.

    `index`: the nearest of the entries of the table every `coarse` metres. Two steps of Newton's from entry to entry, two within the last.
    """
    last = len(table.x) - 1
    for _ in range(2):
        along, across, bend = _seen_from(table, px, py, index)
        move = min(max(along / max(1.0 - bend * across, 0.2), -coarse), coarse)
        index = min(max(index + round(move / table.step), 0), last)
    along, across, bend = _seen_from(table, px, py, index)
    rate = table.curvature_rate.item(index)
    move = min(max(along / max(1.0 - bend * across, 0.2), -coarse), coarse)
    side = scale = 0.0
    for _ in range(2):
        square = move * move
        ahead = along - (move - bend * bend * square * move / 6)
        aside = across - square * (bend / 2 + rate * move / 6)
        turn = move * (bend + rate * move / 2)
        cos, sin = 1.0 - turn * turn / 2, turn - turn * turn * turn / 6
        miss, side = ahead * cos + aside * sin, aside * cos - ahead * sin
        scale = 1.0 - (bend + rate * move) * side
        move = move + miss / max(scale, 0.2)
    station = table.first + index * table.step + move
    if station < table.first or station > table.last:
        return (table.first if index == 0 else table.last) + along, across, 1.0
    return station, side, scale


def _seen_from(table: PathTable, px: float, py: float, index: int) -> tuple[float, float, float]:
    """A point seen from an entry of the table: how far ahead, how far to the left; and the curvature there."""
    dx, dy = px - table.x.item(index), py - table.y.item(index)
    cos, sin = table.cos.item(index), table.sin.item(index)
    return dx * cos + dy * sin, dy * cos - dx * sin, table.curvature.item(index)
