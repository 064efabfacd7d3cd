"""What the builder of scenes is told about the vehicle and its sensors, with the distances it works by; every number has its unit and source."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from regdb.situation import quiet_facts
from regdb.vocabulary import Value, Vocabulary
from regdb_runtime.observation import Footprint
from regdb_runtime.scenes.tellers import tellers


@dataclass(frozen=True, slots=True)
class SensorRanges:
    """How far tracked objects are reported, metres. A role is told to be empty only where its place lies within the range; beyond it is unknown.

    Defaults: no more than the worlds report (`SceneSpec.sensor_range`). To find a gap in traffic at 45 mph, RSS's yielding distance asks for
    140 m of sight besides the junction's own size.
    """

    vehicles: float = 200.0
    bicycles: float = 120.0
    pedestrians: float = 120.0


@dataclass(frozen=True)
class EgoFacts:
    """What the vehicle knows of itself: facts of the teller `ego`, told on every stretch. Those left out are unknown."""

    facts: Mapping[str, Value] = field(default_factory=dict)


def passenger_car(vocabulary: Vocabulary, footprint: Footprint, **changes: Value) -> EgoFacts:
    """An ordinary car in good order with nothing special about it: the quiet value of each of its facts, and its size.

    `changes` replace values; a name's dot is written as two underscores (`ego__occupants=3.0`).
    """
    asked = tellers(vocabulary)
    facts = {name: value for name, value in quiet_facts(vocabulary).items() if asked[name] == "ego"}
    facts |= {"ego.length": footprint.length, "ego.width": footprint.width}
    facts |= {name.replace("__", "."): value for name, value in changes.items()}
    return EgoFacts(facts)


@dataclass(frozen=True, slots=True)
class SceneSettings:
    """Distances in metres, times in seconds, speeds in m/s; choices of this planner unless a source is named."""

    reach: float = 120.0
    """How far ahead of the front bumper stretches are made: more than any plan of the sampler drives."""
    approach: float = 30.5
    """An approach begins so far before the junction's entrance: 100 ft, within which CVC 21752(d), 22108 and 22352(a)(2) speak of one."""
    overshoot: float = 0.3
    """A front that stands so little past the line still stands before it."""
    standstill: float = 0.1
    """Below this speed a vehicle stands (the paper's plateau)."""
    at_line: float = 3.0
    """A stop with the front no farther than this before the line is a stop at the line, not in the queue before it."""
    at_rails: float = 15.24
    """A stop with the front no farther than this before the nearest rail is a stop before it (50 ft, CVC 22451 and 22452)."""
    together: float = 1.0
    """Two vehicles that reach the junction within this time reach it at the same time."""
    held_braking: float = 4.0
    """Who needs no more braking (m/s2) to stop before his red light or STOP sign is taken to stop there (least braking of RSS, ad-rss-lib)."""
    look_braking: float = 2.0
    look_response: float = 0.5
    """A place still too far to be seen is looked at in time if, once it is in range, this braking (m/s2, the paper drive's comfort) after this time
    stops the vehicle before the line: until then nobody is taken to be there."""
    watched: float = 60.0
    """Who arrives at a junction is noted from so far before it on."""
    beside_lane: float = 3.7
    """A lane's width (12 ft): what stands no farther from the lane's edge stands immediately beside it."""
    about_to_cross: float = 1.5
    """A pedestrian so near a crosswalk and walking towards it is about to cross."""
    affected: float = 60.0
    """Vehicles within this distance may be affected by a movement."""
    queue_gap: float = 30.0
    """Vehicles behind with smaller gaps form a line."""
    exit_margin: float = 1.0
    """Room wanted behind the vehicle beyond the junction, besides its length."""
    pass_room: float = 10.0
    """Room before and after what is passed, for the estimate of where a pass ends."""
    bus_stands: float = 0.5
    """A bus slower than this (m/s) is the stopped one of which the eye tells: trackers report small speeds of what stands."""
    before_bus: float = 1.0
    """Where the stopped school bus is beside the vehicle, or is not tracked, a plan passes it that goes farther than this."""
    border_step: float = 1.0
    """Distance of the points at which zones are looked for along a lane; borders are then found to a centimetre."""
    place: str | None = None
    """Jurisdiction where the map names none."""
    sun_at: tuple[float, float] = (-118.2437, 34.0522)
    """Longitude and latitude for the sun where the map has no origin: Los Angeles City Hall."""
    summer_time: bool = True
    """Whether a clock without a time zone keeps the daylight saving time of 15 U.S.C. 260a."""
