"""The law in motion: short drives through the built-in world under the shipped law, each measured from the world's own truth.

`driven` asserts of every drive that nobody is touched, nothing fails and a lawful plan was there at every tick.
"""

from __future__ import annotations

import math

from law_scenes import DAY, HALF, MPH, Drive, crossing, driven
from regdb_runtime.observation import Track
from regdb_runtime.worlds.road_spec import Arm, JunctionSpec, Piece, Pose, RoadSpec, SignalPhase, StreetsSpec, ZoneSpec
from regdb_runtime.worlds.scene_spec import CyclistSpec, EgoSpec, EyeSpec, ParkedSpec, PedestrianSpec, SceneSpec, SightingSpec, VehicleSpec
from watched_drives import Instant, bumper, corners

PHASES = (SignalPhase(("e", "w"), 30.0), SignalPhase(("n", "s"), 20.0))
LANE = 3.5


def scene(streets: StreetsSpec, station: float = 30.0, speed: float = 13.0, turn: str = "straight", **others: object) -> SceneSpec:
    """The ego comes from the west, in the only lane or the right-hand one of `main`."""
    lane = "west.e.1" if any(road.id == "west" for road in streets.roads) else "main.e.1"
    fields = {"start": DAY, **others}
    return SceneSpec("law", streets, EgoSpec(lane, station, speed, turns=(turn,)), **fields)  # type: ignore[arg-type]


def car(name: str, lane: str, station: float, speed: float = 13.0, **more: object) -> VehicleSpec:
    return VehicleSpec(name, lane, station, speed, **{"turns": ("straight",), **more})  # type: ignore[arg-type]


def oncoming() -> tuple[VehicleSpec, ...]:
    return tuple(car(f"oncoming_{number}", "east.w.1", station) for number, station in enumerate((20.0, 60.0, 90.0)))


def street(length: float = 260.0, lanes: int = 1, limit: float | None = 35 * MPH, **more: object) -> StreetsSpec:
    """One road to the east with a double solid line in its middle."""
    road = RoadSpec("main", (Piece(length),), Pose(), lanes, lanes, LANE, limit, "double_solid")
    return StreetsSpec((road,), **more)  # type: ignore[arg-type]


def front(drive: Drive, item: Instant) -> float:
    """How far east the front bumper is."""
    return bumper(item.ego, drive.footprint)[0]


def passing(drive: Drive, east: float) -> Instant:
    """The first instant at which the front bumper is farther east."""
    return next(item for item in drive.instants if front(drive, item) > east)


def sides(drive: Drive, item: Instant) -> tuple[float, float]:
    """How far south and north the vehicle reaches."""
    ego, size = item.ego, drive.footprint
    middle = size.length / 2 - size.rear_overhang
    box = corners(ego.x + middle * math.cos(ego.heading), ego.y + middle * math.sin(ego.heading), ego.heading, size.length, size.width)
    return min(y for _, y in box), max(y for _, y in box)


def of(drive: Drive, item: Instant, name: str) -> Track:
    found = drive.track(item, name)
    assert found is not None
    return found


def stands_once(drive: Drive) -> float:
    """Comes to stand once before the line, front bumper 0-2 m short of it; the time at which it moves off."""
    stops = [stop for stop in drive.stops() if stop[2] > -5.0]
    assert len(stops) == 1
    assert 0.0 <= stops[0][2] <= 2.0
    return stops[0][1]


def test_a_stop_sign_is_stopped_at_once() -> None:
    """CVC 22450(a): a full stop at the limit line; then it goes, and does not stop again."""
    drive = driven(scene(crossing("stop", own="stop", others="none"), vehicles=(car("cross", "north.s.1", 100.0),)), 20.0)
    off = stands_once(drive)
    assert off < drive.crossed.time < off + 2.5
    assert front(drive, drive.instants[-1]) > HALF
    assert drive.braking() <= 3.5


