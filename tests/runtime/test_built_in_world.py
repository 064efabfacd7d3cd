"""The built-in world: the ego follows its plan, others keep apart, stop, give way and pass, and everything is the same for the same seed."""

import math
import time
from dataclasses import replace

import numpy as np
import pytest
from regdb_runtime.errors import WorldError
from regdb_runtime.geometry import boxes, distance, overlap
from regdb_runtime.maps.reference_path import ReferencePath
from regdb_runtime.observation import EgoState, Footprint, Observation, Track
from regdb_runtime.trajectory import Trajectory
from regdb_runtime.worlds.built_in import BuiltInWorld, build
from regdb_runtime.worlds.built_in.contacts import find_contacts
from regdb_runtime.worlds.road_spec import Arm, Control, JunctionSpec, Piece, Pose, RoadSpec, SignalPhase, StreetsSpec
from regdb_runtime.worlds.scene_spec import (
    CyclistSpec,
    EgoSpec,
    EyeSpec,
    FlowSpec,
    ParkedSpec,
    PedestrianSpec,
    SceneSpec,
    SightingSpec,
    VehicleSpec,
)
from standing_ego import standing

AWAY = RoadSpec("away", (Piece(100.0),), Pose(0.0, 900.0))
"""Where the ego stands when others are looked at."""
LONG = StreetsSpec((RoadSpec("main", (Piece(600.0),)), AWAY))
E_W, N_S = SignalPhase(("e", "w"), 20.0), SignalPhase(("n", "s"), 15.0)


def crossing(control: Control, *phases: SignalPhase, side: Control | None = None, lanes: int = 1) -> StreetsSpec:
    setback = 12.0 + 4.0 * lanes
    roads = (
        RoadSpec("main", (Piece(200.0),), Pose(-200.0 - setback), lanes, lanes),
        RoadSpec("on", (Piece(200.0),), Pose(setback), lanes, lanes),
        RoadSpec("south", (Piece(200.0),), Pose(0.0, -setback, 270.0)),
        RoadSpec("north", (Piece(200.0),), Pose(0.0, setback, 90.0)),
        AWAY,
    )
    arms = (Arm("main", "end"), Arm("on", "start"), Arm("south", "start", control=side), Arm("north", "start", control=side))
    return StreetsSpec(roads, (JunctionSpec("junction", arms, control, phases),))


def scene(streets: StreetsSpec, **users: object) -> SceneSpec:
    return SceneSpec("test", streets, EgoSpec("away.e.1", 50.0), **users)  # type: ignore[arg-type]


def run(world: BuiltInWorld, seconds: float) -> list[dict[str, Track]]:
    """Step by 0.1 s with the ego standing; everybody by id at each step."""
    found = []
    for _ in range(round(seconds * 10)):
        world.step(standing(world.ego), "off", 0.1)
        found.append({track.id: track for track in world.tracks()})
    return found


def touching(tracks: dict[str, Track]) -> set[tuple[str, str]]:
    names = list(tracks)
    rows = np.array([[getattr(track, name) for name in ("x", "y", "heading", "length", "width")] for track in tracks.values()]).reshape(-1, 5).T
    pairs = np.triu(overlap(boxes(*rows[:, :, None]), boxes(*rows[:, None, :])), 1)
    return {(names[i], names[j]) for i, j in zip(*np.nonzero(pairs), strict=True)}


def plan_along(path: ReferencePath, begin: float, speeds: np.ndarray, step: float) -> list[Trajectory]:  # type: ignore[type-arg]
    """Plans of 3 s, one every 0.1 s, of one motion with these speeds every `step` seconds."""
    stations = begin + np.concatenate(([0.0], np.cumsum((speeds[1:] + speeds[:-1]) / 2 * step)))
    points, headings, bends = path.to_plane(stations, np.zeros_like(stations)), path.heading(stations), path.curvature(stations)
    pulls = np.gradient(speeds, step)
    plans = []
    for first in range(0, len(speeds) - 151, 5):
        part = slice(first, first + 151, 5)
        rows = (points[part, 0], points[part, 1], headings[part], speeds[part], pulls[part])
        plans.append(Trajectory(np.arange(31) * 5 * step, *rows, np.zeros(31), bends[part], stations[part], np.zeros(31)))
    return plans


