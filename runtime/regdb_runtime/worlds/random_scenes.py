"""Random but valid scenes from a seed: streets, signals, traffic, cyclists, pedestrians, school zones; a failing one is kept as JSON."""

from __future__ import annotations

import math
import random
from dataclasses import dataclass, replace

from regdb.units import to_si
from regdb_runtime.maps.road_map import Marking, Turn
from regdb_runtime.worlds.built_in.build import build
from regdb_runtime.worlds.curves import curve, middle_line, straight
from regdb_runtime.worlds.road_spec import Arm, Control, JunctionSpec, Piece, Pose, RoadSpec, SignalPhase, SignSpec, StreetsSpec, ZoneSpec
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
from regdb_runtime.worlds.streets import compass

__all__ = ["build", "random_scene"]

LIMITS = (25.0, 30.0, 35.0, 40.0, 45.0)
"""Posted limits that streets have, mph."""
SIDE = 160.0
"""Length of the roads that cross, metres."""


@dataclass(frozen=True)
class _Street:
    """The ego's road up to the junction (or to its end), and what was drawn for it."""

    road: RoadSpec
    length: float
    end: Pose
    lanes: int
    limit: float


def random_scene(seed: int) -> SceneSpec:
    """The scene of a seed: the same for ever, and different enough from its neighbours."""
    chance = random.Random(f"scene {seed}")
    street = _street(chance)
    streets, turns = _streets(chance, street)
    lane = f"main.{_first_compass(street)}.{chance.randint(1, street.lanes)}"
    spec = SceneSpec(
        f"random_{seed}", streets, EgoSpec(lane, 12.0, round(chance.uniform(0.4, 1.0) * street.limit, 2), turns), seed=seed,
        start=f"2026-03-04T{chance.choice((7, 10, 12, 14, 15)):02d}:30:00",
    )  # fmt: skip
    spec = _with_school(chance, spec, street)
    spec = _with_users(chance, spec, street, lane)
    return replace(spec, eye=replace(spec.eye, kind="none") if chance.random() < 0.08 else spec.eye)


def _street(chance: random.Random) -> _Street:
    """Straight or curved, one or two lanes each way, broken or solid in the middle."""
    pieces: list[Piece] = [straight(round(chance.uniform(80, 160), 1))]
    if chance.random() < 0.4:
        pieces.append(curve(chance.choice((-1, 1)) * chance.uniform(15, 60), chance.uniform(60, 160)))
    pieces.append(straight(round(chance.uniform(80, 200), 1)))
    lanes = chance.choice((1, 1, 2))
    limit = round(to_si(chance.choice(LIMITS), "mph"), 4)
    center: Marking = "double_solid" if lanes == 2 else chance.choice(("dashed", "dashed", "double_solid", "solid_dashed"))
    road = RoadSpec(
        "main", tuple(pieces), Pose(), lanes, lanes, chance.choice((3.3, 3.5, 3.7)), limit, center,
        bicycle_lane=1.6 if chance.random() < 0.2 else 0.0, parking_lane=2.4 if chance.random() < 0.3 else 0.0,
        facts={"district.residence": chance.random() < 0.4},
    )  # fmt: skip
    points, headings = middle_line(road.start, road.pieces)
    end = Pose(float(points[-1, 0]), float(points[-1, 1]), math.degrees(float(headings[-1])))
    return _Street(road, sum(piece.length for piece in pieces), end, lanes, limit)


def _streets(chance: random.Random, street: _Street) -> tuple[StreetsSpec, tuple[Turn, ...]]:
    """The street alone, or with a junction at its end: four arms or three, with lights, signs or nothing."""
    signs = (SignSpec("limit", "R2-1", "main", 5.0, speed=street.limit, values=(f"{street.limit / 0.44704:.0f}",)),)
    jurisdiction = chance.choice(("los_angeles", "los_angeles", "los_angeles_county", "california"))
    if chance.random() < 0.25:
        return StreetsSpec((street.road,), (), signs, (), jurisdiction), ()
    half = street.lanes * street.road.width + street.road.bicycle_lane + street.road.parking_lane + 9.0
    control: Control = chance.choice(("signal", "signal", "signal", "stop", "all_way_stop", "none"))
    sides = ["left", "right", "ahead"]
    if chance.random() < 0.3:
        sides.remove(chance.choice(sides))
    roads = [_arm_road(side, street, half) for side in sides]
    priority = control == "stop" and chance.random() < 0.5
    arms = [Arm("main", "end", control="none" if priority and "ahead" in sides else None)]
    arms += [Arm(side, "start", control="none" if _keeps_way(side, sides, priority, control) else None) for side in sides]
    if control == "signal" and chance.random() < 0.3:
        arms[0] = replace(arms[0], arrows=("right",) if "right" in sides else ("left",))
    junction = _phased(chance, JunctionSpec("junction", tuple(arms), control), street, sides)
    names: dict[str, Turn] = {"left": "left", "right": "right", "ahead": "straight"}
    turn = names[chance.choice(sides)]
    return StreetsSpec((street.road, *roads), (junction,), signs, (), jurisdiction), (turn,)


