"""Drives that see through rendered frames: model, reading and fusion in the loop, lawful whatever the model gets wrong."""

from __future__ import annotations

import json

import pytest
from regdb_runtime.database import RegulationDatabase
from regdb_runtime.drive.degradation import SCENES, Outcome, breaches, drive_by_frames, write_degradation
from regdb_runtime.drive.measures import measure
from regdb_runtime.drive.paper_scene import scene_spec
from regdb_runtime.drive.run import DriveSettings
from regdb_runtime.perception.stub_model import ErrorRates

from regdb.front import database


@pytest.fixture(scope="module")
def law() -> RegulationDatabase:
    return RegulationDatabase.open(database())


def test_with_a_model_that_errs_not_it_turns_on_red_once_it_has_looked_for_the_sign(law: RegulationDatabase) -> None:
    log, asked, failed = drive_by_frames("red", scene_spec(SCENES["red"]), law, ErrorRates(), settings=DriveSettings(time_limit=36.0))
    found = measure(log)
    assert [event.name for event in found.events if event.name in {"stopped", "released"}] == ["stopped", "released"]
    assert found.crosses == "red"
    assert not breaches(SCENES["red"], found)
    assert asked > 40
    assert failed == 0
    assert log.run["provenance"] == "scripted"
    assert log.run["perception"]["eye"] == "frames"


def test_where_a_sign_forbids_it_no_error_of_the_model_makes_it_turn_on_red(law: RegulationDatabase) -> None:
    settings = DriveSettings(time_limit=40.0)
    log, _, _ = drive_by_frames("sign", scene_spec(SCENES["no-turn-sign"]), law, ErrorRates.even(0.3), seed=3, settings=settings)
    assert measure(log).crosses != "red"
    assert not breaches(SCENES["no-turn-sign"], measure(log))


def test_a_model_that_never_answers_leaves_the_vehicle_at_the_line(law: RegulationDatabase) -> None:
    log, asked, failed = drive_by_frames("silent", scene_spec(SCENES["red"]), law, ErrorRates(fail=1.0), settings=DriveSettings(time_limit=32.0))
    assert measure(log).crosses == ""
    assert asked == failed > 3


def test_the_same_seed_sees_the_same(law: RegulationDatabase) -> None:
    settings = DriveSettings(time_limit=6.0)
    logs = [drive_by_frames("red", scene_spec(SCENES["red"]), law, ErrorRates.even(0.2), 5, settings)[0] for _ in range(2)]
    assert logs[0].ticks == logs[1].ticks


def test_table_and_plot(tmp_path) -> None:
    outcomes = [
        Outcome("red", rate, seed, "destination", "", 50.0 + 100 * rate + seed, rate / 2, ("turned on red",) if rate > 0.3 else (), 90, 0)
        for rate in (0.0, 0.1, 0.4)
        for seed in (0, 1)
    ]
    table, picture = write_degradation(outcomes, tmp_path / "out")
    assert len(json.loads(table.read_text("utf-8"))) == 6
    assert picture.read_bytes()[:4] == b"\x89PNG"