def test_the_ego_stays_within_five_centimetres_of_a_plan_that_brakes_turns_and_stops() -> None:
    world = build(SceneSpec("turn", crossing("none"), EgoSpec("main.e.1", 140.0, 12.0, ("right",))))
    lines = [world.road_map.lanes[name].center for name in world.route]
    path = ReferencePath(np.concatenate([lines[0], *(line[1:] for line in lines[1:])]))
    times = np.arange(0.0, 26.0, 0.02)
    speeds = np.interp(times, (0.0, 4.5, 15.0, 18.5, 26.0), (12.0, 4.5, 4.5, 0.0, 0.0))
    worst = 0.0
    for plan in plan_along(path, path.frenet_state(world.ego).s, speeds, 0.02):
        world.step(plan, "right", 0.1)
        worst = max(worst, math.hypot(world.ego.x - plan.x[1], world.ego.y - plan.y[1]))
    assert worst < 0.05
    assert world.ego.speed == 0.0
    assert world.ego.turn_signal == "right"
    assert math.degrees(world.ego.heading) == pytest.approx(-90.0, abs=1.0)


def test_the_ego_cannot_do_what_its_actuators_cannot() -> None:
    world = build(SceneSpec("brake", LONG, EgoSpec("main.e.1", 50.0, 20.0)))
    world.step(standing(world.ego), "off", 1.0)
    assert world.ego.speed >= 20.0 - 8.0 * 1.0 - 1e-9
    assert world.ego.acceleration >= -8.0


def test_the_same_scene_gives_the_same_bytes_and_another_seed_others() -> None:
    flows = tuple(FlowSpec(f"flow_{name}", lane, 600.0) for name, lane in enumerate(("main.e.1", "on.w.1", "south.n.1", "north.s.1")))
    spec = scene(crossing("signal", E_W, N_S), flows=flows, cyclists=(CyclistSpec("cyclist", "main.e.1", 60.0, weave=0.05),), seed=7)
    first, second, other = (build(item) for item in (spec, SceneSpec.from_json(spec.to_json()), replace(spec, seed=8)))
    seen = [repr((run(world, 40.0), world.observe())) for world in (first, second, other)]
    assert seen[0] == seen[1]
    assert seen[0] != seen[2]


def test_a_platoon_settles_behind_a_slow_lead_at_the_gap_of_the_model() -> None:
    cars = tuple(VehicleSpec(f"car_{n}", "main.e.1", 100.0 - 12.0 * n, 8.0, wish=8.0 if n == 0 else 16.0) for n in range(6))
    states = run(build(scene(LONG, vehicles=cars)), 50.0)
    last = states[-1]
    assert all(last[f"car_{n}"].speed == pytest.approx(8.0, abs=0.25) for n in range(6))
    gaps = [last[f"car_{n}"].x - last[f"car_{n + 1}"].x - 4.6 for n in range(5)]
    assert all(2.0 + 8.0 * 1.2 <= gap <= 2.0 + 8.0 * 2.0 for gap in gaps)
    assert not any(touching(state) for state in states)


def test_a_lead_that_brakes_hard_to_a_stand_is_not_hit() -> None:
    cars = (VehicleSpec("lead", "main.e.1", 60.0, 15.0, speeds=((0.0, 15.0), (5.0, 0.0))), VehicleSpec("behind", "main.e.1", 35.0, 15.0, wish=15.0))
    states = run(build(scene(LONG, vehicles=cars)), 40.0)
    assert states[-1]["lead"].speed < 0.2
    assert not any(touching(state) for state in states)
    assert 1.0 < states[-1]["lead"].x - states[-1]["behind"].x - 4.6 < 3.5


def test_cars_stop_before_the_line_at_red_and_go_on_green() -> None:
    world = build(scene(crossing("signal", N_S, E_W), vehicles=(VehicleSpec("car", "main.e.1", 100.0, 14.0, turns=("straight",)),)))
    line = world.road_map.lanes["main.e.1"].stop_line
    assert line is not None
    states = run(world, 35.0)
    fronts = [state["car"].x + 2.3 for state in states]
    waiting = [front for front, state in zip(fronts, states, strict=True) if state["car"].speed < 0.05]
    assert waiting
    assert all(0.2 < line.start[0] - front < 2.5 for front in waiting)
    assert all(front < line.start[0] for front in fronts[:199])
    assert fronts[-1] > 16.0


@pytest.mark.parametrize(("streets", "flow"), [
    (crossing("signal", E_W, N_S, lanes=2), 350.0), (crossing("all_way_stop"), 150.0), (crossing("none", side="stop"), 150.0),
    (crossing("none", side="yield", lanes=2), 120.0), (crossing("none"), 150.0),
], ids=["signal", "all_way_stop", "side_stop", "side_yield", "uncontrolled"])  # fmt: skip
def test_nobody_hits_anybody_at_a_busy_junction_and_traffic_flows(streets: StreetsSpec, flow: float) -> None:
    lanes = ["south.n.1", "north.s.1", *(f"{road}.{number + 1}" for road in ("main.e", "on.w") for number in range(streets.roads[0].forward))]
    flows = tuple(FlowSpec(lane.replace(".", "_"), lane, flow) for lane in lanes)
    walkers = (PedestrianSpec("walker", ((-6.0, -streets.roads[1].start.x - 2.5), (8.0, -streets.roads[1].start.x - 2.5)), starts=30.0),)
    world = build(scene(streets, flows=flows, cyclists=(CyclistSpec("cyclist", "main.e.1", 60.0),), pedestrians=walkers))
    states = run(world, 150.0)
    assert not any(touching(state) for state in states[::2])
    crossed = {name for state in states for name, track in state.items() if math.hypot(track.x, track.y) < 10.0}
    gone = {name for state in states for name in state} - set(states[-1])
    assert len(crossed) > 0.5 * flow * len(lanes) * 150.0 / 3600.0
    assert len(gone) > 0.3 * flow * len(lanes) * 150.0 / 3600.0


