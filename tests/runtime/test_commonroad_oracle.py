"""Our reading of every scenario beside commonroad-io's, which runs in an environment of its own (made on first use, kept under out/)."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from regdb_runtime.maps.commonroad import read_commonroad
from regdb_runtime.maps.commonroad_lanes import MARKINGS, MIRRORED, snake_case
from regdb_runtime.maps.commonroad_signs import COLORS, DIRECTIONS
from regdb_runtime.maps.commonroad_traffic import read_traffic
from regdb_runtime.maps.recorded_traffic import RecordedTraffic
from regdb_runtime.maps.road_map import Lane, Light, RoadMap

ROOT = Path(__file__).resolve().parents[2]
SCENARIOS = ROOT.parent / "shared" / "scenarios"
ORACLE = ROOT / "tests" / "oracles" / "commonroad_io.py"
RELEASE = "commonroad-io==2026.1"
VIRTUAL_SIGNS_OF_2018B = 10_000
"""commonroad-io puts a sign of its own for each 2018b speed limit, with ids above all others."""


def oracle_python(tmp_path: Path) -> Path:
    """The interpreter of the oracle's environment; built beside and moved into place, so that a broken try leaves nothing."""
    home = ROOT / "out" / "oracles" / RELEASE.replace("==", "-")
    if not (home / "ready").is_file():
        made = tmp_path / "environment"
        subprocess.run([sys.executable, "-m", "venv", "--without-pip", made], check=True)
        command = [sys.executable, "-m", "pip", "--python", str(made / "bin" / "python"), "install", "--quiet", "--no-compile", RELEASE]
        done = subprocess.run(command, capture_output=True, text=True, timeout=400, check=False)
        if done.returncode:
            pytest.skip(f"{RELEASE} cannot be installed: {done.stderr.strip().splitlines()[-1]}")
        (made / "ready").write_text(RELEASE)
        home.parent.mkdir(parents=True, exist_ok=True)
        shutil.rmtree(home, ignore_errors=True)
        shutil.move(made, home)
    return home / "bin" / "python"


def test_every_scenario_reads_as_commonroad_io_reads_it(tmp_path: Path) -> None:
    files = sorted(SCENARIOS.glob("*.xml"))
    if not files:
        pytest.skip(f"the scenarios are not there: {SCENARIOS}")
    environment = {**os.environ, "PYTHONDONTWRITEBYTECODE": "1", "PYTHONPATH": ""}
    command = [str(oracle_python(tmp_path)), str(ORACLE), *map(str, files)]
    dump = subprocess.run(command, capture_output=True, text=True, timeout=300, check=True, env=environment).stdout
    theirs: dict[str, Any] = json.loads(dump)
    assert len(theirs) == len(files)
    differences = [f"{Path(file).name}: {text}" for file, wanted in theirs.items() for text in compare(file, wanted)]
    assert not differences, "\n".join(differences[:40])


def compare(file: str, wanted: dict[str, Any]) -> Iterator[str]:
    road_map, traffic = read_commonroad(file), read_traffic(file)
    yield from differing("lanes", sorted(road_map.lanes), sorted(wanted["lanes"]))
    for name, lane in road_map.lanes.items():
        yield from compare_lane(lane, wanted["lanes"][name], road_map)
    signs = {name: sign for name, sign in wanted["signs"].items() if int(name) < VIRTUAL_SIGNS_OF_2018B or name in road_map.signs}
    yield from compare_signs(road_map, signs)
    yield from differing("lights", sorted(road_map.lights), sorted(wanted["lights"]))
    for name, light in road_map.lights.items():
        yield from compare_light(light, wanted["lights"][name], wanted["time_step"])
    yield from compare_junctions(road_map, wanted["intersections"])
    yield from compare_traffic(traffic, wanted)


def differing(what: str, ours: object, theirs: object) -> Iterator[str]:
    if ours != theirs:
        yield f"{what}: {ours} here, {theirs} there"


def apart(what: str, ours: object, theirs: object, within: float = 1e-9) -> Iterator[str]:
    first, second = np.asarray(ours, float), np.asarray(theirs, float)
    if first.shape != second.shape or not np.allclose(first, second, rtol=0.0, atol=within, equal_nan=True):
        yield f"{what}: {first.tolist()} here, {second.tolist()} there"


def compare_lane(lane: Lane, wanted: dict[str, Any], road_map: RoadMap) -> Iterator[str]:
    place = f"lane {lane.id}"
    yield from apart(f"{place} left line", lane.left_line, wanted["left"])
    yield from apart(f"{place} right line", lane.right_line, wanted["right"])
    yield from apart(f"{place} centre", lane.center, wanted["center"])
    yield from differing(f"{place} predecessors", sorted(lane.predecessors), wanted["predecessors"])
    yield from differing(f"{place} successors", sorted(lane.successors), wanted["successors"])
    ours = (lane.left, lane.left_same_direction, lane.right, lane.right_same_direction)
    theirs = (wanted["adjacent_left"], bool(wanted["left_same"]), wanted["adjacent_right"], bool(wanted["right_same"]))
    yield from differing(f"{place} neighbours", ours, theirs)
    yield from compare_markings(lane, wanted, road_map)
    yield from differing(f"{place} kinds", lane.kinds, frozenset(map(snake_case, wanted["kinds"])) - {"unknown"})
    yield from differing(f"{place} users", lane.users, frozenset(map(snake_case, wanted["users"])))
    yield from differing(f"{place} users both ways", lane.users_both_ways, frozenset(map(snake_case, wanted["both_ways"])))
    yield from differing(f"{place} limit", lane.speed_limit, wanted["limit"])
    yield from differing(f"{place} lights", sorted(lane.lights), wanted["lights"])
    posts = {name.partition("/")[0] for name in lane.signs}
    yield from differing(f"{place} signs", sorted(posts), [name for name in wanted["signs"] if name in road_map.signs])
    yield from compare_stop_line(lane, wanted["stop_line"], road_map)


