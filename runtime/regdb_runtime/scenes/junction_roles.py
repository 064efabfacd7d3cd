"""Roles of the traffic at a junction: who comes on other highways or towards the vehicle, who is in it, whether its exit is free."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from regdb.vocabulary import Value
from regdb_runtime.maps.lane_path import Junction
from regdb_runtime.scenes.crossing import Arriving, Way
from regdb_runtime.scenes.history import Arrivals
from regdb_runtime.scenes.look import Look

NOBODY_CROSSING: Mapping[str, Value] = {
    "cross_traffic.hazard": False, "cross_traffic.in_intersection": False, "cross_traffic.arrived_together": False, "cross_traffic.on_right": False,
    "oncoming.turning_across": False, "oncoming.hazard": False, "intersection.exit_blocked": False, "rail.exit_blocked": False,
}  # fmt: skip
"""Away from junctions, for a manoeuvre that turns nowhere."""
SLOW = 2.0
"""Speed (m/s) below which a vehicle beyond the junction does not clear its exit in time."""
TURNS = ("left", "right", "u_turn")


@dataclass(frozen=True, eq=False)
class Entering:
    """A junction with those on their way into it: `ways` that meet the plan's, `arriving` on them.

    `limits`: posted speed of a way by its lane. `stopped`: lanes of ways whose traffic a sign stops. `green`: the signal lets the vehicle go, with
    everybody from other highways held by his own; `protected`: by an arrow, which holds oncoming traffic too. `within`: the vehicle has
    entered already, and whoever has not must let it clear the junction (CVC 21451(a), 21800(a)).
    """

    junction: Junction
    ways: Sequence[Way]
    limits: Mapping[str, float]
    arriving: Sequence[Arriving]
    arrivals: Arrivals
    stopped: frozenset[str]
    green: bool
    protected: bool
    within: bool
    distance: float
    """From the front bumper to the junction's entrance, metres (negative: past it)."""


def junction_roles(look: Look, entering: Entering, turns: bool) -> dict[str, Value]:
    """Facts of the junction's traffic for a plan that goes through (`turns`: by a turn)."""
    cross = [item for item in entering.arriving if item.way.comes_from != "oncoming"]
    oncoming = [item for item in entering.arriving if item.way.comes_from == "oncoming"]
    facts: dict[str, Value] = {
        "cross_traffic.in_intersection": any(item.inside for item in cross),
        "oncoming.turning_across": any(item.inside and item.way.turn in ("left", "u_turn") for item in oncoming),
    }
    facts |= _together(look, entering, cross)
    for fact, those, comes_from in (("cross_traffic.hazard", cross, ("cross", "same")), ("oncoming.hazard", oncoming, ("oncoming",))):
        hazard = _hazard(look, fact, entering, those, comes_from)
        if hazard is not None:
            facts[fact] = hazard
    moving = _movement(look, entering, turns)
    if moving is not None:
        facts["movement.hazard"] = moving
    if entering.junction.control in ("signal", "all_way_stop"):
        facts["approaching_vehicle.controlled"] = True
    blocked = exit_blocked(look, entering.junction.exit, entering.junction.stop_station)
    return facts if blocked is None else facts | {"intersection.exit_blocked": blocked}


def _approaches(look: Look, item: Arriving) -> bool:
    """Whether somebody moves towards the meeting place or is in the junction; who stands before it waits."""
    return item.inside or not look.stands(item.track.speed)


def _is_held(look: Look, entering: Entering, item: Arriving) -> bool:
    """Whether a signal, a sign or the vehicle in the junction stops somebody before his line, and he can still stop there."""
    held = entering.within or item.way.lane in entering.stopped or (entering.protected if item.way.comes_from == "oncoming" else entering.green)
    return held and not item.inside and item.track.speed**2 <= 2 * look.settings.held_braking * item.to_entrance


