"""Who tells which fact: map, lanes, junctions, lights, road users, clock, history, the vehicle, the plan; of perception the eye tells the rest."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from types import MappingProxyType

from regdb.situation import quiet_facts
from regdb.vocabulary import Value, Vocabulary

LIGHT_FACTS: frozenset[str] = frozenset((
    "signal.color", "signal.shape", "signal.flashing", "signal.inoperative", "signal.yields_on_arrow", "signal.green_arrow_elsewhere",
))  # fmt: skip
"""Colours and shapes are in `Observation.signals`; which of them governs depends on the planned movement."""

MAP_FACTS: frozenset[str] = frozenset((
    "sign.speed_limit", "posted.speed", "sign.stop", "sign.yield", "sign.all_way", "stop_line.present",
))  # fmt: skip
"""A lane's posted limit, a stop line's signs and the line itself stand on the map; a vehicle that only saw them would know them too late."""

TRACK_FACTS: frozenset[str] = frozenset((
    "animal.ahead",
    "approaching_vehicle.controlled", "approaching_vehicle.distance",
    "bicycle.ahead", "bicycle.in_bicycle_lane", "bicycle.present",
    "cross_traffic.arrived_together", "cross_traffic.hazard", "cross_traffic.in_intersection", "cross_traffic.on_right",
    "ego.followers_queued", "ego.left_of_slower_traffic",
    "emergency_vehicle.ahead_responding", "emergency_vehicle.approaching", "emergency_vehicle.distance", "emergency_vehicle.present",
    "follower.present", "intersection.exit_blocked",
    "lane.same_direction_available", "lead.distance", "lead.present", "lead.speed", "lead.turning_left",
    "motorcycle.lane_shared", "motorcycle.present", "movement.hazard", "obstruction.ahead",
    "oncoming.clear_for_passing", "oncoming.distance", "oncoming.distance_at_return", "oncoming.hazard", "oncoming.meeting",
    "oncoming.turning_across", "oncoming.within_100_ft", "other.may_be_affected", "parked_vehicle.present",
    "pedestrian.in_crosswalk", "pedestrian.near_roadway", "pedestrian.on_roadway", "pedestrian.on_sidewalk", "pedestrian.present",
    "rail.exit_blocked", "road.passing_unsafe",
    "stationary_hazard_vehicle.beside", "stationary_hazard_vehicle.kind", "stationary_hazard_vehicle.lights",
    "target_lane.hazard", "vehicle_stopped_at_crosswalk",
))  # fmt: skip
"""Roles: an object's place, speed and kind, measured against the candidate's path, answer them, so they are told for each candidate."""

JUDGED_FACTS: frozenset[str] = frozenset((
    "bicycle.endangered_by_pass", "lead.following_unsafe", "speed.unsafe_for_conditions",
))  # fmt: skip
"""What a court would weigh; the interpretation in use turns it into bounds on measured quantities, nobody sees it."""


LANE_FACTS: frozenset[str] = frozenset((
    "bicycle_lane.beside_turn", "bicycle_lane.present", "bus_lane.present", "ego.lane_from_right", "ego.lane_position", "hov_lane.present",
    "lane.center_marking", "lane.crossed_marking", "lane.designated_for_turn", "lane.kind", "lane.turn_marked", "lane.width",
    "road.lanes", "road.lanes_same_direction", "road.one_way", "road.slow_passing_ok", "road.two_way", "road.types", "road.width",
    "target_lane.kind",
))  # fmt: skip
"""Worked out from the lanes' shapes, kinds, markings and neighbours; what the map says of a lane in its own facts stands before it."""

JUNCTION_FACTS: frozenset[str] = frozenset((
    "crosswalk.marked", "crosswalk.present", "ego.in_intersection", "intersection.control", "intersection.crossing_highway_terminates",
    "intersection.distance", "intersection.highway_terminates", "intersection.present", "plan.destination_one_way",
    "rail.crossing_ahead", "rail.distance", "signal.place", "signal.present",
))  # fmt: skip
"""Where the path meets junctions, crosswalks and rails, and what the map says controls them."""

MOTION_FACTS: frozenset[str] = frozenset(("ego.speed", "ego.turn_signal"))
"""The vehicle's speed now, and the signal the candidate gives."""

UNTOLD: Mapping[str, str] = MappingProxyType({
    "ego.cruising_notice": "papers that officers hand over do not reach the planner",
    "lead.no_room_to_enter": "how much room another needs to enter is a judgement, and no interpretation decides it yet",
    "emergency_geofence.age": "no operator's message reaches the planner; without one there is no age",
})  # fmt: skip
"""Facts that nobody tells, and why; they are unknown, or what the vocabulary assumes of them."""

_TOLD: Mapping[str, frozenset[str]] = MappingProxyType({
    "light": LIGHT_FACTS, "posted": MAP_FACTS, "track": TRACK_FACTS, "judged": JUDGED_FACTS, "lane": LANE_FACTS, "junction": JUNCTION_FACTS,
    "motion": MOTION_FACTS, "nobody": frozenset(UNTOLD),
})  # fmt: skip
_OWN = MappingProxyType({"ego": "ego", "map": "map", "perception": "eye", "clock": "clock", "plan": "plan", "history": "history"})


@lru_cache(maxsize=8)
def tellers(vocabulary: Vocabulary) -> Mapping[str, str]:
    """Fact -> its one teller: `light`, `posted` (limit and signs on the map), `track`, `judged`, `lane`, `junction`, `motion`,
    `nobody`, else by the fact's source `map` (its own words: lanes, zones, the whole map), `ego`, `eye`, `clock`, `history`, `plan` (measured)."""
    found = {fact.name: _OWN[fact.source] for fact in vocabulary}
    found.update({name: teller for teller, names in _TOLD.items() for name in names if name in found})
    return MappingProxyType(found)


@lru_cache(maxsize=8)
def surveyed_facts(vocabulary: Vocabulary) -> Mapping[str, Value]:
    """What a map that was surveyed for everything the law asks of maps may say everywhere: the quiet value of each such fact. Lanes, zones
    and junctions say otherwise where it is otherwise."""
    asked = tellers(vocabulary)
    wanted = {"map", "lane", "junction", "posted"}
    return MappingProxyType({name: value for name, value in quiet_facts(vocabulary).items() if asked[name] in wanted and name not in _FROM_SHAPE})


_FROM_SHAPE = frozenset(("lane.width", "road.width", "posted.speed", "intersection.distance", "rail.distance"))
"""Measured or read off where they are; no value of them may be taken for granted."""


@lru_cache(maxsize=8)
def eye_facts(vocabulary: Vocabulary) -> frozenset[str]:
    """The facts of perception that only something that looks and reads can tell: signs, work zones, people who direct traffic, school buses
    and their signals, children on their way to school, kerb paint, weather, surface and sight. A fact new to the vocabulary is among them
    until it is told otherwise, so that it stays unknown rather than assumed."""
    told = LIGHT_FACTS | MAP_FACTS | TRACK_FACTS | JUDGED_FACTS | UNTOLD.keys()
    return frozenset(fact.name for fact in vocabulary if fact.source == "perception" and fact.name not in told)
