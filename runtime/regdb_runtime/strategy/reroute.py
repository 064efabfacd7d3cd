"""Another route from the lane the vehicle is in, when a change of lane that the route needs has not come about in time."""

from __future__ import annotations

from regdb_runtime.errors import NoRoute
from regdb_runtime.maps.junctions import side_by_side
from regdb_runtime.maps.lane_graph import is_driven
from regdb_runtime.maps.lane_path import lanes_along
from regdb_runtime.maps.road_map import RoadMap
from regdb_runtime.maps.route import Route, find_route, route_along

AWAY = 1000.0
"""Metres followed of the straightest way where the destination cannot be reached from here at all."""


def reroute(road_map: RoadMap, lane: str, route: Route) -> Route:
    """The shortest route to the same goal without a change of lane before the lane's end; where none leads there, the straightest way on."""
    found: list[tuple[float, tuple[str, ...]]] = []
    for following in sorted(road_map.lanes[lane].successors):
        if not is_driven(road_map.lanes[following]):
            continue
        try:
            rest = find_route(road_map, following, route.goal)
        except NoRoute:
            continue
        found.append((sum(road_map.lanes[name].length for name in rest.lanes), (lane, following, *rest.lanes)))
    steps = min(found)[1] if found else lanes_along(road_map, None, lane, AWAY, 0.0)
    return route_along(road_map, _chained(road_map, steps))


def _chained(road_map: RoadMap, steps: tuple[str, ...]) -> tuple[str, ...]:
    """The lanes with those put in between from which one changes: a route names only the lane by which each segment is left."""
    chain = [steps[0]]
    for name in steps[1:]:
        ahead = road_map.lanes[chain[-1]].successors
        if name == chain[-1]:
            continue
        if name not in ahead and name not in side_by_side(road_map.lanes, chain[-1]):
            chain += [between for between in ahead if name in side_by_side(road_map.lanes, between)][:1]
        chain.append(name)
    return tuple(chain)
