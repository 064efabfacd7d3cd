"""SUMO behind the world's protocol: our streets as its net, its drivers among our ego, people and lights."""

from __future__ import annotations

import builtins
import math
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from crossing_streets import ALL_WAY, HALF, ROADS, SIGNALS, scene
from regdb_runtime.errors import MissingExtra, WorldError
from regdb_runtime.geometry import boxes, distance
from regdb_runtime.observation import EgoState, Track
from regdb_runtime.trajectory import Trajectory
from regdb_runtime.worlds.built_in.build import shipped_vocabulary
from regdb_runtime.worlds.road_builder import build_road_map
from regdb_runtime.worlds.road_spec import JunctionSpec, SignalPhase, StreetsSpec
from regdb_runtime.worlds.scene_spec import CyclistSpec, EgoSpec, FlowSpec, ParkedSpec, PedestrianSpec, SceneSpec, VehicleSpec
from regdb_runtime.worlds.sumo import traffic
from regdb_runtime.worlds.sumo.net_layout import layout
from regdb_runtime.worlds.sumo.net_writer import net_xml
from regdb_runtime.worlds.sumo.world import SumoWorld

from regdb.vocabulary import Vocabulary


@pytest.fixture
def vocabulary() -> Vocabulary:
    return shipped_vocabulary()


@pytest.fixture
def run(vocabulary: Vocabulary) -> Iterator[Any]:
    """Drives a scene with the ego standing; gives the world and everybody's tracks at each tenth of a second."""
    worlds: list[SumoWorld] = []

    def drive(spec: SceneSpec, seconds: float, plan: Any = None) -> tuple[SumoWorld, list[tuple[Track, ...]]]:
        world = SumoWorld(spec, vocabulary)
        worlds.append(world)
        seen = [world.tracks()]
        for _ in range(round(seconds * 10)):
            world.step((plan or standing)(world.ego), "off", 0.1)
            seen.append(world.tracks())
        world.close()
        return world, seen

    yield drive
    for world in worlds:
        world.close()


def standing(ego: EgoState) -> Trajectory:
    time, zero = np.arange(0, 3, 0.1), np.zeros(30)
    return Trajectory(time, zero + ego.x, zero + ego.y, zero + ego.heading, zero, zero, zero, zero, zero, zero)


def ahead(speed: float) -> Any:
    def plan(ego: EgoState) -> Trajectory:
        time, zero = np.arange(0, 3, 0.1), np.zeros(30)
        return Trajectory(
            time, ego.x + speed * time * math.cos(ego.heading), ego.y + speed * time * math.sin(ego.heading), zero + ego.heading, zero + speed,
            zero, zero, zero, speed * time, zero,
        )  # fmt: skip

    return plan


def of(seen: list[tuple[Track, ...]], name: str) -> list[Track]:
    return [track for tracks in seen for track in tracks if track.id == name]


EASTBOUND = VehicleSpec("car", "west.e.1", 100.0, 12.0, turns=("straight",))


class TestNet:
    def test_every_driven_lane_has_one_of_sumos(self, vocabulary: Vocabulary) -> None:
        road_map = build_road_map(scene(SIGNALS).streets, vocabulary)
        laid = layout(road_map)
        assert set(laid.sumo_lane) == set(road_map.lanes)
        assert len(set(laid.sumo_lane.values())) == len(laid.sumo_lane)
        assert {ours: laid.our_lane()[theirs] for ours, theirs in laid.sumo_lane.items()} == {name: name for name in road_map.lanes}

    def test_the_same_map_gives_the_same_net(self, vocabulary: Vocabulary) -> None:
        assert net_xml(build_road_map(scene(SIGNALS).streets, vocabulary)) == net_xml(build_road_map(scene(SIGNALS).streets, vocabulary))

    def test_opposing_left_turns_give_way_and_crossing_ways_are_foes(self, vocabulary: Vocabulary) -> None:
        node = next(node for node in layout(build_road_map(scene(SIGNALS).streets, vocabulary)).nodes if node.links)
        places = {(link.source, link.turn): index for index, link in enumerate(node.links)}
        text = net_xml(build_road_map(scene(SIGNALS).streets, vocabulary))
        requests = [line.split('"') for line in text.splitlines() if "<request" in line]
        response = {int(parts[1]): parts[3][::-1] for parts in requests}
        left, oncoming = places["west.e.1", "left"], places["east.w.1", "straight"]
        assert response[left][oncoming] == "1"
        assert response[oncoming][left] == "0"


class TestLights:
    def test_a_car_stands_before_the_line_while_red_and_goes_on_at_green(self, run: Any) -> None:
        world, seen = run(scene(SIGNALS, vehicles=(EASTBOUND,)), 45.0)
        car = of(seen, "car")
        line = world.road_map.lanes["west.e.1"].stop_line
        assert line is not None
        red = [track for k, track in enumerate(car[:230]) if track.speed < 0.05]
        assert red, "it never stood"
        fronts = [track.x + track.length / 2 for track in red]
        assert all(-3.0 < front - line.start[0] <= 0.05 for front in fronts)
        assert car[-1].x > HALF

    def test_a_left_turner_lets_oncoming_traffic_pass(self, run: Any) -> None:
        first_green = JunctionSpec("cross", SIGNALS.arms, "signal", (SignalPhase(("e", "w"), 40.0), SignalPhase(("n", "s"), 20.0)))
        vehicles = (
            VehicleSpec("left", "west.e.1", 150.0, 8.0, turns=("left",)), VehicleSpec("on", "east.w.1", 130.0, 12.0, turns=("straight",)),
        )  # fmt: skip
        _, seen = run(scene(first_green, vehicles=vehicles), 25.0)
        gaps = []
        for tracks in seen:
            two = {track.id: track for track in tracks if track.id in {"left", "on"}}
            if len(two) == 2:
                pair = [boxes(t.x, t.y, t.heading, t.length, t.width) for t in two.values()]
                gaps.append(float(np.min(distance(*pair))))
        assert min(gaps) > 0.5
        assert of(seen, "left")[-1].y > HALF


