"""A cycle of ours for the lights of a map that does not know their phases: one part of it for the route's axis, the rest for the crossing one."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

from regdb_runtime.maps.road_map import Lane, Light, Phase, RoadMap
from regdb_runtime.worlds.recorded_spec import LightsSpec

ALONG = 0.7
"""Least cosine (either way) of the angle between two approaches of one axis: 45 degrees."""
CLEARING = 2.0
"""Seconds of red for everybody between the axes."""


def scripted_lights(road_map: RoadMap, spec: LightsSpec, route: Sequence[str]) -> RoadMap:
    """The map with the script in its lights; unchanged where the file's own plan is asked for, or none, or the route passes no light."""
    if spec.plan in ("none", "nominal"):
        return road_map
    courses = {name: _course(lane) for lane in road_map.lanes.values() for name in lane.lights}
    own = next((courses[name] for lane in route for name in road_map.lanes[lane].lights), None)
    if own is None:
        return road_map
    lights = {
        name: _cycled(light, spec, along=abs(math.cos(courses[name] - own)) > ALONG) if name in courses else light
        for name, light in road_map.lights.items()
    }
    return replace(road_map, lights=lights)


def _course(lane: Lane) -> float:
    """The heading at the lane's end."""
    dx, dy = lane.center[-1] - lane.center[-2]
    return math.atan2(float(dy), float(dx))


def _cycled(light: Light, spec: LightsSpec, *, along: bool) -> Light:
    """Red, then green, then yellow for the route's axis; the crossing axis has its green and yellow within that red."""
    cycle: tuple[Phase, ...]
    if along:
        cycle = (Phase("red", spec.red), Phase("green", spec.green), Phase("yellow", spec.yellow))
    else:
        green = max(spec.red - spec.yellow - 2 * CLEARING, 0.0)
        cycle = (
            Phase("red", CLEARING), Phase("green", green), Phase("yellow", spec.yellow), Phase("red", CLEARING + spec.green + spec.yellow)
        )  # fmt: skip
    offset = spec.red if spec.plan == "green" else 0.0
    return replace(light, cycle=cycle, offset=offset)
