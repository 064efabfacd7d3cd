"""The paper's scene as data (section IV-A): two lanes at 35 mph with a cyclist, a right turn at a red light, a road past a school.

The paper names no street and no day. Its cyclist figure fits the text of 21760 from 2023 and not only the older one it quotes: the vehicle
changes lanes over a dashed line to pass and comes back, which the older text allows and the newer one asks for. The day of the whole drive is
therefore in 2026, a Monday on which children go to school; variants look at other days.

First road east, junction, school road south; lengths in metres of the first road and of the school road from their beginnings.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from regdb.units import to_si
from regdb_runtime.maps.road_map import Marking, Turn
from regdb_runtime.worlds.road_spec import (
    Arm,
    JunctionSpec,
    Piece,
    Pose,
    RoadSpec,
    SignalPhase,
    SignSpec,
    StreetsSpec,
    ZoneSpec,
)  # fmt: skip
from regdb_runtime.worlds.scene_spec import CyclistSpec, EgoSpec, EyeSpec, FlowSpec, PedestrianSpec, SceneSpec, SightingSpec, VehicleSpec

Part = Literal["whole", "cyclist", "red", "school"]
Light = Literal["red", "red_arrow", "green"]
SchoolLaw = Literal["school_sign", "no_sign", "limit_20", "children_sign", "band"]

MPH_35 = to_si(35, "mph")
MPH_30 = to_si(30, "mph")
HALF = 16.0
"""From the junction's middle to the mouths of its roads: room for two crosswalks and a right turn of 10 m radius at 3.5 m lanes."""
FIRST = {"whole": 460.0, "cyclist": 520.0, "red": 150.0, "school": 0.0}
"""Length of the first road, by part."""
SCHOOL_ROAD = {"whole": 460.0, "cyclist": 0.0, "red": 170.0, "school": 460.0}
"""Length of the school road, by part."""
ZONE = 170.0, 330.0
"""The stretch of the school road that passes the school, its grounds and the approach its signs mark."""
SIDE = 200.0
"""Length of the roads that only cross traffic uses."""
EXTENT = 152.4
"""500 ft, the reach of a school zone whose signs name none (22352 as of 2031); the band of 22358.4 lies between it and twice it."""
_READ: Mapping[SchoolLaw, tuple[str, ...]] = {
    "school_sign": ("sign.school",), "no_sign": (), "limit_20": ("sign.school", "sign.school_limit"),
    "children_sign": ("sign.school", "sign.school_children_present"), "band": ("sign.school_limit",),
}  # fmt: skip
"""The signs that stand by the school's road."""
_SIGHT = 120.0
"""Metres at which the scripted eye reads a sign or makes out children."""


@dataclass(frozen=True)
class PaperScene:
    """What varies between the paper's scene and its variants; the defaults are the paper's own drive.

    `lanes` in each direction of the first road, `width` of each, `divider` between them and `center` in the middle of the road. `beside`: traffic
    in the second lane, before and behind, as the cyclist is met. `light`: what the ego meets; `no_turn_sign`, `pedestrian` and `cross_traffic` at it.
    `school`: which law the school's signs and the city's acts invoke.
    """

    part: Part = "whole"
    start: str = "2026-03-02T07:40:00"
    jurisdiction: str = "los_angeles"
    lanes: int = 2
    width: float = 3.5
    divider: Marking = "dashed"
    center: Marking = "double_solid"
    cyclist: bool = True
    beside: bool = True
    light: Light = "red"
    no_turn_sign: bool = False
    pedestrian: bool = False
    cross_traffic: bool = False
    school: SchoolLaw = "school_sign"
    children: bool = True
    eye: Literal["scripted", "recorded", "none"] = "scripted"
    misses: tuple[str, ...] = ()
    seed: int = 1
    facts: Mapping[str, object] = field(default_factory=dict)


def scene_spec(scene: PaperScene, name: str = "paper") -> SceneSpec:
    """The scene as the worlds take it."""
    return SceneSpec(
        name=name, streets=_streets(scene), ego=_ego(scene), start=scene.start, seed=scene.seed, vehicles=_vehicles(scene), flows=_flows(scene),
        cyclists=_cyclists(scene), pedestrians=_pedestrians(scene), eye=EyeSpec(scene.eye, _sightings(scene), misses=scene.misses),
    )  # fmt: skip


