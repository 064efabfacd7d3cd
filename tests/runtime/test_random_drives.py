"""Random scenes driven by law: nothing that must not happen does; and what must not happen would be seen. All 1,000: `make drives`."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from regdb_runtime.database import RegulationDatabase
from regdb_runtime.decision import Decision
from regdb_runtime.drive.shrink import shrink
from regdb_runtime.drive.trial import TrialSettings, trial
from regdb_runtime.emergency import EmergencyReport
from regdb_runtime.observation import Observation
from regdb_runtime.trajectory import Trajectory
from regdb_runtime.worlds.built_in.world import BuiltInWorld
from regdb_runtime.worlds.random_scenes import random_scene
from regdb_runtime.worlds.scene_spec import SceneSpec

from regdb.front import database

SEEDS = range(30)
SECONDS = 15.0


@pytest.fixture(scope="module")
def law() -> RegulationDatabase:
    return RegulationDatabase.open(database())


class Blind:
    """Drives along the route at one speed, whatever is there."""

    def __init__(self, world: BuiltInWorld, speed: float) -> None:
        from regdb_runtime.maps.lane_path import path_along

        self.path = path_along(world.road_map, world.route).path
        self.speed = speed

    def step(self, observation: Observation) -> Decision:
        (station,), _ = self.path.project([(observation.ego.x, observation.ego.y)], extend=True)
        time = np.arange(11) * 0.1
        along = np.clip(station + self.speed * time, 0.0, self.path.length)
        x, y = self.path.to_plane(along).T
        rest = np.zeros(11)
        plan = Trajectory(time, x, y, self.path.heading(along), np.full(11, self.speed), rest, rest, self.path.curvature(along), along, rest)
        nothing = EmergencyReport(active=False, gap=None, required=0.0, track=None)
        return Decision(
            observation.time, "lane_following.go_straight", (), plan, "off", "", strategic=False, candidates=(), chosen=None, margin=None,
            flag="", emergency=nothing,
        )  # fmt: skip


@pytest.mark.parametrize("seed", SEEDS)
def test_random_scenes_are_driven_without_fault(seed: int, law: RegulationDatabase) -> None:
    outcome = trial(random_scene(seed), law, TrialSettings(seconds=SECONDS))
    assert not outcome.faults, "; ".join(f"{fault.kind} at {fault.time} s: {fault.what}" for fault in outcome.faults)
    assert sum(outcome.flags.values()) > 20


def test_a_blind_driver_is_caught(law: RegulationDatabase) -> None:
    """Held against a driver that minds nothing, the trial finds red lights run, limits exceeded and collisions caused."""
    found = {
        fault.kind for seed in range(24)
        for fault in trial(random_scene(seed), law, TrialSettings(seconds=30.0), lambda world: Blind(world, 22.0)).faults
    }  # fmt: skip
    assert {"red_light", "speeding", "collision"} <= found


def test_a_driver_that_stands_without_a_word_is_caught(law: RegulationDatabase) -> None:
    outcome = trial(random_scene(0), law, TrialSettings(seconds=8.0, standstill=5.0), lambda world: Blind(world, 0.0))
    assert [fault.kind for fault in outcome.faults] == ["standstill"]


def test_a_failing_scene_is_made_small_and_stays_readable(law: RegulationDatabase) -> None:
    """Only one vehicle matters; all else goes, and the file gives the same scene back."""
    scenes = (random_scene(seed) for seed in range(60))
    spec = next(scene for scene in scenes if len(scene.vehicles) > 1 and (scene.pedestrians or scene.cyclists or scene.parked))
    kept = spec.vehicles[-1]
    small = shrink(spec, lambda scene: kept in scene.vehicles)
    assert small.vehicles == (kept,)
    assert (small.flows, small.cyclists, small.pedestrians, small.parked, small.streets.zones) == ((), (), (), (), ())
    again = SceneSpec.from_json(small.to_json())
    assert again == small
    assert trial(again, law, TrialSettings(seconds=1.0)) == trial(replace(small), law, TrialSettings(seconds=1.0))
