"""Rendered frames: projection by its formula, truth boxes against geometry, signs that differ, hidden things, the same bytes each time."""

from __future__ import annotations

import builtins
import itertools
import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from regdb_runtime.drive.frame_camera import FrameCamera
from regdb_runtime.drive.paper_scene import PaperScene, scene_spec
from regdb_runtime.errors import MissingExtra
from regdb_runtime.observation import EgoState, Indication, Observation, Track
from regdb_runtime.perception.render.camera import Camera, CameraSettings
from regdb_runtime.perception.render.draw_sign import pillow, sign_picture
from regdb_runtime.perception.render.frame import PlacedSign, Renderer, Truth
from regdb_runtime.perception.render.sign_faces import FACES, face_of
from regdb_runtime.worlds.built_in.build import build, shipped_vocabulary
from regdb_runtime.worlds.built_in.world import BuiltInWorld
from regdb_runtime.worlds.eye import build_eye

from regdb.vocabulary import Vocabulary

SMALL = CameraSettings(960, 540)
EGO = EgoState(0.0, 0.0, 0.0, 10.0)


@pytest.fixture(scope="module")
def vocabulary() -> Vocabulary:
    return shipped_vocabulary()


@pytest.fixture(scope="module")
def world() -> BuiltInWorld:
    return build(scene_spec(PaperScene(no_turn_sign=True)))


@pytest.fixture(scope="module")
def renderer(world: BuiltInWorld, vocabulary: Vocabulary) -> Renderer:
    return Renderer(world.road_map, vocabulary, SMALL)


def seen(world: BuiltInWorld, x: float, tracks: tuple[Track, ...] = (), **signals: Any) -> Observation:
    """From the right lane of the first road, `x` metres from the junction's mouth."""
    return replace(world.observe(), ego=EgoState(x, -5.25, 0.0, 10.0), tracks=tracks, signals=signals)


def only(truths: tuple[Truth, ...], **wanted: Any) -> Truth:
    (found,) = [truth for truth in truths if all(getattr(truth, name) == value for name, value in wanted.items())]
    return found


class TestCamera:
    def test_a_point_straight_ahead_lies_on_the_middle_column_below_the_horizon(self) -> None:
        camera = Camera(replace(SMALL, pitch=0.0), EGO)
        ((x, y),) = camera.pixels(camera.seen(np.array([[1.7 + 20.0, 0.0, 0.0]])))
        assert (x, y) == (pytest.approx(480), pytest.approx(270 + camera.focal * 1.4 / 20.0))
        assert camera.horizon == 270

    def test_the_field_of_view_spans_the_width(self) -> None:
        camera = Camera(replace(SMALL, pitch=0.0), EGO)
        edge = math.tan(math.radians(35.0)) * 10.0
        pixels = camera.pixels(camera.seen(np.array([[11.7, edge, 1.4], [11.7, -edge, 1.4]])))
        assert pixels[:, 0] == pytest.approx([0.0, 960.0])

    def test_what_lies_behind_is_cut_away(self) -> None:
        camera = Camera(SMALL, EGO)
        square = np.array([[-5.0, -1.0, 0.0], [20.0, -1.0, 0.0], [20.0, 1.0, 0.0], [-5.0, 1.0, 0.0]])
        cut = camera.polygon(square)
        assert cut is not None
        assert len(cut) == 4
        assert camera.polygon(square - (40.0, 0.0, 0.0)) is None


class TestSigns:
    def test_every_face_can_be_drawn_and_no_two_look_alike(self) -> None:
        small = {code: np.asarray(sign_picture(code, "25").resize((48, 48)).convert("RGBA"), dtype=float) for code in FACES}
        for one, other in itertools.combinations(FACES, 2):
            apart = np.abs(small[one] - small[other]).mean()
            assert apart > 0.7, f"{one} and {other} look alike"

    def test_the_number_is_on_the_sign(self) -> None:
        assert sign_picture("R2-1", "25").tobytes() != sign_picture("R2-1", "35").tobytes()

    def test_variants_fall_back_on_their_family_and_unknown_codes_on_nothing(self) -> None:
        assert face_of("R10-11a") == FACES["R10-11"]
        assert face_of("Z99") is None
        assert sign_picture("Z99") is None

    def test_every_sign_of_the_vocabulary_with_a_code_can_be_drawn(self, vocabulary: Vocabulary) -> None:
        codes = {code for fact in vocabulary if fact.name.startswith("sign.") for code in fact.codes.get("mutcd", "").split()}
        assert {code for code in codes if face_of(code) is None} <= {"R4-5"}


