"""What the lights show: each head runs its cycle, the same for every run."""

from __future__ import annotations

import math
from collections.abc import Mapping

from regdb_runtime.maps.road_map import Floats, Light, RoadMap
from regdb_runtime.observation import Color, EgoState, Indication, Shape

_SHAPES: Mapping[str, Shape] = {"right": "right_arrow", "left": "left_arrow", "straight": "straight_arrow"}
_COLORS: Mapping[str, Color] = {"red": "red", "yellow": "yellow", "green": "green", "red_yellow": "red", "inactive": "dark"}


def color_at(light: Light, time: float) -> Color:
    """The colour a head shows `time` seconds after the run began; `offset` is how far its cycle had run by then."""
    if not light.active or not light.cycle:
        return "dark"
    left = math.fmod(time + light.offset, sum(phase.duration for phase in light.cycle))
    for phase in light.cycle:
        if left < phase.duration - 1e-9:
            return _COLORS[phase.color]
        left -= phase.duration
    return _COLORS[light.cycle[0].color]


class Signals:
    """All heads of a map, with the direction of the traffic each faces."""

    def __init__(self, road_map: RoadMap) -> None:
        self._lights = dict(road_map.lights)
        self._headings: dict[str, float] = {}
        self._places: dict[str, tuple[float, float]] = {}
        for lane in road_map.lanes.values():
            if lane.junction is not None:
                for name in lane.lights:
                    self._place(name, lane.center[0], lane.center[1] - lane.center[0])
        for lane in road_map.lanes.values():  # maps read from files have a light on the lane that ends at it
            for name in lane.lights:
                if name not in self._places:
                    self._place(name, lane.center[-1], lane.center[-1] - lane.center[-2])

    def _place(self, name: str, at: Floats, course: Floats) -> None:
        self._headings[name] = math.atan2(course[1], course[0])
        self._places[name] = (float(at[0]), float(at[1]))

    def color(self, light: str, time: float) -> Color:
        """What one head shows."""
        return color_at(self._lights[light], time)

    def governing(self, lights: tuple[str, ...]) -> str | None:
        """Of the heads that speak to a movement the one that governs it: an arrow before a circular one."""
        return next((name for name in lights if self._lights[name].arrow), lights[0] if lights else None)

    def is_arrow(self, light: str) -> bool:
        return self._lights[light].arrow

    def seen(self, time: float, ego: EgoState, reach: float) -> dict[str, tuple[Indication, ...]]:
        """The heads that face the ego, from `reach` metres before the junction until it has passed the junction's beginning by 15 m."""
        found: dict[str, tuple[Indication, ...]] = {}
        for name, heading in self._headings.items():
            x, y = self._places[name]
            ahead = (x - ego.x) * math.cos(ego.heading) + (y - ego.y) * math.sin(ego.heading)
            facing = math.cos(heading - ego.heading)
            if facing > 0.5 and ahead >= -15.0 and math.hypot(x - ego.x, y - ego.y) <= reach:
                light = self._lights[name]
                shape = _SHAPES[light.direction] if light.arrow and light.direction in _SHAPES else "circular"
                found[name] = (Indication(color_at(light, time), shape),)
        return found