def test_at_an_all_way_stop_who_entered_first_goes_first() -> None:
    """CVC 21800(a): a car that was at the intersection first crosses before the vehicle's front reaches its way."""
    drive = driven(scene(crossing("all_way_stop"), vehicles=(car("first", "north.s.1", 160.0, 10.0),)), 24.0)
    assert all(0.0 <= left <= 2.0 for _, _, left in drive.stops())
    assert drive.stops()
    on_its_way = passing(drive, -LANE)
    assert of(drive, on_its_way, "first").y < -LANE
    assert drive.clearance("first") > 2.0


def test_at_an_all_way_stop_the_car_on_the_right_that_comes_together_goes_first() -> None:
    """CVC 21800(c): both stand at their lines; the vehicle crosses its own only once the other has entered."""
    drive = driven(scene(crossing("all_way_stop"), vehicles=(car("right", "south.n.1", 132.0),)), 28.0)
    stands_once(drive)
    other = of(drive, drive.crossed, "right")
    assert other.y + other.length / 2 > -HALF
    assert of(drive, passing(drive, 0.0), "right").y > 0.0


def test_a_left_turn_waits_for_oncoming_traffic_without_a_light() -> None:
    """CVC 21801(a): nobody oncoming is a hazard during the turn; none of them has to brake."""
    _turns_left_behind_all(driven(scene(crossing("none"), turn="left", vehicles=oncoming()), 26.0))


def test_a_left_turn_on_green_waits_for_oncoming_traffic() -> None:
    """CVC 21801(a), 21451(a): the same on a circular green."""
    drive = driven(scene(crossing("signal", phases=PHASES), turn="left", vehicles=oncoming()), 27.0)
    _turns_left_behind_all(drive)
    assert drive.crossed.lights["crossing.e.light"] == "green"


def _turns_left_behind_all(drive: Drive) -> None:
    over = next(item for item in drive.instants if sides(drive, item)[1] > 0.0)
    assert all(track.x < over.ego.x for track in over.tracks)
    assert len(drive.instants[0].tracks) == 3
    assert max(drive.braking_of(f"oncoming_{number}") for number in range(3)) < 1.0
    assert drive.instants[-1].ego.y > HALF


def test_a_yield_sign_yields_to_cross_traffic() -> None:
    """CVC 21803(a): cars near enough to be a hazard go first and need not brake."""
    cars = (car("near", "north.s.1", 100.0), car("far", "north.s.1", 70.0))
    drive = driven(scene(crossing("yield", own="yield", others="none"), vehicles=cars), 20.0)
    entered = passing(drive, -HALF)
    assert all(of(drive, entered, name).y < -LANE for name in ("near", "far"))
    assert max(drive.braking_of(name) for name in ("near", "far")) < 1.0


def test_a_pedestrian_in_a_crosswalk_without_a_light_is_let_over() -> None:
    """CVC 21950(a): the front bumper stays before the crosswalk as long as the pedestrian is on the roadway in it."""
    streets = StreetsSpec(
        (
            RoadSpec("west", (Piece(110.0),), Pose(-110.0 - HALF, 0.0), 1, 1, LANE, 35 * MPH, "double_solid"),
            RoadSpec("east", (Piece(150.0),), Pose(HALF, 0.0), 1, 1, LANE, 35 * MPH, "double_solid"),
        ),
        (JunctionSpec("crossing", (Arm("west", "end", crosswalk=True), Arm("east", "start"))),),
    )  # fmt: skip
    walker = PedestrianSpec("walker", ((-14.5, -6.0), (-14.5, 6.0)), 1.3, starts=1.5)
    drive = driven(scene(streets, 20.0, 14.0, pedestrians=(walker,)), 18.0)
    for item in drive.instants:
        if abs(of(drive, item, "walker").y) < LANE:
            assert front(drive, item) < -HALF - 4.0 + 1e-6
    assert front(drive, drive.instants[-1]) > HALF


