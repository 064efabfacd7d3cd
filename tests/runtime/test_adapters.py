"""The planner inside other systems: fakes with the very fields and methods of OpenCDA, CARLA and ROS 2; the planner records what it is given."""

from __future__ import annotations

import datetime
import math
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from regdb_runtime.adapters import ros2
from regdb_runtime.adapters.commonroad_reactive import RegulationCostFunction
from regdb_runtime.adapters.opencda import Location, RegulationAgent
from regdb_runtime.decision import Decision
from regdb_runtime.emergency import EmergencyReport
from regdb_runtime.errors import NoRoute
from regdb_runtime.maps.road_map import Lane, Light, RoadMap
from regdb_runtime.observation import EgoState, Footprint, Observation
from regdb_runtime.trajectory import Trajectory

FOOTPRINT = Footprint()
START = datetime.datetime(2026, 3, 2, 8, 0)


def _lane(name: str, start: float, end: float, **more: Any) -> Lane:
    center = np.column_stack((np.linspace(start, end, 30), np.full(30, -1.75)))
    side = np.array([0.0, 1.75])
    return Lane(name, center + side, center - side, center, speed_limit=15.0, **more)


ROAD = RoadMap(
    {"a": _lane("a", 0, 100, successors=("b",)), "b": _lane("b", 100, 200, predecessors=("a",))}, {"l1": Light("l1", (100.0, 4.0)), "l2": Light("l2")}
)  # fmt: skip


def plan(ego: EgoState) -> Trajectory:
    """Straight on at constant speed."""
    time = np.arange(0, 5.01, 0.1)
    x, zero = ego.x + ego.speed * time, np.zeros_like(time)
    return Trajectory(time, x, zero + ego.y, zero, zero + ego.speed, zero + 0.5, zero, zero + 0.01, x - ego.x, zero)


@dataclass
class Recorder:
    """A planner that keeps what it saw and drives straight on."""

    route: tuple[str, ...]
    seen: Observation | None = None

    def step(self, observation: Observation) -> Decision:
        self.seen = observation
        report = EmergencyReport(active=False, gap=12.5, required=3.0, track="7")
        return Decision(
            observation.time, "lane_following.go_straight", (), plan(observation.ego), "right", "", strategic=True, candidates=(), chosen=None,
            margin=None, flag="", emergency=report, events=("state",), reason="why",
        )  # fmt: skip


def carla_actor(x: float, y: float, yaw: float, type_id: str = "vehicle.tesla.model3", speed: float = 5.0) -> SimpleNamespace:
    """With the methods of `carla.Actor` that OpenCDA's obstacles keep."""
    transform = SimpleNamespace(location=Location(x, y, 0.5), rotation=SimpleNamespace(yaw=yaw))
    velocity = SimpleNamespace(x=speed * math.cos(math.radians(yaw)), y=speed * math.sin(math.radians(yaw)), z=0.0)
    return SimpleNamespace(
        carla_id=42, type_id=type_id, get_transform=lambda: transform, get_velocity=lambda: velocity, get_location=lambda: transform.location,
        bounding_box=SimpleNamespace(extent=SimpleNamespace(x=2.3, y=0.9, z=0.8)),
    )  # fmt: skip


@pytest.fixture
def agent() -> RegulationAgent:
    snapshot = SimpleNamespace(timestamp=SimpleNamespace(elapsed_seconds=12.5))
    vehicle = SimpleNamespace(get_world=lambda: SimpleNamespace(get_snapshot=lambda: snapshot))

    def look(time: float, ego: EgoState) -> Any:
        return {"sign.school": ego.x > 0 and time > 1}, frozenset({"sign.stop"})

    return RegulationAgent(Recorder, ROAD, vehicle, START, look, "scripted")