def _has_junction(scene: PaperScene) -> bool:
    return scene.part in ("whole", "red")


def _streets(scene: PaperScene) -> StreetsSpec:
    roads, junctions = [], []
    if scene.part != "school":
        roads.append(_first_road(scene))
    if _has_junction(scene):
        roads += [
            RoadSpec("ahead", (Piece(SIDE),), Pose(2 * HALF, 0.0, 0.0), 2, 2, scene.width, MPH_35, "double_solid"),
            RoadSpec("north", (Piece(SIDE),), Pose(HALF, HALF + SIDE, 270.0), 1, 1, 3.5, MPH_35, "double_solid"),
        ]
        junctions.append(_junction(scene))
    if scene.part != "cyclist":
        roads.append(_school_road(scene))
    zones = (_zone(scene),) if SCHOOL_ROAD[scene.part] > ZONE[1] else ()
    return StreetsSpec(tuple(roads), tuple(junctions), _signs(scene), zones, scene.jurisdiction, scene.facts)


def _first_road(scene: PaperScene) -> RoadSpec:
    length = FIRST[scene.part]
    return RoadSpec(
        "first", (Piece(length),), Pose(-length, 0.0, 0.0), scene.lanes, scene.lanes, scene.width, MPH_35, scene.center, scene.divider
    )  # fmt: skip


def _school_road(scene: PaperScene) -> RoadSpec:
    facts = {"district.residence": "true"} if scene.school == "band" else {}
    return RoadSpec("school", (Piece(SCHOOL_ROAD[scene.part]),), Pose(HALF, -HALF, 270.0), 1, 1, 3.5, _posted(scene), "double_solid", facts=facts)


def _posted(scene: PaperScene) -> float:
    """What the school's road is posted: the band of 22358.4 needs 30 mph or less."""
    return MPH_30 if scene.school == "band" else MPH_35


def _junction(scene: PaperScene) -> JunctionSpec:
    arrows: tuple[Turn, ...] = ("right",) if scene.light == "red_arrow" else ()
    arms = (
        Arm("first", "end", arrows=arrows, right_turn_lane=bool(arrows)),
        Arm("ahead", "start"),
        Arm("north", "end"),
        Arm("school", "start"),
    )  # fmt: skip
    along = ("e", "w", *(("e.right",) if arrows else ()))
    crossing = SignalPhase(("n", "s"), 60.0)
    phases = (SignalPhase(along, 40.0), crossing)
    return JunctionSpec("junction", arms, "signal", phases, offset=_offset(scene, phases))


def _offset(scene: PaperScene, phases: tuple[SignalPhase, ...]) -> float:
    """How far into the cycle the run begins, so that the ego meets what it is to meet: green lasts for the first phase."""
    if scene.light == "green":
        return 0.0 if scene.part == "red" else phases[0].green / 2
    first = phases[0].green + phases[0].yellow + phases[0].all_red
    return first if scene.part == "red" else first - 12.0


def _zone(scene: PaperScene) -> ZoneSpec:
    """The school's stretch: what the map knows of it. The band of 22358.4 lies before the zone proper."""
    acts = {"limit_20": "limit_20", "band": "limit_15_and_25"}
    facts: dict[str, object] = {"school.present": "true", "school.local_act": acts.get(scene.school, "none")}
    start, end = _zone_extent(scene)
    landmark = (HALF - 12.0, -HALF - (start + end) / 2)
    facts["school.grounds_fenced"] = "true"
    if scene.school != "no_sign":
        facts["school.zone"] = "marked"
    if scene.school == "band":
        facts["zone.posted_outside"] = "30 mph"
        landmark = (HALF - 12.0, -HALF - end - EXTENT)
    return ZoneSpec("school", "school", "school", start, end, facts=facts, distance_fact="school.distance", landmark=landmark)


def _zone_extent(scene: PaperScene) -> tuple[float, float]:
    """From where to where the zone reaches along the school road; the band is 500 ft long, less what the school's place beside the road takes."""
    return (ZONE[1] - 150.0, ZONE[1]) if scene.school == "band" else ZONE


