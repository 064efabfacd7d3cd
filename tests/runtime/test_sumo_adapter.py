"""Our planner in somebody's own SUMO simulation: the net as a file, the vehicle SUMO's, the driving ours."""

from __future__ import annotations

import datetime
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from crossing_streets import SIGNALS, scene
from regdb_runtime.adapters.sumo import SumoEgo
from regdb_runtime.database import RegulationDatabase
from regdb_runtime.maps.road_map import RoadMap
from regdb_runtime.maps.route import find_route
from regdb_runtime.maps.sumo_net import read_sumo
from regdb_runtime.planner import Planner
from regdb_runtime.worlds.built_in.build import shipped_vocabulary
from regdb_runtime.worlds.eye import ScriptedEye
from regdb_runtime.worlds.road_builder import build_road_map
from regdb_runtime.worlds.sumo.net_layout import layout
from regdb_runtime.worlds.sumo.net_writer import net_xml
from regdb_runtime.worlds.sumo.traffic import libsumo

from regdb.front import database
from regdb.situation import quiet_facts

START = datetime.datetime(2026, 3, 2, 12, 0)


@pytest.fixture
def law() -> RegulationDatabase:
    return RegulationDatabase.open(database())


@pytest.fixture
def simulation(tmp_path: Path) -> Iterator[tuple[Any, RoadMap, dict[str, str]]]:
    """A running simulation with the vehicle `ego` on the western road, the map read from its net, and SUMO's names of our lanes."""
    ours = build_road_map(scene(SIGNALS).streets, shipped_vocabulary())
    laid = layout(ours)
    net = tmp_path / "own.net.xml"
    net.write_text(net_xml(ours, laid), encoding="utf-8")
    sumo = libsumo()
    sumo.start(["sumo", "--net-file", str(net), "--step-length", "0.1", "--no-step-log", "true", "--no-warnings", "true", "--seed", "1"])
    edges = {lane: edge.id for edge in laid.edges for lane in edge.lanes}
    sumo.route.add("way", [edges["west.e.1"], edges["east.e.1"]])
    sumo.vehicle.add("ego", "way", departPos="60", departSpeed="8")
    sumo.simulationStep()
    quiet = quiet_facts(shipped_vocabulary())
    mapped = {name: value for name, value in quiet.items() if shipped_vocabulary().facts[name].source == "map"}
    road_map = read_sumo(net)
    yield sumo, replace(road_map, facts={**mapped, **road_map.facts}, jurisdiction="los_angeles"), laid.sumo_lane
    sumo.close()


def node(sumo: Any) -> str:
    return str(sumo.trafficlight.getIDList()[0])


def test_it_stops_at_red_and_goes_on_at_green(simulation: Any, law: RegulationDatabase) -> None:
    sumo, road_map, names = simulation
    route = find_route(road_map, names["west.e.1"], names["east.e.1"])
    ego = SumoEgo(
        sumo, "ego", Planner(law, road_map, route, SumoEgo.footprint_of(sumo, "ego")), road_map, START, ScriptedEye(shipped_vocabulary()).look,
        "scripted",
    )  # fmt: skip
    count = len(sumo.trafficlight.getRedYellowGreenState(node(sumo)))
    line = road_map.lanes[names["west.e.1"]].center[-1][0]
    speeds, fronts = [], []
    for tick in range(550):
        sumo.trafficlight.setRedYellowGreenState(node(sumo), ("r" if tick < 300 else "G") * count)
        ego.step()
        sumo.simulationStep()
        if "ego" not in sumo.vehicle.getIDList():
            break
        speeds.append(sumo.vehicle.getSpeed("ego"))
        fronts.append(sumo.vehicle.getPosition("ego")[0])
    assert max(speeds[:300]) <= 15.7
    assert speeds[295] < 0.1
    assert line - 2.0 <= fronts[295] <= line
    assert max(fronts) > line + 20.0


def test_what_it_sees(simulation: Any, law: RegulationDatabase) -> None:
    sumo, road_map, names = simulation
    sumo.route.add("back", [sumo.lane.getEdgeID(names["east.w.1"]), sumo.lane.getEdgeID(names["west.w.1"])])
    sumo.vehicle.add("rider", "back", typeID="DEFAULT_BIKETYPE", departPos="150", departSpeed="4")
    sumo.simulationStep()
    eye = ScriptedEye(shipped_vocabulary())
    planner = Planner(law, road_map, find_route(road_map, names["west.e.1"], names["east.e.1"]))
    ego = SumoEgo(sumo, "ego", planner, road_map, START, eye.look, "scripted")
    sumo.vehicle.moveToXY("ego", "", -1, -30.0, -1.75, 90.0, 2)
    sumo.simulationStep()
    seen = ego.observe()
    assert [track.kind for track in seen.tracks] == ["bicycle"]
    assert seen.ego.front_bumper(ego.footprint) == pytest.approx((-30.0, -1.75), abs=1.0)
    assert seen.signals
    assert {shown[0].color for shown in seen.signals.values()} == {"red"}
    assert seen.provenance == "scripted"
    assert seen.clock > START
