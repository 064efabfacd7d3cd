"""Plans made elsewhere, judged by the real planner on a real street: as its own are, and ranked as the law has it."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from regdb_runtime.adapters.commonroad_reactive import RegulationCostFunction
from regdb_runtime.database import RegulationDatabase
from regdb_runtime.drive.paper_scene import PaperScene, scene_spec
from regdb_runtime.planner import Planner
from regdb_runtime.trajectory import Trajectory
from regdb_runtime.worlds.built_in.build import build
from regdb_runtime.worlds.built_in.world import BuiltInWorld

from regdb.front import database
from regdb.units import to_si


@pytest.fixture(scope="module")
def law() -> RegulationDatabase:
    return RegulationDatabase.open(database())


@pytest.fixture
def world() -> BuiltInWorld:
    return build(scene_spec(PaperScene(part="school", cyclist=False)))


def straight(world: BuiltInWorld, mph: float) -> Trajectory:
    """Straight on along the ego's heading at constant speed."""
    ego, time = world.ego, np.arange(51) * 0.1
    zero, speed = np.zeros(51), float(to_si(mph, "mph"))
    way = speed * time
    heading = zero + ego.heading
    return Trajectory(time, ego.x + way * np.cos(heading), ego.y + way * np.sin(heading), heading, zero + speed, zero, zero, zero, zero, zero)


def test_a_plan_of_ones_own_is_as_lawful_as_it_was_found(law: RegulationDatabase, world: BuiltInWorld) -> None:
    planner, observation = Planner(law, world.road_map, world.route, world.footprint), world.observe()
    decision = planner.step(observation)
    assert decision.chosen is not None
    assert planner.judge(observation, decision.trajectory).rank == decision.candidates[decision.chosen].rank == 0


def test_what_is_too_fast_is_unlawful_and_says_by_what(law: RegulationDatabase, world: BuiltInWorld) -> None:
    planner, observation = Planner(law, world.road_map, world.route, world.footprint), world.observe()
    planner.step(observation)
    assert planner.judge(observation, straight(world, 30)).rank == 0
    fast = planner.judge(observation, straight(world, 45))
    assert fast.rank == 2
    assert fast.verdict is not None
    assert {"CVC 22351(b)"} <= {rule.citation for rule in fast.verdict.deciding}


def test_judging_before_a_step_is_refused(law: RegulationDatabase, world: BuiltInWorld) -> None:
    with pytest.raises(RuntimeError, match="before step"):
        Planner(law, world.road_map, world.route).judge(world.observe(), straight(world, 30))


def test_the_cost_hook_puts_the_lawful_sample_first(law: RegulationDatabase, world: BuiltInWorld) -> None:
    class Fast:
        def evaluate(self, trajectory: object) -> float:
            return 1.0 / float(trajectory.cartesian.v[0])  # type: ignore[attr-defined]

    class Sample:
        def __init__(self, plan: Trajectory) -> None:
            self.dt = 0.1
            self.cartesian = SimpleNamespace(x=plan.x, y=plan.y, theta=plan.heading, v=plan.speed, a=plan.acceleration, kappa=plan.curvature)

    cost = RegulationCostFunction(Planner(law, world.road_map, world.route, world.footprint), Fast())
    cost.observe(replace(world.observe(), time=0.0))
    found = {mph: cost.evaluate(Sample(straight(world, mph))) for mph in (20, 30, 45)}
    assert min(found, key=found.__getitem__) == 30
    assert found[45] > 2.0
