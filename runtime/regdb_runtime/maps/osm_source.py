"""The OSM XML of a Lanelet2 map: nodes in metres, ways as lines of nodes, relations with their members, all by id."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from regdb_runtime.errors import MapError
from regdb_runtime.maps.mercator import LocalMercator
from regdb_runtime.maps.road_map import Floats
from regdb_runtime.maps.xml_source import XmlNode, open_xml

Tags = Mapping[str, str]


@dataclass(frozen=True)
class Way:
    """A line: its nodes' ids in order, and what the map says of it."""

    id: str
    nodes: tuple[str, ...]
    tags: Tags


@dataclass(frozen=True)
class Relation:
    """Members as (type, ref, role), and what the map says of it."""

    id: str
    members: tuple[tuple[str, str, str], ...]
    tags: Tags

    def refs(self, role: str, kind: str | None = None) -> tuple[str, ...]:
        """Ids of the members of a role, of one type of element where given."""
        return tuple(ref for type_, ref, name in self.members if name == role and kind in (None, type_))


@dataclass(frozen=True)
class OsmMap:
    """Everything in the file. `places`: (x, y) of every node in metres; `origin`: longitude and latitude of (0, 0), where known."""

    file: str
    places: Mapping[str, tuple[float, float]]
    node_tags: Mapping[str, Tags]
    ways: Mapping[str, Way]
    relations: Mapping[str, Relation]
    origin: tuple[float, float] | None
    notes: tuple[str, ...]

    def line(self, way: str) -> Floats:
        """The points of a way (n, 2)."""
        return np.array([self.places[node] for node in self.ways[way].nodes])

    def fail(self, problem: str) -> MapError:
        """An error about this file."""
        return MapError(f"{self.file}: {problem}")


def read_osm(path: str | Path, origin: tuple[float, float] | None = None) -> OsmMap:
    """An OSM file with its nodes in metres: by their `local_x` and `local_y` where all have them, else projected about `origin` (longitude,
    latitude), by default the middle of the map."""
    root = open_xml(path, "osm")
    nodes = [node for node in root.all("node") if _is_there(node)]
    if not nodes:
        raise root.fail("holds no <node>")
    tags = {node.attribute("id"): _tags(node) for node in nodes}
    places, center, notes = _places(nodes, tags, origin)
    ways = {way.id: way for way in (_way(node, places) for node in root.all("way") if _is_there(node))}
    relations = {item.id: item for item in (_relation(node) for node in root.all("relation") if _is_there(node))}
    known: dict[str, frozenset[str]] = {"node": frozenset(places), "way": frozenset(ways), "relation": frozenset(relations)}
    for item in relations.values():
        for kind, ref, _ in item.members:
            if ref not in known.get(kind, ()):
                raise MapError(f"{root.file}: relation {item.id} names {kind} {ref}, which the file does not define")
    return OsmMap(root.file, places, {name: found for name, found in tags.items() if found}, ways, relations, center, notes)


def _is_there(node: XmlNode) -> bool:
    return node.element.get("action") != "delete" and node.element.get("visible") != "false"


def _tags(node: XmlNode) -> Tags:
    return {tag.attribute("k"): tag.attribute("v") for tag in node.all("tag")}


def _places(
    nodes: list[XmlNode], tags: Mapping[str, Tags], origin: tuple[float, float] | None
) -> tuple[dict[str, tuple[float, float]], tuple[float, float] | None, tuple[str, ...]]:
    if origin is None and all("local_x" in found and "local_y" in found for found in tags.values()):
        local = {node.attribute("id"): (_tag_number(node, "local_x"), _tag_number(node, "local_y")) for node in nodes}
        return local, None, ("nodes lie where their local_x and local_y say; their latitude and longitude are not read",)
    degrees = {node.attribute("id"): (node.number_of("lat"), node.number_of("lon")) for node in nodes}
    for node in nodes:
        latitude, longitude = degrees[node.attribute("id")]
        if abs(latitude) > 89 or abs(longitude) > 180:
            raise node.fail(f"lies at latitude {latitude:g} and longitude {longitude:g}, which is nowhere")
    if origin is None:
        both = np.array(list(degrees.values()))
        middle = (both.min(axis=0) + both.max(axis=0)) / 2
        origin = float(middle[1]), float(middle[0])
    plane = LocalMercator(origin[1], origin[0])
    return {name: plane.to_plane(*place) for name, place in degrees.items()}, origin, ()


def _tag_number(node: XmlNode, key: str) -> float:
    tag = next(tag for tag in node.all("tag") if tag.attribute("k") == key)
    return tag.number_of("v")


def _way(node: XmlNode, places: Mapping[str, tuple[float, float]]) -> Way:
    nodes = tuple(ref.attribute("ref") for ref in node.all("nd"))
    for ref in nodes:
        if ref not in places:
            raise node.fail(f"names node {ref}, which the file does not define")
    return Way(node.attribute("id"), nodes, _tags(node))


def _relation(node: XmlNode) -> Relation:
    members = tuple((m.attribute("type"), m.attribute("ref"), m.element.get("role", "")) for m in node.all("member"))
    return Relation(node.attribute("id"), members, _tags(node))
