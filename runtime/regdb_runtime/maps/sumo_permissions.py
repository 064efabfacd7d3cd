"""Who may use a SUMO lane and change from it, and what kind of lane that makes it."""

from __future__ import annotations

from collections.abc import Mapping

from regdb_runtime.maps.xml_source import XmlNode

USERS: Mapping[str, str] = {
    "passenger": "car", "private": "car", "hov": "car", "evehicle": "car", "taxi": "taxi", "truck": "truck", "trailer": "truck",
    "delivery": "truck", "bus": "bus", "coach": "bus", "motorcycle": "motorcycle", "moped": "motorcycle", "bicycle": "bicycle",
    "pedestrian": "pedestrian", "wheelchair": "pedestrian", "scooter": "bicycle", "emergency": "priority_vehicle",
    "authority": "priority_vehicle", "army": "priority_vehicle", "vip": "priority_vehicle", "tram": "train", "rail_urban": "train",
    "rail": "train", "rail_electric": "train", "rail_fast": "train", "subway": "train",
}  # fmt: skip
"""SUMO's vehicle classes in the map's words; a lane is a car's when passenger cars may use it."""
EXCLUSIVE: tuple[tuple[frozenset[str], str], ...] = (
    (frozenset(("pedestrian",)), "sidewalk"),
    (frozenset(("bicycle", "pedestrian")), "bicycle_lane"),
    (frozenset(("train",)), "rail"),
    (frozenset(("bus", "taxi", "priority_vehicle", "bicycle", "train")), "bus_lane"),
)
"""A lane whose users are all among the first is of the kind of the second; the first that fits."""


def permitted(node: XmlNode) -> frozenset[str]:
    """Users of a lane by its `allow` or `disallow`; without either, everyone but pedestrians (SUMO keeps those off the road), with `vehicle`."""
    allow, disallow = node.element.get("allow"), node.element.get("disallow")
    if allow is not None and allow.split() != ["all"]:
        return frozenset(USERS[name] for name in allow.split() if name in USERS and name not in ("private", "hov", "evehicle"))
    barred = set() if disallow is None else set(disallow.split())
    if "all" in barred:
        return frozenset()
    users = {user for name, user in USERS.items() if name not in barred and user not in ("pedestrian", "train")}
    if "passenger" in barred:
        users.discard("car")
    return frozenset(users)


def may_change(node: XmlNode, attribute: str) -> bool:
    """Whether passenger cars may change lanes this way (`changeLeft`, `changeRight`); yes without the attribute."""
    allowed = node.element.get(attribute)
    return allowed is None or bool({"passenger", "all"} & set(allowed.split()))


def kinds_of(node: XmlNode, *, internal: bool) -> frozenset[str]:
    """The lane's kinds: by who alone may use it, and `intersection` within a junction."""
    users = permitted(node)
    kinds = {kind for among, kind in EXCLUSIVE if users and users <= among}
    first = next((kind for among, kind in EXCLUSIVE if kind in kinds), None)
    return frozenset(filter(None, (first, "intersection" if internal else None, "restricted" if not users else None)))
