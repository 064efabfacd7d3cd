"""A camera frame of what surrounds the ego, with the truth about every thing in it."""

from __future__ import annotations

import io
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from regdb.units import from_si
from regdb.vocabulary import Value, Vocabulary
from regdb_runtime.maps.road_map import Light, RoadMap, Sign
from regdb_runtime.observation import Indication, Observation, Track
from regdb_runtime.perception.describer import Frame
from regdb_runtime.perception.render.camera import Camera, CameraSettings
from regdb_runtime.perception.render.canvas import Canvas
from regdb_runtime.perception.render.figures import draw_road_user
from regdb_runtime.perception.render.furniture import draw_light, draw_sign
from regdb_runtime.perception.render.roadside import Roadside, draw_roadside, roadside
from regdb_runtime.perception.render.sign_faces import face_of
from regdb_runtime.perception.render.street import FARTHEST, Ground

QUALITY = 88
"""JPEG quality of frames."""


@dataclass(frozen=True, slots=True)
class Truth:
    """One thing in a frame: what it is (`sign R10-11`, `light`, `car`, `bicycle` …), its id, the fact it shows and that fact's value, its box in
    pixels (left, top, right, bottom), its distance in metres, and the share of it that something nearer hides."""

    kind: str
    id: str
    fact: str
    value: Value | None
    box: tuple[float, float, float, float]
    distance: float
    hidden: float

    @property
    def area(self) -> float:
        """Pixels of the box."""
        left, top, right, bottom = self.box
        return (right - left) * (bottom - top)


@dataclass(frozen=True)
class PlacedSign:
    """A sign to draw: MUTCD code, the number it shows, where it stands, and the heading of the traffic it faces (radians)."""

    id: str
    code: str
    number: str
    place: tuple[float, float]
    heading: float


@dataclass(frozen=True, eq=False)
class Rendering:
    """A frame as drawn: the picture (a Pillow image) and the truth about it, nearest things first."""

    image: Any
    truths: tuple[Truth, ...] = field(default=())

    def to_frame(self, name: str, captured: float) -> Frame:
        """As JPEG, for a describer."""
        stream = io.BytesIO()
        self.image.save(stream, "JPEG", quality=QUALITY)
        return Frame(name, captured, stream.getvalue(), "image/jpeg", *self.image.size)


_FACT_OF_TRACK: Mapping[str, str] = {"bicycle": "bicycle.present", "pedestrian": "pedestrian.present", "motorcycle": "motorcycle.present"}


class Renderer:
    """Draws frames of one map. Raises MissingExtra without Pillow."""

    def __init__(self, road_map: RoadMap, vocabulary: Vocabulary, settings: CameraSettings | None = None) -> None:
        self._map, self._settings = road_map, settings or CameraSettings()
        self._headings = _light_headings(road_map)
        self._fact_of = _facts_by_code(vocabulary)
        self._ground = Ground(road_map)
        self._beside = [_beside(item) for item in roadside(road_map)]
        self._signs = tuple(_placed(road_map, sign) for sign in road_map.signs.values() if sign.position is not None and face_of(sign.code))

    def render(self, observation: Observation, further: Sequence[PlacedSign] = ()) -> Rendering:
        """The view of the ego's camera; `further` signs stand where the map knows of none."""
        camera = Camera(self._settings, observation.ego)
        canvas = Canvas(camera)
        self._ground.draw(canvas)
        things = [*self._beside, *self._light_things(observation), *map(self._sign_thing, (*self._signs, *further))]
        things += map(_track_thing, observation.tracks)
        ahead = [(camera.depth(np.array([*thing.place, 1.0])), thing) for thing in things]
        drawn = sorted(((depth, thing) for depth, thing in ahead if 1.0 < depth < FARTHEST), key=lambda item: (-item[0], item[1].id))
        for number, (_, thing) in enumerate(drawn, 1):
            canvas.owner = number if thing.kind else -1
            thing.draw(canvas)
        truths = []
        for number, (depth, thing) in enumerate(drawn, 1):
            extent = canvas.extent(number)
            if extent is not None:
                truths.append(Truth(thing.kind, thing.id, thing.fact, thing.value, extent.box, depth, extent.hidden))
        return Rendering(canvas.image, tuple(reversed(truths)))

    def _light_things(self, observation: Observation) -> list[_Thing]:
        found = []
        for light in self._map.lights.values():
            if light.position is not None and light.id in self._headings:
                shown = observation.signals.get(light.id, ())
                found.append(self._light_thing(light, self._headings[light.id], shown, observation.ego.heading))
        return found

    def _light_thing(self, light: Light, heading: float, shown: tuple[Indication, ...], ego_heading: float) -> _Thing:
        faces_ego = math.cos(heading - ego_heading) > 0.5
        value = shown[0].color if shown and faces_ego else None
        assert light.position is not None

        def draw(canvas: Canvas) -> None:
            if faces_ego:
                draw_light(canvas, light, heading, shown)

        return _Thing("light", light.id, "signal.color", value, light.position, draw)

    def _sign_thing(self, sign: PlacedSign) -> _Thing:
        fact = next((self._fact_of[code] for code in _shorter(sign.code) if code in self._fact_of), "")

        def draw(canvas: Canvas) -> None:
            draw_sign(canvas, sign.code, sign.number, sign.place, sign.heading)

        return _Thing(f"sign {sign.code}", sign.id, fact, True if fact else None, sign.place, draw)


