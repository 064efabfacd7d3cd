"""The front camera of a drive in a world: frames as the ego would see them, with the truth about each."""

from __future__ import annotations

import datetime
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from regdb.vocabulary import Value, Vocabulary
from regdb_runtime.observation import Observation, Track
from regdb_runtime.perception.describer import Frame
from regdb_runtime.perception.render.camera import CameraSettings
from regdb_runtime.perception.render.frame import PlacedSign, Renderer, Rendering
from regdb_runtime.perception.render.sign_faces import face_of
from regdb_runtime.worlds.built_in.world import BuiltInWorld
from regdb_runtime.worlds.eye import Eye, read_facts
from regdb_runtime.worlds.scene_spec import SightingSpec

LEAST_AREA = 110.0
"""Pixels of a sign's box under which it cannot be read: some 10 by 11, where a legend is gone."""
SIGN_FROM_EDGE = 0.8
"""Metres from the kerb to the post (2 ft to the sign's edge, MUTCD 2A.19)."""
CHILD = 0.4
"""Length and width of a child, metres."""
MOST_HIDDEN = 0.6
"""The share of a thing beyond which what hides it makes it unrecognisable."""


@dataclass(frozen=True, eq=False)
class Shot:
    """One frame with its picture, and what is there to be told from it."""

    frame: Frame
    rendering: Rendering
    facts: Mapping[str, Value]


class FrameCamera:
    """Takes frames of a built-in (or SUMO) world. `eye`: the scripted eye that knows what is there; what is a sign must be legible in the frame.

    Signs that the scene's sightings tell of stand where those say, if the map has none there.
    """

    def __init__(self, world: BuiltInWorld, vocabulary: Vocabulary, eye: Eye, settings: CameraSettings | None = None) -> None:
        self._world, self._eye = world, eye
        self._renderer = Renderer(world.road_map, vocabulary, settings)
        codes = {fact.name: fact.codes["mutcd"].split()[0] for fact in vocabulary if fact.codes.get("mutcd")}
        self._codes = {name: code for name, code in codes.items() if face_of(code)}
        self._signs = tuple(self._told_signs(vocabulary))
        self._children = tuple(_children(world))

    def take(self) -> Shot:
        """The view now."""
        world = self._world
        time, ego = world.time, world.ego
        lights = world.signals.seen(time, ego, world.spec.lights_range)
        everybody = (*world.tracks(), *(child for child, item in self._children if item.start <= time < item.until))
        seen = Observation(time, datetime.datetime.fromisoformat(world.spec.start), ego, everybody, lights)
        rendering = self._renderer.render(seen, self._signs)
        return Shot(rendering.to_frame(f"frame-{time:.2f}", time), rendering, self._told(rendering))

    def _told(self, rendering: Rendering) -> dict[str, Value]:
        """What the scripted eye knows, less the signs that cannot be read in this frame: of those nothing can be told."""
        facts, _ = self._eye.look(self._world.time, self._world.ego)
        legible = {truth.fact for truth in rendering.truths if truth.area >= LEAST_AREA and truth.hidden <= MOST_HIDDEN}
        codes = {sign.code for sign in self._signs} | {sign.code for sign in self._world.road_map.signs.values()}
        drawn = {fact for fact, code in self._codes.items() if fact.startswith("sign.") and code in codes}
        return {name: value for name, value in facts.items() if value is not True or name not in drawn or name in legible}

    def _told_signs(self, vocabulary: Vocabulary) -> list[PlacedSign]:
        """Signs of the scene's sightings, facing the lane nearest to them."""
        found = []
        mapped = {sign.code for sign in self._world.road_map.signs.values()}
        for number, item in enumerate(self._world.spec.eye.sightings):
            for name, value in read_facts(item.facts, vocabulary, "sightings").items():
                code = self._codes.get(name)
                if value is True and code is not None and code not in mapped and item.position is not None and name.startswith("sign."):
                    place, heading = _beside_road(self._world, item.position)
                    found.append(PlacedSign(f"sighting_{number}_{name}", code, "", place, heading))
        return found


def _children(world: BuiltInWorld) -> Iterator[tuple[Track, SightingSpec]]:
    """Where the scene tells of children on their way to school they are drawn on the walk; to the sensors they are what the scene's people are."""
    for item in world.spec.eye.sightings:
        if item.facts.get("school.children_going") in (True, "true") and item.position is not None:
            for number, apart in enumerate((-34.0, -33.0, -18.0, 6.0, 7.2)):
                (x, y), heading = _beside_road(world, item.position, apart)
                yield Track(f"child_{number}", "pedestrian", x, y, heading, 1.2, CHILD, CHILD), item


def _beside_road(world: BuiltInWorld, near: tuple[float, float], along: float = 0.0) -> tuple[tuple[float, float], float]:
    """The walk beside the route's road nearest to a place and `along` metres on, and the direction of traffic there."""
    lanes = [world.road_map.lanes[name] for name in world.route if world.road_map.lanes[name].junction is None]
    lane = min(lanes, key=lambda item: float(np.hypot(*(item.center - near).T).min()))
    while lane.right is not None and lane.right_same_direction:
        lane = world.road_map.lanes[lane.right]
    station = lane.stations[np.argmin(np.hypot(*(lane.center - near).T))] + along
    index = int(np.clip(np.searchsorted(lane.stations, station), 1, len(lane.center) - 2))
    ahead = lane.center[index + 1] - lane.center[index - 1]
    edge = lane.right_line[index] + np.array([ahead[1], -ahead[0]]) / np.hypot(*ahead) * SIGN_FROM_EDGE
    return (float(edge[0]), float(edge[1])), math.atan2(ahead[1], ahead[0])
