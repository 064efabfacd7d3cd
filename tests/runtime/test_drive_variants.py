"""The variants as data: their scenes can be built and written down, and what they expect is law that is in the database."""

from __future__ import annotations

from pathlib import Path

import pytest
from regdb_runtime import drive
from regdb_runtime.database import RegulationDatabase
from regdb_runtime.drive.paper_scene import FIRST, ZONE, PaperScene, scene_spec
from regdb_runtime.drive.run import DriveSettings, run_record
from regdb_runtime.drive.variants import VARIANTS, Variant, variant
from regdb_runtime.errors import RequestError
from regdb_runtime.worlds.built_in.world import BuiltInWorld
from regdb_runtime.worlds.scene_spec import SceneSpec

from regdb.front import ADDED_CODES, database

NAMES = [item.name for item in VARIANTS]
ASKED_FOR = {
    "paper", "cyclist", "red", "school", "solid-line", "lane-3.4m", "lane-3.5m", "cyclist-2022", "cyclist-2023", "no-turn-sign", "red-arrow",
    "pedestrian", "cross-traffic", "green", "school-no-children", "school-no-sign", "school-20", "school-2031", "no-right-on-red", "vlm-silent",
    "no-eye",
}  # fmt: skip


@pytest.fixture(scope="module")
def law() -> RegulationDatabase:
    """The shipped codes with New York's red signals."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv(ADDED_CODES, str(Path(drive.__file__).parent / "added_codes"))
        return RegulationDatabase.open(database())


def test_every_variant_asked_for_is_there() -> None:
    assert ASKED_FOR - set(NAMES) == set()
    assert len(NAMES) == len(set(NAMES))


@pytest.mark.parametrize("item", VARIANTS, ids=NAMES)
def test_a_variants_scene_can_be_built_and_written_down(item: Variant, law: RegulationDatabase) -> None:
    spec = scene_spec(item.scene, item.name)
    assert SceneSpec.from_json(spec.to_json()) == spec
    world = BuiltInWorld(spec, law.vocabulary)
    marks = run_record(world, {}, DriveSettings())["marks"]
    assert len(marks["stop_lines"]) == (item.scene.part in ("whole", "red"))
    assert len(marks["zones"]) == (item.scene.part in ("whole", "school"))
    assert spec.streets.jurisdiction in {place.id for place in law.tree}


@pytest.mark.parametrize("item", VARIANTS, ids=NAMES)
def test_what_a_variant_expects_is_law_in_force_then_and_there(item: Variant, law: RegulationDatabase) -> None:
    cited = {rule.citation for rule in law.at(item.scene.jurisdiction, item.scene.start[:10]).rules}
    assert set(item.expects.sections) - cited == set()


def test_the_papers_scene_is_the_papers() -> None:
    """P32: the rightmost of two lanes at 35 mph, a cyclist, a right turn at a red light, a school with its zone."""
    spec = scene_spec(PaperScene())
    first, school = (road for road in spec.streets.roads if road.id in ("first", "school"))
    assert spec.ego.lane.endswith(".1")
    assert first.forward == 2
    assert first.divider == "dashed"
    assert first.limit == school.limit == pytest.approx(15.6464)
    assert spec.ego.speed == pytest.approx(15.6464)
    assert spec.ego.turns == ("right",)
    assert [rider.lane for rider in spec.cyclists] == [spec.ego.lane]
    assert spec.cyclists[0].leaves_at is not None
    assert spec.cyclists[0].leaves_at < FIRST["whole"]
    (zone,) = spec.streets.zones
    assert (zone.start, zone.end) == ZONE


def test_an_unknown_variant_is_told_the_nearest() -> None:
    with pytest.raises(RequestError, match="did you mean red-arrow"):
        variant("red-arow")
    with pytest.raises(RequestError, match="there are: paper, cyclist"):
        variant("xyz")