def test_a_red_light_is_waited_out() -> None:
    """CVC 21453(a): stands 0-2 m before the line, crosses it once, on green."""
    drive = driven(scene(crossing("signal", phases=PHASES, offset=41.0), 10.0, 14.0), 24.0)
    stands_once(drive)
    assert drive.crossed.lights["crossing.e.light"] == "green"
    assert drive.braking() <= 3.5


def test_on_yellow_it_stops_where_it_can() -> None:
    """CVC 21452(a), 21453(a): yellow 52 m before the line at 35 mph; stands before it, and does not think again half way."""
    drive = driven(scene(crossing("signal", phases=PHASES, offset=28.1), 20.0, 14.0), 12.0)
    stops = drive.stops()
    assert len(stops) == 1
    assert 0.0 <= stops[0][2] <= 2.0
    assert all(drive.before_line(item) >= 0.0 for item in drive.instants)
    assert drive.braking() <= 3.7


def test_on_yellow_it_goes_on_where_it_cannot_stop() -> None:
    """CVC 21452(a): yellow 26 m before the line at 35 mph; crosses on yellow without braking."""
    drive = driven(scene(crossing("signal", phases=PHASES, offset=26.0), 30.0, 14.0), 9.0)
    assert drive.crossed.lights["crossing.e.light"] == "yellow"
    assert drive.braking() < 1.0


def test_an_intersection_whose_exit_is_blocked_is_not_entered() -> None:
    """CVC 22526(a): on green it stays out until the queue beyond has moved."""
    queue = car("queue", "east.e.1", 3.0, 0.0, wish=0.0, speeds=((0.0, 0.0), (14.0, 12.0)))
    drive = driven(scene(crossing("signal", phases=PHASES), vehicles=(queue,)), 23.0)
    stands_once(drive)
    room = of(drive, passing(drive, -HALF), "queue")
    assert room.x - room.length / 2 > HALF + drive.footprint.length


def test_a_blind_intersection_is_crossed_at_15_mph() -> None:
    """CVC 22352(a)(1)(B) as of 2022, (a)(2) here: no clear view of the crossing roads, nothing controls it."""
    drive = driven(scene(crossing("none", facts={"intersection.view_obstructed": "true"}), 10.0, 13.0), 18.0)
    inside = [item.ego.speed for item in drive.instants if -HALF <= front(drive, item) <= HALF]
    assert inside
    assert max(inside) <= 15 * MPH + 1e-6


def police() -> ParkedSpec:
    return ParkedSpec("police", "main.e.1", 130.0, -3.0, "car", 5.0, 1.9, "emergency_lights", "emergency")


def test_it_moves_over_for_a_stopped_police_car() -> None:
    """CVC 21809(a)(1): the next lane is free, so it passes in the lane that is not beside the car."""
    drive = driven(scene(street(lanes=2), 10.0, 14.0, parked=(police(),)), 11.0)
    beside = [item for item in drive.instants if front(drive, item) >= 127.5 and item.ego.x - drive.footprint.rear_overhang <= 132.5]
    assert beside
    assert all(sides(drive, item)[0] >= -LANE for item in beside)


def flashing(until: float) -> EyeSpec:
    seen = {"school_bus.ahead": "true", "school_bus.present": "true", "school_bus.red_flashing": "true"}
    return EyeSpec(sightings=(SightingSpec(seen, (140.0, 0.0), 100.0, until=until),))


def test_it_stops_for_an_oncoming_school_bus_until_its_lights_cease() -> None:
    """CVC 22454(a): met on a two-lane road; it stands before the bus while its red lights flash, and goes on afterwards."""
    bus = VehicleSpec("bus", "main.w.1", 120.0, 0.0, wish=0.0, kind="bus", length=11.0, width=2.5)
    drive = driven(scene(street(), 10.0, 14.0, vehicles=(bus,), eye=flashing(16.0)), 21.0)
    near = of(drive, drive.instants[0], "bus").x - 5.5
    flashes = [item for item in drive.instants if item.time < 16.0]
    assert all(front(drive, item) < near for item in flashes)
    assert flashes[-1].ego.speed < 0.1
    assert front(drive, drive.instants[-1]) > near