def _keeps_way(side: str, sides: list[str], priority: bool, control: Control) -> bool:
    """Whether an arm has no sign: the main road's where it has priority, else the crossing road's."""
    if control != "stop":
        return False
    return side == "ahead" if priority and "ahead" in sides else side != "ahead"


def _arm_road(side: str, street: _Street, half: float) -> RoadSpec:
    """A road that leads away from the junction: on with as many lanes, across with one each way."""
    heading = math.radians(street.end.degrees)
    x, y = street.end.x + half * math.cos(heading), street.end.y + half * math.sin(heading)
    turn = {"left": 90.0, "right": -90.0, "ahead": 0.0}[side]
    away = heading + math.radians(turn)
    start = Pose(x + half * math.cos(away), y + half * math.sin(away), street.end.degrees + turn)
    lanes = street.lanes if side == "ahead" else 1
    limit = street.limit if side == "ahead" else min(street.limit, round(to_si(30.0, "mph"), 4))
    bicycle_lane = street.road.bicycle_lane if side == "ahead" else 0.0
    return RoadSpec(side, (Piece(SIDE),), start, lanes, lanes, street.road.width, limit, "double_solid", bicycle_lane=bicycle_lane)


def _phased(chance: random.Random, junction: JunctionSpec, street: _Street, sides: list[str]) -> JunctionSpec:
    """Two phases, one for each road, and one for the arrow where there is one; begun anywhere in the round."""
    if junction.control != "signal":
        return junction
    heading = math.radians(street.end.degrees)
    ahead, back = compass(heading), compass(heading + math.pi)
    left, right = compass(heading - math.pi / 2), compass(heading + math.pi / 2)
    arrow = tuple(f"{ahead}.{turn}" for turn in junction.arms[0].arrows)
    main = (ahead, *([back] if "ahead" in sides else []))
    cross = tuple(name for side, name in (("left", left), ("right", right)) if side in sides)
    right_arrow = tuple(name for name in arrow if name.endswith("right"))
    phases = [SignalPhase(main, chance.uniform(10, 25)), SignalPhase((*cross, *right_arrow), chance.uniform(8, 18))]
    if arrow and arrow[0].endswith("left"):
        phases.append(SignalPhase(arrow, 8.0))
    return replace(junction, phases=tuple(replace(phase, green=round(phase.green, 1)) for phase in phases), offset=round(chance.uniform(0, 40), 1))


def _first_compass(street: _Street) -> str:
    return "e" if street.road.start.degrees == 0.0 else ""


def _with_school(chance: random.Random, spec: SceneSpec, street: _Street) -> SceneSpec:
    """In every fourth scene a school beside the street, with or without its sign and children, its limit told by the eye."""
    if chance.random() >= 0.25:
        return spec
    begin = round(chance.uniform(60.0, street.length - 90.0), 1)
    points, headings = middle_line(street.road.start, street.road.pieces)
    index = min(len(points) - 1, round((begin + 40.0) / street.length * (len(points) - 1)))
    heading, reach = float(headings[index]), spec.streets.roads[0].width * street.lanes + 20.0
    landmark = (float(points[index, 0]) + reach * math.sin(heading), float(points[index, 1]) - reach * math.cos(heading))
    zone = ZoneSpec(
        "school", "school", "main", begin, begin + 80.0, distance_fact="school.distance", landmark=landmark,
        facts={"school.present": True, "school.zone": "marked", "zone.posted_outside": f"{street.limit / 0.44704:.0f} mph"},
    )  # fmt: skip
    seen: dict[str, object] = {"sign.school": chance.random() < 0.8, "school.children_going": chance.random() < 0.7}
    sighting = SightingSpec(seen, (float(points[index, 0]), float(points[index, 1])), 130.0)
    return replace(spec, streets=replace(spec.streets, zones=(zone,)), eye=EyeSpec(sightings=(sighting,)))


