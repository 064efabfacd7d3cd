"""The picture from above: drawn, the same bytes each time, onto axes that are there too; without matplotlib it says what to type."""

import math
import sys
from pathlib import Path

import numpy as np
import pytest
from regdb_runtime.drive.picture import Instant, PictureSettings, draw_scene, paint_scene
from regdb_runtime.errors import MissingExtra
from regdb_runtime.worlds.built_in import build
from regdb_runtime.worlds.random_scenes import random_scene
from standing_ego import standing

pytest.importorskip("matplotlib")


def instant(seed: int) -> tuple[Instant, object]:
    world = build(random_scene(seed))
    plan = standing(world.ego)
    for _ in range(20):
        world.step(plan, "right", 0.1)
    return Instant(world.observe(), world.footprint, plan, tracks=world.tracks()), world.road_map


@pytest.mark.parametrize("suffix", ["png", "svg"])
def test_the_same_scene_is_the_same_picture(tmp_path: Path, suffix: str) -> None:
    drawn, road_map = instant(4)
    files = [tmp_path / f"{name}.{suffix}" for name in ("first", "second")]
    for file in files:
        draw_scene(file, road_map, drawn, title="A street", settings=PictureSettings(pixels=600))  # type: ignore[arg-type]
    assert files[0].read_bytes() == files[1].read_bytes()
    assert files[0].stat().st_size > 5_000


def test_a_picture_shows_the_ego_where_it_is(tmp_path: Path) -> None:
    from matplotlib.image import imread

    drawn, road_map = instant(4)
    ego = drawn.observation.ego
    file = tmp_path / "ego.png"
    draw_scene(file, road_map, drawn, settings=PictureSettings(along=20.0, across=12.0, pixels=500, center=ego.box_center(drawn.footprint)))  # type: ignore[arg-type]
    pixels = imread(file)
    middle = pixels[55 + (pixels.shape[0] - 55) // 2, pixels.shape[1] // 2]
    assert np.allclose(middle[:3], (0x1F / 255, 0x7B / 255, 0xF2 / 255), atol=0.02)


def test_it_can_be_painted_onto_axes_that_are_there() -> None:
    from matplotlib.figure import Figure

    drawn, road_map = instant(2)
    axes = Figure().add_subplot()
    paint_scene(axes, road_map, drawn, scale=0.5)  # type: ignore[arg-type]
    left, right = axes.get_xlim()
    ego = drawn.observation.ego
    assert left < ego.x + 15.0 * math.cos(ego.heading) < right


def test_without_matplotlib_it_says_what_to_type(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    drawn, road_map = instant(2)
    monkeypatch.setitem(sys.modules, "matplotlib.figure", None)
    with pytest.raises(MissingExtra, match=r"regdb\[plots\]"):
        draw_scene(tmp_path / "none.png", road_map, drawn)  # type: ignore[arg-type]
