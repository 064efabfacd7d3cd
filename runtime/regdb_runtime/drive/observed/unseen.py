"""What a recording cannot tell: facts that are unknown of its drivers, however quiet the street looks in it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from regdb.interpretation import Interpretation
from regdb.vocabulary import Value, Vocabulary
from regdb_runtime.maps.recorded_traffic import RecordedTraffic
from regdb_runtime.observation import Footprint
from regdb_runtime.scenes.settings import EgoFacts, passenger_car

OF_KIND: Mapping[str, tuple[str, ...]] = {
    "pedestrian": ("pedestrian.", "vehicle_stopped_at_crosswalk"), "bicycle": ("bicycle.",), "motorcycle": ("motorcycle.",), "animal": ("animal.",),
}  # fmt: skip
"""Road users whom a recording without any of their kind may simply not record, and the facts about them."""
BY_LIGHTS = ("stationary_hazard_vehicle.", "emergency_vehicle.")
"""Roles told by warning lights, where none are recorded."""
BY_SIGNALS = ("ego.turn_signal", "ego.signalled_distance", "ego.signalled_time", "lead.turning_left")
"""Facts of turn signals, where none are recorded."""
YIELDED = frozenset(("oncoming.turning_across",))
"""Known where it is false; where it is true the law asks whether the other had yielded and signalled, which the recording does not tell."""
BEYOND_LANES = frozenset(("plan.leaves_roadway",))
"""Measured, and left unknown where found true: such maps do not say what lies beyond their outermost lanes."""
STRADDLES = frozenset(("plan.straddles_lanes",))
"""Likewise while it may belong to a change of lane that the recording shows only in part."""
SHAPE = frozenset((
    "lane.turns", "lane.turn_marked", "lane.designated_for_turn", "road.types", "road.two_way", "road.one_way", "road.lanes",
    "road.lanes_same_direction", "road.divided", "ego.lane_position", "sign.speed_limit",
))  # fmt: skip
"""What a map's lanes show themselves, or leave open: their arrows and limits, and the half of the road that is missing, no script says."""
BY_VIEW = frozenset(("plan.lacks_due_care", "speed.unsafe_for_conditions"))
"""Judgements on how far the driver saw a clear road."""
MAKE = frozenset((
    "ego.length", "ego.width", "ego.axles", "ego.gross_rating", "ego.gross_weight", "ego.unladen_weight", "ego.height", "ego.vehicle_class",
    "ego.towing", "ego.towed_vehicles", "ego.towed_weight", "ego.oversize", "ego.trailer_sways",
))  # fmt: skip
"""What is known of a recorded car: it is one, and no longer than its rectangle. Of other vehicles the rectangle alone is."""


def unseen_facts(vocabulary: Vocabulary, traffic: RecordedTraffic, *, scripted: bool) -> frozenset[str]:
    """Facts that nothing may be said of. With a scripted eye only what the drivers signalled: a script speaks of the street, not of them."""
    starts: tuple[str, ...] = ()
    if not any(item.turn_signals for item in traffic.obstacles):
        starts += BY_SIGNALS
    if not scripted:
        recorded = {item.kind for item in traffic.obstacles}
        starts += tuple(start for kind, facts in OF_KIND.items() if kind not in recorded for start in facts)
        if not any(item.warning_lights for item in traffic.obstacles):
            starts += BY_LIGHTS
    found = frozenset(fact.name for fact in vocabulary if fact.name.startswith(starts)) if starts else frozenset()
    return found if scripted else found | BY_VIEW


def recorded_vehicle(vocabulary: Vocabulary, footprint: Footprint, kind: str, *, scripted: bool) -> EgoFacts:
    """What is known of a recorded vehicle itself."""
    whole = passenger_car(vocabulary, footprint).facts
    if scripted and kind == "car":
        return EgoFacts(whole)
    known = MAKE if kind == "car" else {"ego.length", "ego.width"}
    found: dict[str, Value] = {name: value for name, value in whole.items() if name in known}
    return EgoFacts(found)


def without(profile: Interpretation, unseen: frozenset[str]) -> Interpretation:
    """The interpretation, leaving open what cannot be measured here."""
    return replace(profile, decisions={name: item for name, item in profile.decisions.items() if name not in unseen})