class TestPeople:
    def test_a_cyclist_rides_at_the_edge(self, run: Any) -> None:
        world, seen = run(scene(SIGNALS, cyclists=(CyclistSpec("rider", "west.e.1", 50.0, 4.5, from_edge=0.1),)), 8.0)
        edge = world.road_map.lanes["west.e.1"].right_line[0][1]
        for track in of(seen, "rider")[5:]:
            assert track.kind == "bicycle"
            assert track.y - track.width / 2 - edge == pytest.approx(0.1, abs=0.06)
            assert track.speed == pytest.approx(4.5, abs=0.3)

    def test_a_cyclist_leaves_where_told(self, run: Any) -> None:
        _, seen = run(scene(SIGNALS, cyclists=(CyclistSpec("rider", "west.e.1", 50.0, 4.5, leaves_at=70.0),)), 10.0)
        assert max(track.x for track in of(seen, "rider")) < -200 - HALF + 72.0
        assert not of(seen[-5:], "rider")

    def test_drivers_stop_for_somebody_on_the_road(self, run: Any) -> None:
        person = PedestrianSpec("walker", ((-60.0, -8.0), (-60.0, -1.75)), speed=1.5)
        _, seen = run(scene(SIGNALS, vehicles=(VehicleSpec("car", "west.e.1", 50.0, 12.0),), pedestrians=(person,)), 18.0)
        car = of(seen, "car")
        assert car[-1].speed < 0.1
        assert car[-1].x + car[-1].length / 2 < -60.0

    def test_drivers_stop_for_what_stands_in_their_lane(self, run: Any) -> None:
        parked = ParkedSpec("truck", "west.e.1", 170.0, 0.0, "truck", 8.0, 2.5)
        _, seen = run(scene(SIGNALS, vehicles=(EASTBOUND,), parked=(parked,)), 15.0)
        assert of(seen, "car")[-1].x + 2.3 < -HALF - 200 + 170.0 - 4.0

    def test_drivers_keep_behind_the_ego(self, run: Any) -> None:
        behind = VehicleSpec("behind", "south.n.1", 160.0, 10.0)
        spec = SceneSpec("ego", StreetsSpec(ROADS, (SIGNALS,)), EgoSpec("south.n.1", 185.0), vehicles=(behind,))
        world, seen = run(spec, 12.0)
        assert not world.contacts
        assert of(seen, "behind")[-1].speed < 0.1


class TestSigns:
    def test_everybody_stops_at_an_all_way_stop(self, run: Any) -> None:
        vehicles = (EASTBOUND, VehicleSpec("other", "north.s.1", 100.0, 12.0, turns=("straight",)))
        _, seen = run(scene(ALL_WAY, vehicles=vehicles), 40.0)
        for name in ("car", "other"):
            track = of(seen, name)
            assert min(item.speed for item in track[20:]) < 0.5
            assert abs(track[-1].x) + abs(track[-1].y) > HALF


class TestRuns:
    def test_the_same_seed_gives_the_same_drive(self, run: Any) -> None:
        flows = (FlowSpec("flow", "west.e.1", 900.0),)
        spec = scene(SIGNALS, flows=flows, seed=3)
        first, second = run(spec, 20.0, ahead(5.0)), run(spec, 20.0, ahead(5.0))
        assert first[1] == second[1]
        assert len({track.id for tracks in first[1] for track in tracks}) > 2

    def test_a_vehicle_may_enter_later_and_change_its_mind(self, run: Any) -> None:
        late = VehicleSpec("late", "west.e.1", 20.0, 8.0, wish=8.0, speeds=((6.0, 0.0), (12.0, 8.0)), enters=2.0)
        _, seen = run(scene(SIGNALS, vehicles=(late,)), 16.0)
        assert not of(seen[:19], "late")
        assert min(track.speed for track in of(seen[90:120], "late")) < 0.2
        assert of(seen, "late")[-1].speed > 1.0

    def test_one_simulation_at_a_time(self, vocabulary: Vocabulary) -> None:
        first = SumoWorld(scene(SIGNALS), vocabulary)
        with pytest.raises(WorldError, match="close it first"):
            SumoWorld(scene(SIGNALS), vocabulary)
        first.close()
        first.close()
        SumoWorld(scene(SIGNALS), vocabulary).close()

    def test_without_sumo_it_says_what_to_install(self, monkeypatch: pytest.MonkeyPatch) -> None:
        real = builtins.__import__

        def without(name: str, *rest: Any, **more: Any) -> Any:
            if name == "libsumo":
                raise ModuleNotFoundError(name)
            return real(name, *rest, **more)

        monkeypatch.setattr(builtins, "__import__", without)
        with pytest.raises(MissingExtra, match=r"pip install 'regdb\[sim\]'"):
            traffic.libsumo()

    def test_nothing_is_printed(self, vocabulary: Vocabulary, capfd: pytest.CaptureFixture[str]) -> None:
        SumoWorld(scene(SIGNALS), vocabulary).close()
        assert capfd.readouterr() == ("", "")