def _signs(scene: PaperScene) -> tuple[SignSpec, ...]:
    signs = []
    if FIRST[scene.part]:
        signs.append(SignSpec("first_35", "R2-1", "first", 5.0, speed=MPH_35, values=("35",)))
    if _has_junction(scene) and scene.no_turn_sign:
        signs.append(SignSpec("no_turn", "R10-11", "first", FIRST[scene.part] - 2.0))
    if SCHOOL_ROAD[scene.part] > ZONE[1]:
        shown = "30" if scene.school == "band" else "35"
        signs.append(SignSpec("school_posted", "R2-1", "school", 20.0, values=(shown,), speed=_posted(scene)))
        if "sign.school" in _READ[scene.school]:
            signs.append(SignSpec("school_sign", "S1-1", "school", ZONE[0]))
    return tuple(signs)


def _ego(scene: PaperScene) -> EgoSpec:
    lane = "school.s.1" if scene.part == "school" else "first.e.1"
    return EgoSpec(lane, 10.0, _posted(scene) if scene.part == "school" else MPH_35, ("right",) if _has_junction(scene) else ())


def _cyclists(scene: PaperScene) -> tuple[CyclistSpec, ...]:
    if not scene.cyclist or scene.part not in ("whole", "cyclist"):
        return ()
    leaves = FIRST[scene.part] - 90.0
    return (CyclistSpec("cyclist", "first.e.1", 110.0, speed=4.5, from_edge=0.1, leaves_at=leaves),)


def _vehicles(scene: PaperScene) -> tuple[VehicleSpec, ...]:
    """People on the road: those in the second lane as the cyclist is met, oncoming traffic, and who crosses while the light is red."""
    found = []
    if scene.part in ("whole", "cyclist"):
        if scene.lanes > 1 and scene.beside:
            found.append(VehicleSpec("ahead_left", "first.e.2", 150.0, MPH_35, wish=MPH_35 + 0.5))
            found.append(VehicleSpec("behind_left", "first.e.2", 2.0, MPH_35, wish=MPH_35, enters=5.0))
        found += [VehicleSpec(f"oncoming_{n}", f"first.w.{scene.lanes}", 20.0 + 90.0 * n, 14.0) for n in range(2)]
    if _has_junction(scene):
        first = 24.0 if scene.part == "whole" else 6.0
        count = 8 if scene.cross_traffic else 0 if scene.pedestrian else 2
        times = [first + 4.5 * n for n in range(count)]
        found += [VehicleSpec(f"crossing_{n}", "north.s.1", 5.0, 13.0, turns=("straight",), enters=time) for n, time in enumerate(times)]
    return tuple(found)


def _flows(scene: PaperScene) -> tuple[FlowSpec, ...]:
    if SCHOOL_ROAD[scene.part] > ZONE[1]:
        return (FlowSpec("school_oncoming", "school.n.1", 240.0, until=60.0),)
    return ()


def _pedestrians(scene: PaperScene) -> tuple[PedestrianSpec, ...]:
    """One who waits at the kerb of the arm the ego turns into, and walks over it as the ego comes to stand, 18 m away."""
    if not (_has_junction(scene) and scene.pedestrian):
        return ()
    across = HALF + 3.5 + 2.0
    y = -HALF + 2.0
    return (PedestrianSpec("walker", ((2 * HALF - across, y), (across, y)), 1.3, when_near=18.6),)


def _sightings(scene: PaperScene) -> tuple[SightingSpec, ...]:
    """What is there for the eye: the sign at the light, the school's signs, the children."""
    found = []
    if _has_junction(scene) and scene.no_turn_sign:
        found.append(SightingSpec({"sign.no_turn_on_red": "true"}, (0.0, 0.0), _SIGHT))
    if SCHOOL_ROAD[scene.part] > ZONE[1]:
        middle = (HALF, -HALF - sum(ZONE) / 2)
        reach = _SIGHT + (ZONE[1] - ZONE[0]) / 2
        seen = dict.fromkeys(_READ[scene.school], "true")
        if scene.children:
            seen["school.children_going"] = "true"
        if seen:
            found.append(SightingSpec(seen, middle, reach))
    return tuple(found)