@dataclass(frozen=True, eq=False)
class _Thing:
    """Something to draw, and what is true of it."""

    kind: str
    id: str
    fact: str
    value: Value | None
    place: tuple[float, float]
    draw: Callable[[Canvas], None]


def _beside(item: Roadside) -> _Thing:
    """Scenery: of no kind, so no truth tells of it."""
    return _Thing("", f"roadside {item.x:.1f} {item.y:.1f}", "", None, (item.x, item.y), lambda canvas: draw_roadside(canvas, item))


def _track_thing(track: Track) -> _Thing:
    fact = _FACT_OF_TRACK.get(track.kind, "")
    return _Thing(track.kind, track.id, fact, True if fact else None, (track.x, track.y), lambda canvas: draw_road_user(canvas, track))


def _shorter(code: str) -> list[str]:
    return [code[:end] for end in range(len(code), 1, -1)]


def _facts_by_code(vocabulary: Vocabulary) -> dict[str, str]:
    """MUTCD code -> the fact that such a sign is there; where several facts name one code, the boolean of signs comes first."""
    found: dict[str, str] = {}
    for fact in sorted(vocabulary, key=lambda item: (not item.name.startswith("sign."), item.kind != "boolean", item.name)):
        for code in fact.codes.get("mutcd", "").split():
            found.setdefault(code, fact.name)
    return found


def _placed(road_map: RoadMap, sign: Sign) -> PlacedSign:
    """A sign of the map faces the traffic of the lanes it is bound to, at the place nearest to it."""
    assert sign.position is not None
    lanes = [lane for lane in road_map.lanes.values() if sign.id in lane.signs or (lane.stop_line is not None and sign.id in lane.stop_line.signs)]
    heading = 0.0
    if lanes:
        points = np.concatenate([lane.center for lane in lanes])
        headings = np.concatenate([_headings(lane.center) for lane in lanes])
        heading = float(headings[np.argmin(np.hypot(*(points - np.array(sign.position)).T))])
    number = f"{float(from_si(sign.speed, 'mph')):.0f}" if sign.speed is not None else (sign.values[0] if sign.values else "")
    return PlacedSign(sign.id, sign.code, number, sign.position, heading)


def _headings(line: Any) -> Any:
    steps = np.diff(line, axis=0)
    found = np.arctan2(steps[:, 1], steps[:, 0])
    return np.concatenate((found, found[-1:]))


def _light_headings(road_map: RoadMap) -> dict[str, float]:
    """Light -> the heading of the traffic it speaks to, where its lanes begin to cross."""
    found: dict[str, float] = {}
    for lane in road_map.lanes.values():
        step = lane.center[1] - lane.center[0] if lane.junction is not None else lane.center[-1] - lane.center[-2]
        for name in lane.lights:
            found.setdefault(name, math.atan2(step[1], step[0]))
    return found
