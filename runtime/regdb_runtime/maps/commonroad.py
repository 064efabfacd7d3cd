"""Reads CommonRoad XML, versions 2018b and 2020a, into a road map; see docs/reference/maps.md for what is taken over."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np

from regdb_runtime.maps.commonroad_junctions import place_junctions
from regdb_runtime.maps.commonroad_lanes import read_lanelets
from regdb_runtime.maps.commonroad_signs import read_lights, read_signs
from regdb_runtime.maps.junctions import derive_junctions
from regdb_runtime.maps.road_map import Crosswalk, Floats, Lane, Light, RoadMap, Sign, StopLine
from regdb_runtime.maps.xml_source import XmlNode, open_xml

VERSIONS = ("2018b", "2020a")
READ = frozenset(
    ("location", "scenarioTags", "lanelet", "trafficSign", "trafficLight", "intersection", "obstacle", "staticObstacle", "dynamicObstacle",
     "planningProblem")
)  # fmt: skip


def read_commonroad(path: str | Path) -> RoadMap:
    """The road map of a CommonRoad file. MapError where the file cannot be read or contradicts itself."""
    return road_map_of(open_scenario(path))


def open_scenario(path: str | Path) -> XmlNode:
    """The root of a CommonRoad file of a version this reader knows."""
    root = open_xml(path, "commonRoad")
    version = root.attribute("commonRoadVersion")
    if version not in VERSIONS:
        raise root.fail(f"is of version {version}, this reader knows {' and '.join(VERSIONS)}")
    return root


def road_map_of(root: XmlNode) -> RoadMap:
    """The road map in an opened file."""
    notes = [f"<{tag}> is not read" for tag in sorted({child.tag for child in root} - READ)]
    posts = read_signs(root, notes)
    lights = read_lights(root, root.number_of("timeStepSize"), notes)
    lanes = {name: _with_signs(root, lane, posts, lights, notes) for name, lane in read_lanelets(root, notes).items()}
    if root.find("intersection") is not None:
        lanes, junctions = place_junctions(root, lanes, {sign.id: sign for plates in posts.values() for sign in plates}, notes)
    else:
        lanes, junctions = derive_junctions(lanes)
        if junctions:
            notes.append("the file names no intersections; they and their turns are derived from the lanes' geometry, their control is unknown")
    return RoadMap(
        lanes=lanes,
        lights=lights,
        signs={sign.id: sign for plates in posts.values() for sign in plates},
        crosswalks=tuple(Crosswalk(lane.id, _outline(lane)) for lane in lanes.values() if "crosswalk" in lane.kinds),
        origin=_origin(root, notes),
        source=root.file,
        junctions=junctions,
        notes=tuple(notes),
    )


def _with_signs(root: XmlNode, lane: Lane, posts: Mapping[str, tuple[Sign, ...]], lights: Mapping[str, Light], notes: list[str]) -> Lane:
    """The lane with its posts' plates, and the least speed they print as its limit."""
    for kind, references, known in (("sign", lane.signs, posts), ("light", lane.lights, lights)):
        for ref in references:
            if ref not in known:
                raise root.fail(f"has lanelet {lane.id}, which names {kind} {ref}, which the file does not define")
    plates = [sign for ref in lane.signs for sign in posts[ref]]
    speeds = [sign.speed for sign in plates if sign.speed is not None]
    if lane.speed_limit is not None:
        speeds.append(lane.speed_limit)
    return replace(
        lane,
        signs=tuple(sign.id for sign in plates),
        speed_limit=min(speeds, default=None),
        stop_line=_known_references(lane, posts, lights, notes),
    )


def _known_references(lane: Lane, posts: Mapping[str, tuple[Sign, ...]], lights: Mapping[str, Light], notes: list[str]) -> StopLine | None:
    """The stop line without references that lead nowhere: by the format they repeat those of the lane, which are checked."""
    line = lane.stop_line
    if line is None:
        return None
    for kind, references, known in (("sign", line.signs, posts), ("light", line.lights, lights)):
        notes.extend(f"{line.id} names {kind} {ref}, which the file does not define; left out" for ref in references if ref not in known)
    signs = tuple(sign.id for ref in line.signs if ref in posts for sign in posts[ref])
    return replace(line, signs=signs, lights=tuple(ref for ref in line.lights if ref in lights))


def _outline(lane: Lane) -> Floats:
    return np.vstack((lane.left_line, lane.right_line[::-1]))


def _origin(root: XmlNode, notes: list[str]) -> tuple[float, float] | None:
    """Longitude and latitude of the map's place; the format writes 999 for unknown."""
    location = root.find("location")
    if location is None:
        return None
    latitude, longitude = location.find("gpsLatitude"), location.find("gpsLongitude")
    if latitude is None or longitude is None:
        return None
    transformation = location.find("geoTransformation")
    if transformation is not None:
        notes.append(f"<geoTransformation> ({' '.join(''.join(transformation.element.itertext()).split())}) is not applied to the origin")
    place = longitude.number(), latitude.number()
    return place if abs(place[0]) <= 180 and abs(place[1]) <= 90 else None
