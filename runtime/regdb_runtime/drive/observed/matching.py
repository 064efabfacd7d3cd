"""Which lane a recorded vehicle was in at each instant: the likeliest sequence over its whole recording (Viterbi), so that overlapping lanes are told
apart by where the vehicle came from and went to."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from regdb_runtime.maps.junctions import side_by_side
from regdb_runtime.maps.lane_graph import LaneGraph
from regdb_runtime.worlds.replay import Motion


@dataclass(frozen=True, slots=True)
class MatchSettings:
    """What makes a lane unlikely; less is likelier. One unit: `offset` metres from the centre, or `course` radians off its course (squared each).

    `beside`: a change to the lane beside; `jump`: to a lane that neither follows nor runs beside; `off_road`: being on no lane, per state.
    `reach`, `turned`: beyond so many metres from the centre, or radians off the course, a lane is none of the vehicle's.
    """

    offset: float = 1.0
    course: float = 0.35
    onward: float = 0.2
    beside: float = 6.0
    jump: float = 40.0
    off_road: float = 12.0
    reach: float = 3.0
    turned: float = 1.2


@dataclass(frozen=True, slots=True)
class Leg:
    """A lane driven in without a break: rows of the motion from `first` to `last`, both in it; `lane` None where it was on none."""

    lane: str | None
    first: int
    last: int


def match(graph: LaneGraph, motion: Motion, settings: MatchSettings | None = None) -> tuple[Leg, ...]:
    """The lanes of a motion in order, without gaps."""
    settings = settings or MatchSettings()
    chain = _likeliest(graph, [_costs(graph, motion, row, settings) for row in range(len(motion.time))], settings)
    legs: list[Leg] = []
    for row, lane in enumerate(chain):
        if legs and legs[-1].lane == lane:
            legs[-1] = Leg(lane, legs[-1].first, row)
        else:
            legs.append(Leg(lane, row, row))
    return tuple(legs)


def _costs(graph: LaneGraph, motion: Motion, row: int, settings: MatchSettings) -> dict[str | None, float]:
    """Lane -> how unlikely it is by place and course alone; None: off the road."""
    x, y, heading = float(motion.x[row]), float(motion.y[row]), float(motion.heading[row])
    found: dict[str | None, float] = {
        name: (offset / settings.offset) ** 2 + (off / settings.course) ** 2
        for (name, _, offset), off in graph.lanes_around(x, y, heading, settings.reach) if off <= settings.turned
    }
    found[None] = settings.off_road
    return found


def _likeliest(graph: LaneGraph, costs: Sequence[dict[str | None, float]], settings: MatchSettings) -> list[str | None]:
    total, came_from = dict(costs[0]), []
    for here in costs[1:]:
        best: dict[str | None, float] = {}
        back: dict[str | None, str | None] = {}
        for lane, cost in here.items():
            before, reached = min(
                ((name, value + _step(graph, name, lane, settings)) for name, value in total.items()), key=lambda item: (item[1], item[0] or "")
            )
            best[lane], back[lane] = reached + cost, before
        total = best
        came_from.append(back)
    last = min(total, key=lambda name: (total[name], name or ""))
    chain = [last]
    for back in reversed(came_from):
        chain.append(back[chain[-1]])
    return chain[::-1]


def _step(graph: LaneGraph, before: str | None, after: str | None, settings: MatchSettings) -> float:
    """What going from one lane to another in one step costs."""
    if before == after:
        return 0.0
    if before is None or after is None:
        return settings.beside
    if after in graph.successors(before):
        return settings.onward
    lanes = graph.road_map.lanes
    if after in side_by_side(lanes, before) or any(after in side_by_side(lanes, name) for name in graph.successors(before)):
        return settings.beside
    return settings.jump


def offset_on(graph: LaneGraph, lane: str, motion: Motion, row: int) -> float:
    """Offset of the vehicle's middle from a lane's centre, positive left; infinite where it is far from it."""
    found = graph.nearest(float(motion.x[row]), float(motion.y[row]), None, 50.0, (lane,))
    return math.inf if found is None else found[2]