def _with_users(chance: random.Random, spec: SceneSpec, street: _Street, ego_lane: str) -> SceneSpec:
    lanes = [f"main.{_first_compass(street)}.{number}" for number in range(1, street.lanes + 1)]
    vehicles = []
    for lane in lanes:
        station = 12.0
        for number in range(chance.choice((0, 0, 1, 2))):
            station += chance.uniform(25.0, 60.0)
            wish = chance.choice((None, None, round(chance.uniform(4.0, 10.0), 1)))
            speed = round(0.6 * street.limit if wish is None else wish, 2)
            vehicles.append(VehicleSpec(f"car_{lane[-1]}_{number}", lane, round(station, 1), speed, wish))
    cyclists: tuple[CyclistSpec, ...] = ()
    if chance.random() < 0.4:
        cyclists = (CyclistSpec("cyclist", lanes[0], round(chance.uniform(90.0, 120.0), 1), round(chance.uniform(3.0, 5.5), 1)),)
        vehicles = [item for item in vehicles if item.lane != lanes[0] or item.station < 80.0 or item.station > 130.0]
    flows = tuple(
        FlowSpec(f"flow_{name.replace('.', '_')}", name, round(chance.uniform(100.0, 500.0)))
        for name in _entries(spec.streets) if name not in lanes and chance.random() < 0.6
    )  # fmt: skip
    spec = replace(spec, vehicles=tuple(vehicles), cyclists=cyclists, flows=flows)
    return _with_people(chance, _with_parked(chance, spec, street, ego_lane), street)


def _entries(streets: StreetsSpec) -> list[str]:
    """Lanes at which traffic comes in from beyond the map, from the shape of the streets alone."""
    found = []
    for road in streets.roads:
        _, headings = middle_line(road.start, road.pieces)
        if road.id != "main" or not streets.junctions:
            found += [f"{road.id}.{compass(float(headings[-1]) + math.pi)}.{number}" for number in range(1, road.backward + 1)]
    return found


def _with_parked(chance: random.Random, spec: SceneSpec, street: _Street, ego_lane: str) -> SceneSpec:
    """Cars in the parking lane; now and then one that stands beside the road with its warning lights on."""
    road, lane = street.road, ego_lane[:-1] + "1"
    parked: list[ParkedSpec] = []
    if road.parking_lane > 0.0:
        offset = -(road.width / 2 + road.bicycle_lane + road.parking_lane / 2 + 0.1)
        station = chance.uniform(30.0, 60.0)
        while station < street.length - 25.0 and len(parked) < 8:
            parked.append(ParkedSpec(f"parked_{len(parked)}", lane, round(station, 1), round(offset, 2)))
            station += chance.uniform(7.0, 40.0)
    elif chance.random() < 0.15:
        offset = -(road.width / 2 + road.bicycle_lane + 1.2)
        station = round(chance.uniform(80.0, street.length - 40.0), 1)
        parked.append(ParkedSpec("police", lane, station, round(offset, 2), "car", 5.0, 1.9, "emergency_lights", "emergency"))
    return replace(spec, parked=tuple(parked))


def _with_people(chance: random.Random, spec: SceneSpec, street: _Street) -> SceneSpec:
    """Somebody who crosses at the junction's crosswalk as the ego nears, or walks beside the road."""
    road = street.road
    heading = math.radians(street.end.degrees)
    ahead, left = (math.cos(heading), math.sin(heading)), (-math.sin(heading), math.cos(heading))
    reach = road.width * street.lanes + road.bicycle_lane + road.parking_lane + 1.5
    if spec.streets.junctions and spec.streets.junctions[0].control in ("signal", "stop", "all_way_stop") and chance.random() < 0.3:
        x, y = street.end.x - 2.5 * ahead[0], street.end.y - 2.5 * ahead[1]
        path = ((x - reach * left[0], y - reach * left[1]), (x + reach * left[0], y + reach * left[1]))
        walker = PedestrianSpec("walker", path, round(chance.uniform(1.0, 1.6), 1), when_near=round(chance.uniform(20.0, 45.0), 1))
        return replace(spec, pedestrians=(walker,))
    if chance.random() < 0.2:
        return replace(spec, pedestrians=(PedestrianSpec("walker", ((10.0, -reach - 1.0), (70.0, -reach - 1.0)), back_and_forth=True),))
    return spec
