"""Random scenes are valid, the same for a seed, survive JSON, and run without anybody hitting the standing ego by its own fault."""

import json

import pytest
from regdb_runtime.errors import WorldError
from regdb_runtime.worlds.random_scenes import build, random_scene
from regdb_runtime.worlds.scene_spec import SceneSpec
from standing_ego import standing


@pytest.mark.parametrize("block", range(10))
def test_two_hundred_scenes_build_step_and_survive_json(block: int) -> None:
    for seed in range(20 * block, 20 * block + 20):
        spec = random_scene(seed)
        assert SceneSpec.from_json(spec.to_json()) == spec
        world = build(spec)
        assert world.route[0].startswith("main.")
        for _ in range(30):
            world.step(standing(world.ego), "off", 0.1)
            world.observe()
        assert not [item for item in world.contacts if item.by == "other" and item.ego_speed == 0.0], seed


def test_the_same_seed_is_the_same_scene() -> None:
    assert random_scene(3).to_json() == random_scene(3).to_json()
    assert len({random_scene(seed).to_json() for seed in range(50)}) == 50


def test_scenes_have_all_that_they_should_have() -> None:
    scenes = [random_scene(seed) for seed in range(200)]
    junctions = [spec.streets.junctions[0] for spec in scenes if spec.streets.junctions]
    assert {junction.control for junction in junctions} == {"signal", "stop", "all_way_stop", "none"}
    assert {len(junction.arms) for junction in junctions} == {3, 4}
    assert any(arm.arrows for junction in junctions for arm in junction.arms)
    assert {turn for spec in scenes for turn in spec.ego.turns} == {"left", "right", "straight"}
    for part in ("vehicles", "flows", "cyclists", "pedestrians", "parked"):
        assert 10 < sum(bool(getattr(spec, part)) for spec in scenes) < 190
    assert sum(bool(spec.streets.zones) for spec in scenes) > 20
    assert {spec.eye.kind for spec in scenes} == {"scripted", "none"}


@pytest.mark.parametrize(("path", "value", "said"), [
    (("eg",), {}, "scene has no field 'eg'"), (("ego", "lane"), 3, "scene.ego.lane is 3, not a str"),
    (("eye",), {"kind": "psychic"}, "scene.eye.kind cannot be 'psychic'"), (("streets", "roads"), {}, r"scene.streets.roads is \{\}, not a list"),
    (("pedestrians",), [{"id": "a", "path": [[1, 2, 3]]}], r"pedestrians\[0\].path\[0\] has 3 items"), (("flows",), [{"id": "f"}], r"flows\[0\]"),
])  # fmt: skip
def test_a_wrong_field_is_named(path: tuple[str, ...], value: object, said: str) -> None:
    raw = json.loads(random_scene(1).to_json())
    holder = raw
    for name in path[:-1]:
        holder = holder[name]
    holder[path[-1]] = value
    with pytest.raises(WorldError, match=said):
        SceneSpec.from_json(json.dumps(raw))