class TestTruth:
    def test_a_sign_lies_where_it_projects(self, world: BuiltInWorld, renderer: Renderer) -> None:
        observation = seen(world, -60.0)
        found = renderer.render(observation, [PlacedSign("own", "R10-11", "", (-35.0, -9.0), 0.0)])
        truth = only(found.truths, id="own")
        camera = Camera(SMALL, observation.ego)
        face = FACES["R10-11"]
        corners = np.array([[-35.0, -9.0 + face.width / 2, 2.1 + face.height], [-35.0, -9.0 - face.width / 2, 2.1]])
        (left, top), (right, bottom) = camera.pixels(camera.seen(corners))
        assert truth.box == pytest.approx((left, top, right, bottom), abs=1.5)
        assert (truth.fact, truth.value, truth.kind) == ("sign.no_turn_on_red", True, "sign R10-11")
        assert truth.distance == pytest.approx(25.0 - 1.7, abs=0.1)

    def test_a_road_user_s_box_holds_the_corners_of_its_body(self, world: BuiltInWorld, renderer: Renderer) -> None:
        car = Track("lead", "car", -30.0, -5.25, 0.0, 8.0, 4.6, 1.8)
        observation = seen(world, -50.0, (car,))
        truth = only(renderer.render(observation).truths, id="lead")
        camera = Camera(SMALL, observation.ego)
        corners = np.array([[-30.0 - 2.3, -5.25 + b * 0.9, z] for b in (1, -1) for z in (0.28, 0.85)])
        pixels = camera.pixels(camera.seen(corners))
        left, top, right, bottom = truth.box
        assert left <= pixels[:, 0].min() + 1
        assert right >= pixels[:, 0].max() - 1
        assert top <= pixels[:, 1].min() + 1
        assert bottom >= pixels[:, 1].max() - 1
        assert right - left < 2.2 * (pixels[:, 0].max() - pixels[:, 0].min())

    def test_what_stands_behind_a_truck_is_hidden(self, world: BuiltInWorld, renderer: Renderer) -> None:
        truck = Track("truck", "truck", -35.0, -5.25, 0.0, 5.0, 8.0, 2.5)
        rider = Track("rider", "bicycle", -22.0, -5.25, 0.0, 4.0, 1.8, 0.6)
        alone = only(renderer.render(seen(world, -50.0, (rider,))).truths, id="rider")
        behind = only(renderer.render(seen(world, -50.0, (truck, rider))).truths, id="rider")
        assert alone.hidden < 0.05
        assert behind.hidden > 0.9

    def test_what_is_behind_the_vehicle_is_not_in_the_frame(self, world: BuiltInWorld, renderer: Renderer) -> None:
        follower = Track("behind", "car", -80.0, -5.25, 0.0, 8.0, 4.6, 1.8)
        assert not [truth for truth in renderer.render(seen(world, -50.0, (follower,))).truths if truth.id == "behind"]

    @pytest.mark.parametrize("color", ["red", "yellow", "green"])
    def test_a_light_shows_its_colour(self, world: BuiltInWorld, renderer: Renderer, color: str) -> None:
        name = "junction.e.light"
        found = renderer.render(seen(world, -14.0, **{name: (Indication(color),)}))  # type: ignore[arg-type]
        truth = only(found.truths, id=name)
        assert (truth.fact, truth.value) == ("signal.color", color)
        left, top, right, bottom = (round(n) for n in truth.box)
        lenses = np.asarray(found.image)[top : top + (bottom - top) // 3, left:right].reshape(-1, 3).astype(int)
        red, green = lenses[:, 0].max(), lenses[:, 1].max()
        lit = {"red": lenses[(lenses[:, 0] > 220) & (lenses[:, 1] < 90)], "green": lenses[(lenses[:, 1] > 200) & (lenses[:, 0] < 90)],
               "yellow": lenses[(lenses[:, 0] > 220) & (lenses[:, 1] > 150) & (lenses[:, 2] < 90)]}  # fmt: skip
        assert len(lit[color]), (red, green)
        assert not any(len(pixels) for other, pixels in lit.items() if other != color)


class TestFrames:
    def test_the_same_view_gives_the_same_bytes(self, world: BuiltInWorld, vocabulary: Vocabulary) -> None:
        views = [Renderer(world.road_map, vocabulary, SMALL).render(world.observe()).to_frame("f", 0.0).image for _ in range(2)]
        assert views[0] == views[1]
        assert views[0][:3] == b"\xff\xd8\xff"

    def test_a_camera_tells_of_signs_only_when_they_can_be_read(self, vocabulary: Vocabulary) -> None:
        world = build(scene_spec(PaperScene(no_turn_sign=True)))
        camera = FrameCamera(world, vocabulary, build_eye(world.spec.eye, vocabulary))
        told = []
        for x in (-118.0, -40.0):
            world.ego = replace(world.ego, x=x, y=-5.25, heading=0.0)
            told.append(camera.take().facts.get("sign.no_turn_on_red"))
        assert told == [None, True]

    def test_children_on_their_way_to_school_are_in_the_picture(self, vocabulary: Vocabulary) -> None:
        world = build(scene_spec(PaperScene(part="school", cyclist=False)))
        camera = FrameCamera(world, vocabulary, build_eye(world.spec.eye, vocabulary))
        lane = world.road_map.lanes[world.route[0]]
        index = int(np.searchsorted(lane.stations, 190.0))
        (x, y), (next_x, next_y) = lane.center[index], lane.center[index + 1]
        world.ego = replace(world.ego, x=float(x), y=float(y), heading=math.atan2(next_y - y, next_x - x))
        shot = camera.take()
        assert shot.facts["school.children_going"] is True
        assert [truth for truth in shot.rendering.truths if truth.id.startswith("child")]


def test_without_pillow_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    real = builtins.__import__

    def without(name: str, *rest: Any, **more: Any) -> Any:
        if name.startswith("PIL"):
            raise ModuleNotFoundError(name)
        return real(name, *rest, **more)

    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(MissingExtra, match=r"pip install 'regdb\[vlm\]'"):
        pillow()