def test_nobody_enters_on_red_but_to_turn_right_after_a_stop() -> None:
    flows = tuple(FlowSpec(lane.replace(".", "_"), lane, 500.0) for lane in ("main.e.1", "on.w.1", "south.n.1", "north.s.1"))
    world = build(scene(crossing("signal", E_W, N_S), flows=flows))
    before: dict[str, str] = {}
    entered = 0
    for _ in range(1200):
        world.step(standing(world.ego), "off", 0.1)
        for mover in world._traffic.movers:
            lane = mover.table
            if lane.inner and before.get(mover.id) not in (None, lane.id):
                entered += 1
                shown = {world.signals.color(lane.lights[0], world.time - since) for since in (0.0, 2.0, 4.0, 6.0)}
                assert shown != {"red"} or lane.turn == "right", (mover.id, world.time)
            before[mover.id] = lane.id
    assert entered > 20


def test_a_cyclist_rides_between_ten_and_seventy_centimetres_from_the_edge_at_constant_speed() -> None:
    world = build(scene(LONG, cyclists=(CyclistSpec("cyclist", "main.e.1", 50.0, leaves_at=90.0),)))
    for state in run(world, 8.0):
        rider = state["cyclist"]
        assert rider.speed == pytest.approx(4.5, abs=0.02)
        assert (rider.y - rider.width / 2, rider.y + rider.width / 2) == (pytest.approx(-3.4), pytest.approx(-2.8))
    assert "cyclist" not in run(world, 2.0)[-1]


def test_cars_pass_a_cyclist_at_a_metre_and_come_back() -> None:
    streets = StreetsSpec((RoadSpec("main", (Piece(600.0),), width=3.7), AWAY))
    car = VehicleSpec("car", "main.e.1", 20.0, 13.0, wish=13.0)
    world = build(scene(streets, vehicles=(car,), cyclists=(CyclistSpec("cyclist", "main.e.1", 70.0),)))
    nearest = math.inf
    for state in (states := run(world, 30.0)):
        both = state["car"], state["cyclist"]
        if abs(both[0].x - both[1].x) < 3.0:
            nearest = min(nearest, float(distance(*(boxes(item.x, item.y, item.heading, item.length, item.width) for item in both))))
    assert 0.9144 <= nearest < 1.6
    assert states[-1]["car"].x > states[-1]["cyclist"].x + 20.0
    assert states[-1]["car"].y == pytest.approx(-1.85, abs=0.05)


def test_a_pedestrian_stands_walks_when_the_ego_is_near_and_stands_again() -> None:
    walker = PedestrianSpec("walker", ((60.0, -5.0), (60.0, 5.0)), speed=1.25, when_near=30.0)
    world = build(SceneSpec("walk", LONG, EgoSpec("main.e.1", 10.0, 10.0), pedestrians=(walker,)))
    path = ReferencePath(world.road_map.lanes["main.e.1"].center)
    speeds = np.interp(np.arange(0.0, 20.0, 0.02), (0.0, 2.0, 5.0, 20.0), (10.0, 10.0, 0.0, 0.0))
    seen = []
    for plan in plan_along(path, 10.0, speeds, 0.02):
        world.step(plan, "off", 0.1)
        seen.append((world.ego.front_bumper(world.footprint)[0], world.tracks()[0]))
    started = next(front for front, track in seen if track.speed > 0.0)
    assert 30.0 <= started < 32.0
    assert seen[-1][1].y == pytest.approx(5.0)
    assert seen[-1][1].speed == 0.0
    assert not world.contacts


def test_children_walk_back_and_forth() -> None:
    child = PedestrianSpec("child", ((0.0, 0.0), (4.0, 0.0), (4.0, 3.0)), speed=1.0, back_and_forth=True)
    states = run(build(scene(LONG, pedestrians=(child,))), 14.0)
    places = {round(0.1 * (index + 1)): (track["child"].x, track["child"].y) for index, track in enumerate(states) if (index + 1) % 10 == 0}
    assert places[4] == (pytest.approx(4.0), pytest.approx(0.0, abs=1e-6))
    assert places[7] == (pytest.approx(4.0), pytest.approx(3.0))
    assert places[9] == (pytest.approx(4.0), pytest.approx(1.0))
    assert places[14] == (pytest.approx(0.0, abs=1e-6), pytest.approx(0.0, abs=1e-6))


