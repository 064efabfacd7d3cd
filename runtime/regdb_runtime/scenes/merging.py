"""Two tellers of one fact: they agree, or the reading that restricts the vehicle more is taken."""

from __future__ import annotations

from collections.abc import Mapping

from regdb.vocabulary import Value

PERMISSIVE: frozenset[str] = frozenset((
    "director.signals_go", "fire_hose.protected", "grounds.traffic_permitted", "oncoming.clear_for_passing", "divider.opening",
    "rail.signal_device", "road.shoulder_usable", "road.slow_passing_ok", "school.grounds_fenced", "school_bus.opposite_divided",
    "sign.designated_this_lane", "sign.left_kerb_stopping", "sign.offcenter_lane", "sign.parking_otherwise", "sign.rail_exempt",
    "stationary_hazard_vehicle.behind_barrier", "transit_stop.safety_zone", "turnout.here", "park.road_excepted",
    "hydrant.shorter_distance_kept", "safety_zone.other_length_marked", "crosswalk.other_distance_marked", "lane.designated_for_turn",
))  # fmt: skip
"""Facts whose truth frees the vehicle from something; of all others it is truth that binds."""
LEAST: frozenset[str] = frozenset(("posted.speed", "posted.advisory_speed", "posted.truck_speed", "posted.weight"))
"""Numbers of which the smaller one binds, besides every distance to something."""


def stricter(fact: str, one: Value, other: Value) -> Value:
    """Of two values for a fact, the one that restricts more; of words that differ, the one that is not `none`, else the first."""
    if one == other:
        return one
    if isinstance(one, bool) and isinstance(other, bool):
        return (one and other) if fact in PERMISSIVE else (one or other)
    if isinstance(one, (int, float)) and isinstance(other, (int, float)):
        return min(one, other) if fact in LEAST or fact.endswith("distance") else one
    if isinstance(one, str) and isinstance(other, str):
        return other if one == "none" else one
    return one


def merge(facts: dict[str, Value], more: Mapping[str, Value]) -> None:
    """Add facts of another teller to what is known, in place."""
    for name, value in more.items():
        known = facts.get(name)
        facts[name] = value if known is None else stricter(name, known, value)
