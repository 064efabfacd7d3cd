"""Streets to a vector map: roads, junctions, signs and zones together; a map of our own knows all that is mapped."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from regdb.situation import quiet_facts
from regdb.vocabulary import Vocabulary
from regdb_runtime.errors import WorldError
from regdb_runtime.maps.road_map import Floats, Hours, RoadMap, Sign, Turn, Zone
from regdb_runtime.scenes.tellers import surveyed_facts
from regdb_runtime.worlds.junction_builder import build_junctions
from regdb_runtime.worlds.road_spec import SignSpec, StreetsSpec, ZoneSpec
from regdb_runtime.worlds.streets import Streets, join_ends, place_on


def build_sign(streets: Streets, spec: SignSpec) -> Sign:
    """A sign at the kerb of its direction, bound to that direction's lanes."""
    side = streets.carriageway(spec.road, backward=spec.direction == "backward")
    if side is None:
        raise WorldError(f"sign {spec.id!r}: road {spec.road!r} has no {spec.direction} lanes")
    reach = side.width + 0.8
    sign = Sign(spec.id, spec.code, place_on(streets, spec.road, spec.station, reach if side.backward else -reach), spec.values, spec.speed)
    streets.signs[spec.id] = sign
    for lane in side.lanes:
        streets.lanes[lane] = replace(streets.lanes[lane], signs=(*streets.lanes[lane].signs, spec.id))
    return sign


def build_zone(streets: Streets, spec: ZoneSpec) -> Zone:
    """A zone's polygon and facts. Raises WorldError for a place that is not there."""
    polygon = np.array(spec.polygon, dtype=float) if spec.polygon else _along(streets, spec)
    if spec.distance_fact is not None and (spec.landmark is None or spec.distance_fact not in streets.vocabulary):
        raise WorldError(f"zone {spec.id!r}: {spec.distance_fact} needs a landmark and a fact of the vocabulary")
    facts = streets.read(spec.facts, f"zone {spec.id}")
    hours = tuple(Hours(start, end) for start, end in spec.hours)
    return Zone(spec.id, spec.kind, polygon, facts, spec.jurisdiction, spec.distance_fact, spec.landmark, hours)


def _along(streets: Streets, spec: ZoneSpec) -> Floats:
    sides = [streets.carriageway(spec.road, backward=backward) for backward in (False, True)]
    right, left = (0.0 if side is None else side.width for side in sides)
    stations = np.linspace(spec.start, spec.end, max(2, math.ceil((spec.end - spec.start) / 5) + 1))
    outer = [place_on(streets, spec.road, float(at), -right - spec.margin) for at in stations]
    inner = [place_on(streets, spec.road, float(at), left + spec.margin) for at in stations]
    return np.array([*outer, *reversed(inner)])


def build_road_map(spec: StreetsSpec, vocabulary: Vocabulary) -> RoadMap:
    """The map of these streets. Raises WorldError for what does not fit together.

    Its facts are the quiet value of every fact whose source is the map or that the map tells for perception (no limit is posted where no lane
    has one), so nothing mapped is unknown, and the spec's own.
    """
    streets = Streets(spec, vocabulary)
    lights, crosswalks, ends = build_junctions(streets)
    join_ends(streets, ends)
    for sign in spec.signs:
        build_sign(streets, sign)
    zones = tuple(build_zone(streets, zone) for zone in spec.zones)
    quiet = {name: value for name, value in quiet_facts(vocabulary).items() if vocabulary.facts[name].source == "map"}
    facts = quiet | dict(surveyed_facts(vocabulary)) | streets.read(spec.facts, "streets")
    return RoadMap(streets.lanes, lights, streets.signs, zones, crosswalks, None, facts, spec.jurisdiction, "built-in")


def follow_turns(road_map: RoadMap, lane: str, turns: tuple[Turn, ...], most: int = 60) -> tuple[str, ...]:
    """Lanes from `lane` on, turning at each junction as told, one for each segment; then straight on, else the first way there is.

    Where only a neighbouring lane of the same direction leads to the turn, the route goes on from that one. Raises WorldError for a turn
    that no lane here makes.
    """
    if lane not in road_map.lanes:
        raise WorldError(f"there is no lane {lane!r}")
    route, wanted = [lane], list(turns)
    while len(route) < most:
        beside = _beside(road_map, route[-1])
        onward = [(place, following) for place in beside for following in road_map.lanes[place].successors]
        inner = [item for item in onward if road_map.lanes[item[1]].junction is not None]
        if not inner:
            onward = [item for item in onward if item[0] == route[-1]] or onward
            if not onward or onward[0][1] in route:
                break
            route.append(onward[0][1])
            continue
        turn = wanted.pop(0) if wanted else None
        fitting = [item for item in inner if road_map.lanes[item[1]].turn == (turn or "straight")]
        if turn is not None and not fitting:
            offered = sorted({str(road_map.lanes[name].turn) for _, name in inner})
            raise WorldError(f"no lane beside {route[-1]!r} turns {turn}; there is: {', '.join(offered)}")
        place, following = (fitting or inner)[0]
        if following in route:
            break
        route[-1] = place
        route.append(following)
    return tuple(route)


def _beside(road_map: RoadMap, lane: str) -> list[str]:
    """The lane itself, then its neighbours of the same direction and kind, nearest first."""
    if "bicycle_lane" in road_map.lanes[lane].kinds or road_map.lanes[lane].junction is not None:
        return [lane]
    found = [lane]
    for side in ("left", "right"):
        here = road_map.lanes[lane]
        while True:
            neighbour = here.left if side == "left" else here.right
            same = here.left_same_direction if side == "left" else here.right_same_direction
            if neighbour is None or not same or "bicycle_lane" in road_map.lanes[neighbour].kinds:
                break
            found.append(neighbour)
            here = road_map.lanes[neighbour]
    return found