def test_it_stays_behind_a_school_bus_until_its_lights_cease() -> None:
    """CVC 22454(a): overtaken; it stays behind."""
    bus = VehicleSpec("bus", "main.e.1", 130.0, 0.0, wish=0.0, kind="bus", length=11.0, width=2.5)
    drive = driven(scene(street(), 10.0, 14.0, vehicles=(bus,), eye=flashing(1e9)), 18.0)
    assert all(front(drive, item) < 130.0 - 5.5 - 2.0 for item in drive.instants)
    assert drive.instants[-1].ego.speed < 0.3


def test_a_double_solid_line_is_never_crossed() -> None:
    """CVC 21460(a): past a cyclist and behind a slow car; no corner of the vehicle is ever left of the middle between the two lines, by more than
    the 2 cm that following a plan may err."""
    cyclist = CyclistSpec("cyclist", "main.e.1", 60.0, 4.5)
    slow = VehicleSpec("slow", "main.e.1", 170.0, 6.0, 6.0)
    drive = driven(scene(street(320.0), 10.0, 14.0, cyclists=(cyclist,), vehicles=(slow,)), 16.0)
    assert max(sides(drive, item)[1] for item in drive.instants) <= 0.02
    assert of(drive, drive.instants[-1], "cyclist").x < drive.instants[-1].ego.x
    assert drive.clearance("cyclist") >= 0.9144


def test_a_bicycle_lane_is_not_driven_in() -> None:
    """CVC 21209(a): behind a slow car beside a bicycle lane it stays in its own."""
    road = RoadSpec("main", (Piece(260.0),), Pose(), 1, 1, LANE, 35 * MPH, "double_solid", bicycle_lane=1.6)
    slow = VehicleSpec("slow", "main.e.1", 70.0, 5.0, 5.0)
    drive = driven(scene(StreetsSpec((road,)), 10.0, 13.0, vehicles=(slow,)), 14.0)
    assert all(low >= -LANE and high <= 0.0 for low, high in (sides(drive, item) for item in drive.instants))


def test_a_lower_limit_is_kept_at_the_city_border() -> None:
    """CVC 22352(b)(1), 22349(b): an unposted road at 55 mph; beyond the city's border, a residence district, the front bumper is at 25 mph."""
    city = ZoneSpec("city", "jurisdiction", "main", 220.0, 330.0, margin=20.0, jurisdiction="los_angeles", facts={"district.residence": "true"})
    streets = street(330.0, limit=None, zones=(city,), jurisdiction="los_angeles_county")
    drive = driven(scene(streets, 10.0, 16.0), 17.0)
    assert max(item.ego.speed for item in drive.instants) > 35 * MPH
    within = [item.ego.speed for item in drive.instants if front(drive, item) >= 220.0]
    assert within
    assert max(within) <= 25 * MPH + 0.01


def test_a_limit_whose_hours_begin_on_the_way_is_kept_from_then_on() -> None:
    """LAMC 80.81 under CVC 22357.1: 25 mph beside the playground from 8:00; at 7:59:50 it drives 35 mph, at 8:00:00 it no longer does."""
    zone = ZoneSpec("playground", "playground", "main", 0.0, 330.0, facts={"playground.local_act": "true"}, hours=((8 * 3600, 18 * 3600),))
    eye = EyeSpec(sightings=(SightingSpec({"sign.playground_limit": "true"}),))
    drive = driven(scene(street(330.0, zones=(zone,)), 10.0, 14.0, start="2026-03-02T07:59:50", eye=eye), 13.0)
    assert max(item.ego.speed for item in drive.instants) > 30 * MPH
    assert max(item.ego.speed for item in drive.instants if item.time >= 10.0 - 1e-6) <= 25 * MPH + 0.01