class TestOpenCda:
    """y points to the right in CARLA, to the left here; speeds are km/h there, m/s here."""

    def step(self, agent: RegulationAgent, **objects: Any) -> tuple[float, Any]:
        agent.set_destination(Location(5, 1.75, 0), Location(150, 1.75, 0))
        transform = SimpleNamespace(location=Location(20, 1.75, 0.3), rotation=SimpleNamespace(yaw=0.0))
        agent.update_information(transform, 36.0, objects)
        return agent.run_step()

    def test_the_destination_makes_the_planner_of_its_route(self, agent: RegulationAgent) -> None:
        self.step(agent)
        assert isinstance(agent.planner, Recorder)
        assert agent.planner.route == ("a", "b")

    def test_ego_time_and_facts(self, agent: RegulationAgent) -> None:
        self.step(agent)
        seen = agent.planner.seen  # type: ignore[union-attr]
        assert seen.time == 12.5
        assert seen.clock == START + datetime.timedelta(seconds=12.5)
        assert (seen.ego.x, seen.ego.y, seen.ego.speed) == (20 - FOOTPRINT.center, -1.75, 10.0)
        assert seen.facts == {"sign.school": True}
        assert seen.silent == {"sign.stop"}
        assert seen.provenance == "scripted"

    def test_other_road_users_are_mirrored(self, agent: RegulationAgent) -> None:
        others = [carla_actor(30, 5, 0, "vehicle.bh.crossbike"), carla_actor(9, 9, 0, "walker.pedestrian.0001")]
        self.step(agent, vehicles=[carla_actor(40, -3, 90), *others])
        car, bicycle, walker = agent.planner.seen.tracks  # type: ignore[union-attr]
        assert (car.x, car.y, car.speed, car.length, car.width) == (40, 3, pytest.approx(5), 4.6, 1.8)
        assert car.heading == pytest.approx(-math.pi / 2)
        assert (car.kind, bicycle.kind, walker.kind) == ("car", "bicycle", "pedestrian")

    def test_lights_are_laid_on_those_of_the_map_or_left_out(self, agent: RegulationAgent) -> None:
        def light(x: float, y: float, state: str) -> SimpleNamespace:
            return SimpleNamespace(get_location=lambda: Location(x, y, 5.0), get_state=lambda: state)

        self.step(agent, traffic_lights=[light(101, -5, "Red"), light(500, 0, "Green")])
        signals = agent.planner.seen.signals  # type: ignore[union-attr]
        assert {name: shown[0].color for name, shown in signals.items()} == {"l1": "red"}

    def test_the_answer_is_a_speed_in_kmh_and_a_place_ahead(self, agent: RegulationAgent) -> None:
        speed, place = self.step(agent)
        assert speed == pytest.approx(36.0)
        assert place == pytest.approx(Location(20 + 6.0, 1.75, 0.3))
        assert agent.run_step(target_speed=20.0)[0] == 20.0

    def test_without_an_observation_or_route_there_is_no_step(self, agent: RegulationAgent) -> None:
        with pytest.raises(RuntimeError, match="before set_destination"):
            agent.run_step()
        with pytest.raises(NoRoute):
            agent.set_destination(Location(150, 1.75, 0), Location(5, 1.75, 0))

    def test_the_second_step_knows_what_was_planned(self, agent: RegulationAgent) -> None:
        self.step(agent)
        self.step(agent)
        ego = agent.planner.seen.ego  # type: ignore[union-attr]
        agent.update_information(SimpleNamespace(location=Location(21, 1.75, 0), rotation=SimpleNamespace(yaw=0.0)), 36.0, {})
        agent.run_step()
        ego = agent.planner.seen.ego  # type: ignore[union-attr]
        assert (ego.acceleration, ego.curvature, ego.turn_signal) == (0.5, 0.01, "right")


STAMP = {"sec": 1772467200, "nanosec": 500_000_000}
ZONE = datetime.timezone(datetime.timedelta(hours=-8))


def as_objects(value: Any) -> Any:
    """Keys as attributes, as rclpy's messages have them."""
    if isinstance(value, dict):
        return SimpleNamespace(**{name: as_objects(item) for name, item in value.items()})
    return [as_objects(item) for item in value] if isinstance(value, list) else value


def pose(x: float, y: float, heading: float) -> dict[str, Any]:
    return {"position": {"x": x, "y": y, "z": 0.0}, "orientation": ros2.quaternion(heading)}


def twist(along: float, across: float = 0.0, rate: float = 0.0) -> dict[str, Any]:
    return {"linear": {"x": along, "y": across, "z": 0.0}, "angular": {"x": 0.0, "y": 0.0, "z": rate}}


