"""A path cut where anything about the law's facts changes: pieces of its lanes, stages of the junction, rails, and the clock."""

from __future__ import annotations

import datetime
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

from regdb_runtime.maps.lane_path import Junction, LanePath, LaneSpan
from regdb_runtime.maps.road_map import Lane
from regdb_runtime.scenes.pieces import Band, LanePieces, Piece
from regdb_runtime.scenes.settings import SceneSettings
from regdb_runtime.scenes.stretch import Stage

SHORTEST = 0.02
"""Metres: a shorter part is a rounding of borders."""


@dataclass(frozen=True, eq=False, slots=True)
class Part:
    """Part of a path: from where to where, on which lane and piece of it, at what stage of a junction, before which rails, when."""

    start: float
    end: float
    lane: str
    piece: Piece
    stage: Stage
    rail: Band | None
    rail_station: float | None
    clock: datetime.datetime


class Courses:
    """Where the lanes' pieces, crosswalks and rails lie along paths. Paths are remembered: the same ones are asked about at every tick."""

    def __init__(self, pieces: LanePieces, settings: SceneSettings, capacity: int = 256) -> None:
        self.pieces, self.settings, self._capacity = pieces, settings, capacity
        self._bands: dict[int, tuple[LanePath, tuple[tuple[float, float, Band], ...], tuple[tuple[float, float, Band], ...]]] = {}

    def crosswalks(self, lane_path: LanePath) -> tuple[tuple[float, float, Band], ...]:
        """Crosswalks on the path with the stations between which they lie, in order."""
        return self._along(lane_path)[1]

    def rails(self, lane_path: LanePath) -> tuple[tuple[float, float, Band], ...]:
        """Rail crossings on the path, likewise."""
        return self._along(lane_path)[2]

    def _along(self, lane_path: LanePath) -> tuple[LanePath, tuple[tuple[float, float, Band], ...], tuple[tuple[float, float, Band], ...]]:
        found = self._bands.get(id(lane_path))
        if found is None:
            if len(self._bands) >= self._capacity:
                del self._bands[next(iter(self._bands))]
            walks = [placed for span in lane_path.spans for placed in _placed(self._lane(span), span, self.pieces.crosswalks(span.lane))]
            rails = [placed for span in lane_path.spans for placed in _placed(self._lane(span), span, self.pieces.rails(span.lane))]
            found = self._bands[id(lane_path)] = lane_path, _joined(walks), _joined(rails)
        return found

    def _lane(self, span: LaneSpan) -> Lane:
        return self.pieces.road_map.lanes[span.lane]

    def parts(
        self, lane_path: LanePath, front: float, reach: float, stages: Sequence[tuple[float, Stage]], clock: datetime.datetime, speed: float,
        change: float | None,
    ) -> list[Part]:  # fmt: skip
        """The parts from the front bumper to `reach` metres ahead (or the path's end), in order, without gaps.

        `stages`: station from which each holds, ascending, the first at or before the front. The clock of a part is that of arrival at its
        start at the present speed; after `change` seconds (None: not on the way) the hour changes the facts: a border at the place reached then.
        """
        last = max(min(front + reach, lane_path.path.length), front + 2 * SHORTEST)
        rails = self.rails(lane_path)
        borders = {front, last} | {at for at, _ in stages if front < at < last}
        borders |= {at for start, end, _ in rails for at in (start - self.settings.approach, end) if front < at < last}
        turning = last + 1.0 if change is None else front + change * speed
        if turning < last:
            borders.add(turning)
        later = clock if change is None else clock + datetime.timedelta(seconds=change + 1e-3)
        found: list[Part] = []
        for span in lane_path.spans:
            if (span.end > front and span.start < last) or span is lane_path.spans[-1]:
                self._on_span(span, front, last, sorted(borders), turning, clock, later, stages, rails, speed, span is lane_path.spans[-1], found)
        return found

    def _on_span(
        self, span: LaneSpan, front: float, last: float, borders: list[float], turning: float, clock: datetime.datetime, later: datetime.datetime,
        stages: Sequence[tuple[float, Stage]], rails: Sequence[tuple[float, float, Band]], speed: float, is_last: bool, found: list[Part],
    ) -> None:  # fmt: skip
        lane = self._lane(span)
        scale = (span.end - span.start) / max(lane.length - span.lane_start, 1e-9)
        first, end = max(front, span.start), last if is_last else min(last, span.end)
        for when, low, high in ((clock, first, min(end, turning)), (later, max(first, turning), end)):
            if high - low < SHORTEST:
                continue
            pieces = self.pieces.at(span.lane, when)
            edges = [span.start + (piece.end - span.lane_start) * scale for piece in pieces[:-1]]
            cuts = sorted({low, high, *(at for at in (*borders, *edges) if low < at < high)})
            for start, stop in pairwise(cuts):
                if stop - start < SHORTEST and found:
                    continue
                middle = (start + stop) / 2
                place = sum(1 for edge in edges if edge <= middle)
                rail = next(((at, band) for at, over, band in rails if at - self.settings.approach <= middle < over), None)
                arrival = clock if speed < 1.0 else max(when, clock + datetime.timedelta(seconds=max(0.0, start - front) / speed))
                at_rail, band = (None, None) if rail is None else rail
                found.append(Part(start, stop, span.lane, pieces[place], _stage(stages, middle), band, at_rail, arrival))


def _stage(stages: Sequence[tuple[float, Stage]], station: float) -> Stage:
    found: Stage = "road"
    for at, stage in stages:
        if at <= station:
            found = stage
    return found


def stages_of(
    junction: Junction | None, front: float, crossed: bool, length: float, settings: SceneSettings
) -> tuple[list[tuple[float, Stage]], float | None]:
    """Stations from which each stage holds, and the station of the line before which the vehicle still is (None: past it, or none ahead).

    The line is the junction's; a vehicle that stands a little past it without having stopped there has it just before its front.
    """
    if junction is None:
        return [(front, "road")], None
    out: list[tuple[float, Stage]] = [(junction.exit + length, "road")]
    if crossed:
        return [(front, "inside"), *out], None
    line = max(junction.stop_station, front + 0.1)
    begins = min(junction.entrance - settings.approach, junction.stop_station - settings.at_line)
    before: list[tuple[float, Stage]] = [(front, "road"), (begins, "approach")] if begins > front else [(front, "approach")]
    return [*before, (line, "inside"), *[(max(at, line + SHORTEST), stage) for at, stage in out]], line


def _placed(lane: Lane, span: LaneSpan, bands: Sequence[Band]) -> list[tuple[float, float, Band]]:
    scale = (span.end - span.start) / max(lane.length - span.lane_start, 1e-9)
    placed = [(span.start + (band.start - span.lane_start) * scale, span.start + (band.end - span.lane_start) * scale, band) for band in bands]
    return [(max(start, span.start), end, band) for start, end, band in placed if end > span.start]


def _joined(bands: list[tuple[float, float, Band]]) -> tuple[tuple[float, float, Band], ...]:
    """Bands of one area that continue from lane to lane as one."""
    found: list[tuple[float, float, Band]] = []
    for start, end, band in sorted(bands, key=lambda item: (item[0], item[2].id)):
        if found and found[-1][2].id == band.id and start - found[-1][1] < 0.5:
            found[-1] = (found[-1][0], max(end, found[-1][1]), found[-1][2])
        else:
            found.append((start, end, band))
    return tuple(found)
