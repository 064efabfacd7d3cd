"""Who tells which fact of perception: tracked objects, lights and the map tell some, an interpretation judges some, only the eye tells the rest."""

from __future__ import annotations

from functools import lru_cache

from regdb.vocabulary import Vocabulary

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
    "lane.same_direction_available", "lead.distance", "lead.no_room_to_enter", "lead.present", "lead.speed", "lead.turning_left",
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


@lru_cache(maxsize=8)
def eye_facts(vocabulary: Vocabulary) -> frozenset[str]:
    """The facts of perception that only something that looks and reads can tell: signs, work zones, people who direct traffic, school buses
    and their signals, children on their way to school, kerb paint, weather, surface and sight. A fact new to the vocabulary is among them
    until it is told otherwise, so that it stays unknown rather than assumed."""
    told = LIGHT_FACTS | MAP_FACTS | TRACK_FACTS | JUDGED_FACTS
    return frozenset(fact.name for fact in vocabulary if fact.source == "perception" and fact.name not in told)