ODOMETRY = {"header": {"stamp": STAMP}, "pose": {"pose": pose(10, 5, 0.7)}, "twist": {"twist": twist(8.0, rate=0.4)}}
OBJECTS = {
    "objects": [
        {
            "object_id": {"uuid": [1, 2, 255]},
            "classification": [{"label": 1, "probability": 0.2}, {"label": 6, "probability": 0.8}],
            "kinematics": {"initial_pose_with_covariance": {"pose": pose(3, 4, 0.1)}, "initial_twist_with_covariance": {"twist": twist(4.0, 3.0)}},
            "shape": {"dimensions": {"x": 1.8, "y": 0.6, "z": 1.7}},
        },
        {
            "object_id": {"uuid": [9]}, "classification": [],
            "kinematics": {"initial_pose_with_covariance": {"pose": pose(0, 0, 0)}, "initial_twist_with_covariance": {"twist": twist(-2.0)}},
            "shape": {"dimensions": {"x": 1.0, "y": 1.0, "z": 1.0}},
        },
    ]
}  # fmt: skip
LIGHTS = {
    "traffic_light_groups": [
        {"traffic_light_group_id": 7, "elements": [{"color": 1, "shape": 1, "status": 2}, {"color": 3, "shape": 3, "status": 2}]},
        {"traffic_light_group_id": 8, "elements": [{"color": 2, "shape": 1, "status": 3}]},
        {"traffic_light_group_id": 9, "elements": []}, {"traffic_light_group_id": 10, "elements": [{"color": 1, "shape": 10, "status": 2}]},
        {"traffic_light_group_id": 11, "elements": [{"color": 3, "shape": 1, "status": 1}]},
    ]
}  # fmt: skip


@pytest.mark.parametrize("form", [lambda message: message, as_objects], ids=["keys", "attributes"])
class TestRos2In:
    """Messages as dictionaries (rosbridge) and as objects (rclpy) say the same."""

    def observation(self, form: Any) -> Observation:
        lights_of = {7: ["l1"], 8: ["l2", "l3"], 9: ["l4"], 10: ["l5"], 11: ["l6"]}
        return ros2.observation(form(ODOMETRY), form(OBJECTS), form(LIGHTS), lights_of, 1772467190.0, ZONE, provenance="live")

    def test_the_vehicle(self, form: Any) -> None:
        found = self.observation(form)
        assert found.time == pytest.approx(10.5)
        assert found.clock.isoformat() == "2026-03-02T08:00:00.500000-08:00"
        ego = found.ego
        assert (ego.x, ego.y, ego.speed, ego.curvature) == (10, 5, 8.0, pytest.approx(0.05))
        assert ego.heading == pytest.approx(0.7)

    def test_road_users(self, form: Any) -> None:
        bicycle, unknown = self.observation(form).tracks
        assert (bicycle.id, bicycle.kind, bicycle.speed, bicycle.length, bicycle.width) == ("0102ff", "bicycle", 5.0, 1.8, 0.6)
        assert (unknown.kind, unknown.speed, abs(unknown.heading)) == ("obstacle", 2.0, pytest.approx(math.pi))

    def test_lights(self, form: Any) -> None:
        signals = self.observation(form).signals
        assert [(item.color, item.shape) for item in signals["l1"]] == [("red", "circular"), ("green", "right_arrow")]
        assert signals["l2"] == signals["l3"]
        assert signals["l2"][0].flashing
        assert signals["l6"][0].color == "dark"
        assert "l4" not in signals
        assert "l5" not in signals


