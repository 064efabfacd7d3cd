"""Interpretations: how a runtime decides facts for which the law has no number, by named formulas with parameters; never law."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

UNSAFE, SAFE = "unsafe", "safe"
"""What a formula finds: its quantity falls short of what is required, or does not."""


@dataclass(frozen=True, slots=True)
class Formula:
    """A formula by name: its parameters and the quantities it measures, each with its dimension, and where it is published."""

    name: str
    meaning: str
    parameters: Mapping[str, str]
    measures: Mapping[str, str]
    source: str = ""


RSS_SOURCE = "Shalev-Shwartz, Shammah, Shashua: On a Formal Model of Safe and Scalable Self-driving Cars, arXiv:1708.06374 (2017)"
_RSS = {"response_time": "duration", "max_acceleration": "acceleration", "min_braking": "acceleration"}

FORMULAS: Mapping[str, Formula] = MappingProxyType(
    {
        item.name: item
        for item in (
            Formula(
                "rss_longitudinal", "The gap is less than the safe distance behind a vehicle that goes the same way.",
                {**_RSS, "max_braking": "acceleration"}, {"rear_speed": "speed", "front_speed": "speed", "gap": "length"},
                f"{RSS_SOURCE}, definition 1",
            ),
            Formula(
                "rss_opposite", "The gap is less than the safe distance between vehicles that come towards each other.",
                {**_RSS, "min_braking_correct": "acceleration"}, {"own_speed": "speed", "other_speed": "speed", "gap": "length"},
                f"{RSS_SOURCE}, definition 2",
            ),
            Formula(
                "rss_yield", "The other could not respond and stop, braking as hard as must be expected, before the place where paths meet.",
                _RSS, {"other_speed": "speed", "other_distance": "length"}, f"{RSS_SOURCE}, definition 1 with a standing object",
            ),
            Formula(
                "rss_lateral", "The gap to the side is less than the safe lateral distance; speeds to the right are positive.",
                {"response_time": "duration", "max_lateral_acceleration": "acceleration", "min_lateral_braking": "acceleration",
                 "fluctuation_margin": "length"},
                {"left_lateral_speed": "speed", "right_lateral_speed": "speed", "lateral_gap": "length"}, f"{RSS_SOURCE}, definition 6",
            ),
            Formula(
                "time_gap", "The gap is driven in less than the least time at the speed of the vehicle behind.",
                {"least_time": "duration"}, {"rear_speed": "speed", "gap": "length"},
            ),
            Formula(
                "arrival_gap", "The other arrives at the place where paths meet in less than the least time.",
                {"least_time": "duration"}, {"other_speed": "speed", "other_distance": "length"},
            ),
            Formula(
                "stop_in_sight", "Responding and braking to a stop takes more than the road that can be seen to be clear.",
                {"response_time": "duration", "min_braking": "acceleration"}, {"speed": "speed", "sight_distance": "length"},
            ),
            Formula(
                "clearance", "The space to the side is less than the least clearance; enough of it says nothing above the speed it is meant for.",
                {"least_clearance": "length", "up_to_speed": "speed"}, {"speed": "speed", "lateral_gap": "length"},
            ),
        )
    }
)  # fmt: skip
"""Every formula a profile may name. Adding one takes an entry here and its arithmetic in the runtime's `formulas`."""


@dataclass(frozen=True, slots=True)
class Parameter:
    """A number of a profile: as written with its unit, and in SI."""

    text: str
    si: float


@dataclass(frozen=True, slots=True)
class Decision:
    """How one fact is decided. An empty `formula` never decides it; `true_when` says which finding makes the fact true."""

    fact: str
    formula: str = ""
    parameters: Mapping[str, Parameter] = field(default_factory=dict)
    true_when: str = UNSAFE
    because: str = ""
    source: str = ""


@dataclass(frozen=True, slots=True)
class Interpretation:
    """A named profile: what it is drawn from, and how it decides each fact it speaks of."""

    name: str
    title: str
    meaning: str = ""
    source_url: str = ""
    source_also: tuple[str, ...] = ()
    checked: str = ""
    confidence: str = ""
    note: str = ""
    decisions: Mapping[str, Decision] = field(default_factory=dict)

    def __iter__(self) -> Iterator[Decision]:
        return iter(self.decisions.values())

    def decision(self, fact: str) -> Decision:
        """How a fact is decided; of one that the profile is silent about, not at all."""
        return self.decisions.get(fact) or Decision(fact, because=f"{self.name} says nothing of it")