def compare_markings(lane: Lane, wanted: dict[str, Any], road_map: RoadMap) -> Iterator[str]:
    """What the file says of a side; where it says nothing, unknown or what it says of the same line for the neighbour."""
    for side, ours, other in (("left", lane.left_marking, lane.left), ("right", lane.right_marking, lane.right)):
        marking = MARKINGS[wanted[f"{side}_marking"]]
        if marking == "unknown":
            if ours != "unknown" and (other is None or ours not in (road_map.lanes[other].left_marking, road_map.lanes[other].right_marking)):
                yield f"lane {lane.id}: {ours} on the {side} out of nothing"
        else:
            yield from differing(f"lane {lane.id} {side} marking", ours, MIRRORED.get(marking, marking) if side == "left" else marking)


def compare_stop_line(lane: Lane, wanted: dict[str, Any] | None, road_map: RoadMap) -> Iterator[str]:
    line = lane.stop_line
    if line is None or wanted is None:
        yield from differing(f"stop line of {lane.id}", line, wanted)
        return
    yield from apart(f"stop line of {lane.id}", (line.start, line.end), (wanted["start"], wanted["end"]))
    yield from differing(f"marking of {line.id}", line.marked, wanted["marking"] != "no_marking")
    yield from differing(f"lights of {line.id}", sorted(line.lights), [name for name in wanted["lights"] if name in road_map.lights])
    yield from differing(f"signs of {line.id}", sorted(line.signs), wanted["signs"])


def compare_signs(road_map: RoadMap, wanted: dict[str, Any]) -> Iterator[str]:
    plates = {f"{name}/{place}" if place > 1 else name: plate for name, post in wanted.items() for place, plate in enumerate(post["plates"], 1)}
    yield from differing("signs", sorted(road_map.signs), sorted(plates))
    for name, sign in road_map.signs.items():
        code, meaning, values = plates[name]
        yield from differing(f"sign {name} values", list(sign.values), values)
        yield from differing(f"sign {name} speed", sign.speed, float(values[0]) if meaning == "MAX_SPEED" else None)
        if not sign.code[0].isdigit():  # commonroad-io writes German codes of other countries' files anew
            yield from differing(f"sign {name} code", sign.code, code)
        if sign.position is not None:
            yield from apart(f"sign {name} position", sign.position, wanted[name.partition("/")[0]]["position"])


def compare_light(light: Light, wanted: dict[str, Any], time_step: float) -> Iterator[str]:
    place = f"light {light.id}"
    yield from differing(f"{place} direction", light.direction, DIRECTIONS.get(wanted["direction"], wanted["direction"]))
    yield from differing(f"{place} active", light.active, wanted["active"])
    yield from apart(f"{place} position", light.position, wanted["position"])
    yield from differing(f"{place} colours", [phase.color for phase in light.cycle], [COLORS[color] for color, _ in wanted["cycle"]])
    yield from apart(f"{place} durations", [phase.duration for phase in light.cycle], [steps * time_step for _, steps in wanted["cycle"]])
    yield from apart(f"{place} offset", light.offset, wanted["offset"] * time_step)


def compare_junctions(road_map: RoadMap, wanted: dict[str, Any]) -> Iterator[str]:
    named = {name: junction for name, junction in road_map.junctions.items() if not junction.derived}
    yield from differing("intersections", sorted(named), sorted(wanted))
    for name, junction in named.items():
        theirs = [(part["id"], part["lanes"]) for part in wanted[name]]
        yield from differing(f"approaches of {name}", [(part.id, sorted(part.lanes)) for part in junction.approaches], theirs)
        for part in wanted[name]:
            for turn in ("right", "straight", "left"):
                for lane in part[turn]:
                    yield from differing(f"turn of lane {lane}", (road_map.lanes[lane].junction, road_map.lanes[lane].turn), (name, turn))


def compare_traffic(traffic: RecordedTraffic, wanted: dict[str, Any]) -> Iterator[str]:
    yield from differing("time step", traffic.time_step, wanted["time_step"])
    obstacles = {item.id: item for item in traffic.obstacles}
    yield from differing("obstacles", sorted(obstacles), sorted(wanted["obstacles"]))
    for name, item in obstacles.items():
        there = wanted["obstacles"][name]
        yield from differing(f"obstacle {name}", (item.source_kind, item.static), (there["type"], there["static"]))
        yield from apart(f"size of obstacle {name}", (item.length, item.width), (there["length"], there["width"]))
        states = np.array([[np.nan if value is None else value for value in state] for state in there["states"]], float)
        yield from apart(f"steps of obstacle {name}", item.steps, states[:, 0])
        yield from apart(f"places of obstacle {name}", np.column_stack((item.x, item.y)), states[:, 1:3])
        yield from apart(f"headings of obstacle {name}", np.exp(1j * item.heading).view(float), np.exp(1j * states[:, 3]).view(float))
        yield from apart(f"speeds of obstacle {name}", item.speed, states[:, 4])
        given = ~np.isnan(item.acceleration)  # where the file gives none, commonroad-io puts 0 at the first state
        yield from apart(f"accelerations of obstacle {name}", item.acceleration[given], states[given, 5])
    problems = {one.id: [one.step, one.x, one.y, one.heading, one.speed] for one in traffic.problems}
    yield from differing("planning problems", sorted(problems), sorted(wanted["problems"]))
    for name, ours in problems.items():
        yield from apart(f"planning problem {name}", ours, wanted["problems"][name])