def test_the_ego_sees_what_is_near_the_lights_that_face_it_and_the_clock() -> None:
    spec = SceneSpec(
        "seen", crossing("signal", N_S, E_W), EgoSpec("main.e.1", 140.0), start="2026-03-04T23:59:58", sensor_range=50.0,
        vehicles=(VehicleSpec("near", "main.e.1", 170.0, 0.0, wish=0.1), VehicleSpec("far", "on.e.1", 150.0)),
        parked=(ParkedSpec("police", "main.e.1", 150.0, -3.2, warning_lights="emergency_lights", hazard_kind="emergency"),),
        eye=EyeSpec(sightings=(SightingSpec({"sign.school": True}),)),
    )  # fmt: skip
    world = build(spec)
    run(world, 3.0)
    seen: Observation = world.observe()
    assert [track.id for track in seen.tracks] == ["near", "police"]
    assert seen.tracks[1].warning_lights == "emergency_lights"
    assert {name: (shown[0].color, shown[0].shape) for name, shown in seen.signals.items()} == {"junction.e.light": ("red", "circular")}
    assert seen.clock.isoformat() == "2026-03-05T00:00:01"
    assert seen.facts["sign.school"] is True
    assert seen.provenance == "scripted"


@pytest.mark.parametrize(("ego_speed", "other", "by", "part"), [
    (5.0, Track("o", "car", 6.0, 0.0, 0.0, 0.0, 4.6, 1.8), "ego", "front"),
    (0.0, Track("o", "car", -3.1, 0.0, 0.0, 4.0, 4.6, 1.8), "other", "rear"),
    (5.0, Track("o", "car", 6.0, 0.0, math.pi, 5.0, 4.6, 1.8), "both", "front"),
    (5.0, Track("o", "car", 1.5, -3.0, math.pi / 2, 5.0, 4.6, 1.8), "other", "side"),
    (5.0, Track("o", "pedestrian", 3.9, 0.5, math.pi / 2, 1.0, 0.5, 0.5), "ego", "front"),
])  # fmt: skip
def test_a_contact_says_who_struck_whom(ego_speed: float, other: Track, by: str, part: str) -> None:
    found = find_contacts(1.0, EgoState(0.0, 0.0, 0.0, ego_speed), Footprint(), [other])
    assert [(item.by, item.part) for item in found] == [(by, part)]


def test_a_contact_is_noted_once() -> None:
    spec = SceneSpec("hit", LONG, EgoSpec("main.e.1", 50.0, 10.0), parked=(ParkedSpec("car", "main.e.1", 70.0, 0.0),))
    world = build(spec)
    path = ReferencePath(world.road_map.lanes["main.e.1"].center)
    for plan in plan_along(path, 50.0, np.full(400, 10.0), 0.02):
        world.step(plan, "off", 0.1)
    assert [(item.other, item.by) for item in world.contacts] == [("car", "ego")]
    assert world.contacts[0].time == pytest.approx(1.4, abs=0.11)


@pytest.mark.parametrize(("change", "said"), [
    ({"ego": EgoSpec("main.e.9")}, "no lane 'main.e.9'"), ({"ego": EgoSpec("main.e.1", 900.0)}, "600.0 m long"),
    ({"start": "noon"}, "'noon' is no date"), ({"parked": (ParkedSpec("a", "main.e.1", 5.0, 0.0),) * 2}, "called 'a'"),
    ({"flows": (FlowSpec("f", "main.e.4"),)}, "f: there is no lane"),
])  # fmt: skip
def test_a_scene_that_does_not_fit_together_is_named(change: dict[str, object], said: str) -> None:
    with pytest.raises(WorldError, match=said):
        build(replace(scene(LONG), **change))  # type: ignore[arg-type]


def test_a_step_with_twenty_vehicles_takes_under_a_millisecond() -> None:
    cars = tuple(VehicleSpec(f"car_{n}", f"main.{'e' if n % 2 else 'w'}.1", 20.0 + 14.0 * n, 10.0) for n in range(20))
    world = build(scene(StreetsSpec((RoadSpec("main", (Piece(2000.0),)), AWAY)), vehicles=cars))
    plan = standing(world.ego)
    taken = []
    for _ in range(200):
        begin = time.perf_counter()
        world.step(plan, "off", 0.1)
        taken.append(time.perf_counter() - begin)
    assert len(world.tracks()) == 20
    assert sorted(taken)[20] < 1e-3