class TestRos2Out:
    def decision(self) -> Decision:
        return Recorder(()).step(Observation(0.0, START, EgoState(1.0, 2.0, 0.0, 8.0)))

    def test_the_trajectory_has_every_field_of_the_message(self) -> None:
        fields = ros2.trajectory_fields(self.decision(), STAMP, FOOTPRINT)
        assert fields["header"] == {"stamp": STAMP, "frame_id": "map"}
        first, second = fields["points"][0], fields["points"][1]
        assert set(first) == {
            "time_from_start", "pose", "longitudinal_velocity_mps", "lateral_velocity_mps", "acceleration_mps2", "heading_rate_rps",
            "front_wheel_angle_rad", "rear_wheel_angle_rad",
        }  # fmt: skip
        assert second["time_from_start"] == {"sec": 0, "nanosec": 100_000_000}
        assert second["pose"]["position"]["x"] == pytest.approx(1.8)
        assert first["heading_rate_rps"] == pytest.approx(0.08)
        assert math.tan(first["front_wheel_angle_rad"]) == pytest.approx(FOOTPRINT.wheelbase * 0.01)

    def test_turn_signal_and_diagnostics(self) -> None:
        assert ros2.turn_indicators_fields(self.decision(), STAMP)["command"] == 3
        status = ros2.diagnostic_fields(self.decision(), STAMP)["status"][0]
        values = {pair["key"]: pair["value"] for pair in status["values"]}
        assert (status["level"], status["message"]) == (0, "why")
        assert values["emergency_gap"] == "12.50 m"
        assert values["state"] == "lane_following.go_straight"


def test_a_message_without_a_field_says_which() -> None:
    with pytest.raises(KeyError, match="pose"):
        ros2.ego_state({"twist": {"twist": twist(1.0)}})


def test_a_vehicle_that_rolls_back_stands_still_for_the_planner() -> None:
    message = {**ODOMETRY, "twist": {"twist": twist(-0.2)}}
    assert ros2.ego_state(message).speed == 0.0
    acceleration = {"accel": {"accel": {"linear": {"x": -1.5}}}}
    assert ros2.ego_state(ODOMETRY, acceleration, "left") == EgoState(10.0, 5.0, pytest.approx(0.7), 8.0, -1.5, 0.05, "left")


class TestReactivePlanner:
    """A `TrajectorySample` and a cost function with CommonRoad's names; the law by a planner that finds fast plans unlawful."""

    class Speeding:
        """Judges by the top speed: above 15 m/s unlawful, above 10 unknown."""

        def __init__(self) -> None:
            self.seen: list[Any] = []

        def step(self, observation: Observation) -> Decision:
            return Recorder(()).step(observation)

        def judge(self, observation: Observation, plan: Trajectory) -> Any:
            self.seen.append((observation, plan))
            return SimpleNamespace(rank=2 if plan.speed.max() > 15 else 1 if plan.speed.max() > 10 else 0)

    class Comfort:
        """As `DefaultCostFunction`: an attribute that the reactive planner sets, and slow plans that cost more."""

        desired_speed = 0.0

        def evaluate(self, trajectory: Any) -> float:
            return float(1e6 / (1 + trajectory.cartesian.v[0]))

    @staticmethod
    def sample(speed: float) -> SimpleNamespace:
        time = np.arange(31) * 0.1
        zero = np.zeros(31)
        cartesian = SimpleNamespace(x=speed * time, y=zero, theta=zero, v=zero + speed, a=zero, kappa=zero)
        return SimpleNamespace(cartesian=cartesian, curvilinear=SimpleNamespace(s=speed * time, d=zero), dt=0.1)

    def test_legality_comes_first_and_the_other_cost_within(self) -> None:
        planner = self.Speeding()
        cost = RegulationCostFunction(planner, self.Comfort())
        cost.observe(Observation(0.0, START, EgoState(0, 0, 0, 5.0)))
        costs = {speed: cost.evaluate(self.sample(speed)) for speed in (1.0, 9.0, 11.0, 14.0, 16.0, 30.0)}
        assert sorted(costs, key=costs.__getitem__) == [9.0, 1.0, 14.0, 11.0, 30.0, 16.0]
        assert [int(value) for value in costs.values()] == [0, 0, 1, 1, 2, 2]
        assert planner.seen[0][1].time[-1] == pytest.approx(3.0)

    def test_what_the_reactive_planner_sets_reaches_the_cost_within(self) -> None:
        within = self.Comfort()
        cost = RegulationCostFunction(self.Speeding(), within)
        assert hasattr(cost, "desired_speed")
        assert not hasattr(cost, "w_a")
        cost.desired_speed = 12.0
        assert within.desired_speed == 12.0

    def test_before_an_observation_there_is_no_cost(self) -> None:
        with pytest.raises(RuntimeError, match="before observe"):
            RegulationCostFunction(self.Speeding(), self.Comfort()).evaluate(self.sample(5.0))