def _judged(look: Look, fact: str, item: Arriving) -> bool | None:
    return look.judged(fact, {"other_speed": item.track.speed, "other_distance": max(0.0, item.to_meeting)})


def _hazard(look: Look, fact: str, entering: Entering, those: Sequence[Arriving], comes_from: Sequence[str]) -> bool | None:
    """Whether one of them is so near that it is a hazard; False only as far as they can be seen to come, None where that is not far enough."""
    free = fact == "oncoming.hazard" and entering.protected
    answers = [_judged(look, fact, item) for item in those if _approaches(look, item) and not (free and _is_held(look, entering, item))]
    if True in answers:
        return True
    seen = look.ranges.vehicles - max(0.0, entering.distance)
    for way in entering.ways:
        if way.comes_from in comes_from and not free:
            unseen = {"other_speed": entering.limits.get(way.lane, look.speed), "other_distance": max(0.0, seen)}
            answers.append(look.judged(fact, unseen))
    return False if all(answer is False for answer in answers) else None


def _movement(look: Look, entering: Entering, turns: bool) -> bool | None:
    """The planned turn, or start across: nobody on a way that meets it who is not held before his line, and no bicycle beside a turn."""
    those = [item for item in entering.arriving if _approaches(look, item) and not _is_held(look, entering, item)]
    if not turns:
        those = [item for item in those if item.way.comes_from != "oncoming" or item.inside]
    answers = [_judged(look, "movement.hazard", item) for item in those]
    if turns:
        answers += _bicycles_beside(look, entering)
    return True if True in answers else None if None in answers else False


def _bicycles_beside(look: Look, entering: Entering) -> list[bool | None]:
    """Bicycles on the side of the turn that would be cut off: alongside, or coming up from behind."""
    right = entering.junction.turn == "right"
    found: list[bool | None] = []
    for item in look.around.others:
        beside = item.left < look.path_strip[0] + 1.0 if right else item.right > look.path_strip[1] - 1.0
        near = -look.settings.beside_lane - 1.0 < item.offset < look.settings.beside_lane + 1.0
        if item.track.kind != "bicycle" or not beside or not near or item.along <= 0.0 or item.rear > entering.junction.entrance:
            continue
        alongside = item.front > look.around.rear and item.rear < look.around.front
        if alongside and entering.distance <= look.settings.approach:
            found.append(True)
        elif item.front <= look.around.rear:
            measured = {"other_speed": item.along, "other_distance": max(0.0, entering.junction.entrance - item.front)}
            found.append(look.judged("movement.hazard", measured))
    return found


def _together(look: Look, entering: Entering, cross: Sequence[Arriving]) -> dict[str, Value]:
    """Others that reached the junction at the same time as the vehicle and have not gone on; whether one of them is on the right."""
    own = entering.arrivals.own
    here = {item.track.id: item.way for item in cross if not item.inside}
    waiting = [
        here[name] for name, time in entering.arrivals.others if name in here
        and (own is None or abs(time - own) <= look.settings.together) and (own is not None or time >= entering.arrivals.now - look.settings.together)
    ]  # fmt: skip
    return {"cross_traffic.arrived_together": bool(waiting), "cross_traffic.on_right": any(way.bearing > 0.0 for way in waiting)}


def exit_blocked(look: Look, beyond: float, line: float) -> bool | None:
    """Whether no room for the vehicle is left beyond a station: somebody slow stands where it would come to stand.

    None: too far to be seen, and it will not be seen in time to stop before the line.
    """
    room = beyond + look.footprint.length + look.settings.exit_margin
    for item in look.around.among(*look.path_strip):
        there = item.track.kind != "pedestrian" and beyond - item.track.length < item.rear < room
        if there and item.front > look.around.front and abs(item.along) < SLOW:
            return True
    seen = room - look.around.front <= look.ranges.vehicles
    return False if seen or look.in_time(line, room, look.ranges.vehicles) else None
