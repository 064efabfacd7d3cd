"""Roles of the traffic along the road: ahead, behind, in the lane moved to, beside the lane, and coming towards the vehicle."""

from __future__ import annotations

from collections.abc import Iterable

from regdb.vocabulary import Value
from regdb_runtime.maps.road_map import Side
from regdb_runtime.scenes.around import Beside
from regdb_runtime.scenes.lane_facts import is_for_traffic, lane_kind
from regdb_runtime.scenes.look import Look, Strip

IMPASSABLE = frozenset(("double_solid", "solid_dashed", "curb"))
"""Markings and kerbs over which a change of lane is not practicable."""
SIDES: tuple[Side, Side] = ("right", "left")
HUNDRED_FEET = 30.48


def traffic_roles(look: Look) -> dict[str, Value]:
    """Facts of everybody along the road that do not depend on a junction."""
    return {
        **_ahead(look), **_behind(look), **_bicycles(look), **_stationary(look), **_emergency(look), **_oncoming(look), **_present(look),
        **_other_lanes(look), **_two_wheelers(look),
    }  # fmt: skip


def _ahead(look: Look) -> dict[str, Value]:
    found = look.lead
    facts: dict[str, Value] = {"lead.present": found is not None, "obstruction.ahead": _obstructed(look)}
    if found is not None:
        facts |= {"lead.speed": max(0.0, found.along), "lead.distance": max(0.0, found.rear - look.around.front)}
    passed = next((item for item in look.around.others if item.track.id == look.maneuver.passes), found)
    if passed is None:
        facts["lead.turning_left"] = False
    elif passed.track.turn_signal is not None:
        facts["lead.turning_left"] = passed.track.turn_signal == "left"
    return facts


def _obstructed(look: Look) -> bool:
    """Whether something that is no traffic blocks the lane: a thing, or a vehicle that stands there with its warning lights on."""
    return any(
        item.front > look.around.front and (item.track.kind == "obstacle" or (look.stands(item.track.speed) and item.track.warning_lights != "none"))
        for item in look.around.among(*look.own_strip)
    )


def _behind(look: Look) -> dict[str, Value]:
    """Who follows, and the line that has formed; nearest first."""
    behind = [item for item in look.around.among(*look.own_strip) if item.is_motor and item.front <= look.around.rear and item.along >= 0.0]
    behind.sort(key=lambda item: -item.front)
    queue, edge = 0, look.around.rear
    for item in behind:
        if edge - item.front > look.settings.queue_gap:
            break
        queue, edge = queue + 1, item.rear
    near = bool(behind) and look.around.rear - behind[0].front <= look.settings.affected
    same_way = [item.along for item in look.around.others if item.is_motor and item.along > look.settings.standstill]
    slower = not look.stands(look.speed) and bool(same_way) and look.speed < min(same_way) - 2.2  # 5 mph
    affected = any(
        item.track.kind != "obstacle" and item.track.kind != "pedestrian" and item.rear - look.settings.affected <= look.around.front
        and item.front + look.settings.affected >= look.around.rear for item in look.around.others
    )  # fmt: skip
    return {
        "follower.present": near, "ego.followers_queued": float(queue), "ego.left_of_slower_traffic": slower, "other.may_be_affected": affected,
    }  # fmt: skip


def _bicycles(look: Look) -> dict[str, Value]:
    """A bicycle ahead goes the same way in the lane or beside it, up to a lane's width from its edge."""
    right, left = look.own_strip[0] - look.settings.beside_lane, look.own_strip[1] + 0.5
    ahead = [item for item in look.around.among(right, left) if item.track.kind == "bicycle" and item.along > -look.settings.standstill]
    return {"bicycle.ahead": any(item.front > look.around.front and item.rear - look.around.front <= look.ranges.bicycles for item in ahead)}


def _two_wheelers(look: Look) -> dict[str, Value]:
    """A bicycle in a bicycle lane beside the own lane, or in the target if that is one, near enough to be affected; a motorcycle alongside."""
    strips = [found[1] for side in SIDES if (found := look.strip_beside(side)) is not None and lane_kind(found[0]) == "bicycle"]
    if look.target is not None and look.target_strip is not None and lane_kind(look.target) == "bicycle":
        strips.append(look.target_strip)
    near, affected = look.around, look.settings.affected
    riding = any(
        item.track.kind == "bicycle" and item.front > near.rear - affected and item.rear < near.front + affected
        for strip in strips for item in near.among(*strip)
    )  # fmt: skip
    shared = any(item.track.kind == "motorcycle" and item.front > near.rear and item.rear < near.front for item in near.among(*look.own_strip))
    return {"bicycle.in_bicycle_lane": riding, "motorcycle.lane_shared": shared}


def _stationary(look: Look) -> dict[str, Value]:
    """The nearest vehicle that stands with warning lights or on duty immediately beside the lane of the path, not yet passed."""
    right, left = look.path_strip
    beyond_right, beyond_left = _edges_beside(look)
    for item in look.around.others:
        told = item.track.warning_lights != "none" or item.track.hazard_kind != "none"
        stands = item.is_motor and look.stands(item.track.speed)
        near = not item.overlaps(right + 0.3, left - 0.3) and item.overlaps(beyond_right, beyond_left)
        if told and stands and near and item.front > look.around.rear and item.rear - look.around.front <= look.ranges.vehicles:
            kind = item.track.hazard_kind if item.track.hazard_kind != "none" else "other_with_hazards"
            return {
                "stationary_hazard_vehicle.beside": True, "stationary_hazard_vehicle.kind": kind,
                "stationary_hazard_vehicle.lights": item.track.warning_lights,
            }  # fmt: skip
    return {"stationary_hazard_vehicle.beside": False, "stationary_hazard_vehicle.kind": "none", "stationary_hazard_vehicle.lights": "none"}


def _edges_beside(look: Look) -> Strip:
    """How far what stands immediately beside the path's lane may begin: within the next lane, else within a lane's width of the edge."""
    (right, left), reach = look.path_strip, look.settings.beside_lane
    if look.target is not None:  # the path runs along the target: the lane that is left lies between it and the edge
        own_right, own_left = look.own_strip
        return (own_right, left + reach) if own_left <= right + 0.5 else (right - reach, own_left)
    sides = {side: found[1] for side in SIDES if (found := look.strip_beside(side)) is not None and is_for_traffic(found[0])}
    return sides["right"][0] if "right" in sides else right - reach, sides["left"][1] if "left" in sides else left + reach


def _emergency(look: Look) -> dict[str, Value]:
    """Emergency vehicles by their lights: ahead on a call, or coming nearer from anywhere."""
    vehicles = [item for item in look.around.others if item.track.hazard_kind == "emergency"]
    on_call = [item for item in vehicles if item.track.warning_lights == "emergency_lights" and not look.stands(item.track.speed)]
    ahead = [item for item in on_call if item.rear >= look.around.front and item.along > 0.0]
    others = [item for item in on_call if item not in ahead]
    coming = [item for item in others if (item.along > look.speed if item.front <= look.around.rear else item.along <= 0.0)]
    facts: dict[str, Value] = {
        "emergency_vehicle.present": bool(vehicles), "emergency_vehicle.ahead_responding": bool(ahead), "emergency_vehicle.approaching": bool(coming),
    }  # fmt: skip
    if ahead:
        facts["emergency_vehicle.distance"] = max(0.0, min(item.rear for item in ahead) - look.around.front)
    return facts


def _oncoming(look: Look) -> dict[str, Value]:
    """Who comes towards the vehicle on its roadway, and whether a pass on the left leaves room."""
    coming = [item for item in look.around.others if item.is_motor and item.along < -look.settings.standstill and item.rear >= look.around.front]
    coming = [item for item in coming if abs(item.offset) <= 4 * (look.path_strip[1] - look.path_strip[0])]
    nearest = min((item.rear - look.around.front for item in coming), default=look.ranges.vehicles)
    faster = [item for item in look.around.among(*look.own_strip) if item.is_motor and item.along > look.speed]
    behind = [look.around.rear - item.front for item in faster if item.front <= look.around.rear]
    facts: dict[str, Value] = {
        "oncoming.meeting": bool(coming), "oncoming.distance": nearest, "road.passing_unsafe": bool(coming),
        "approaching_vehicle.distance": min([nearest, *behind]),
    }  # fmt: skip
    return facts | _room_to_pass(look, coming)


def _room_to_pass(look: Look, coming: list[Beside]) -> dict[str, Value]:
    """Measured at the end of the pass, as RSS's definition asks: the gap that is left when the vehicle is back in its lane."""
    passed = next((item for item in look.around.others if item.track.id == look.maneuver.passes), None)
    if passed is None:
        return {}
    own = max(look.speed, look.maneuver.goal.cruise_speed)
    gain = own - max(0.0, passed.along)
    if gain <= look.settings.standstill:
        return {"oncoming.clear_for_passing": False}
    lasts = (passed.front - look.around.rear + 2 * look.settings.pass_room) / gain
    gaps = [(item.rear - look.around.front - (own - item.along) * lasts, -item.along) for item in coming]
    unseen = look.ranges.vehicles - 2 * own * lasts, own
    gap, speed = min(gaps, default=unseen)
    left = max(0.0, gap)
    clear = look.judged("oncoming.clear_for_passing", {"own_speed": own, "other_speed": speed, "gap": left}) if gap > 0.0 else False
    if not coming and clear is not True:
        return {}  # somebody beyond what is seen may come
    facts: dict[str, Value] = {"oncoming.distance_at_return": left, "oncoming.within_100_ft": left < HUNDRED_FEET}
    return facts if clear is None else facts | {"oncoming.clear_for_passing": clear}


def _present(look: Look) -> dict[str, Value]:
    kinds = {item.track.kind for item in look.around.others}
    right, left = look.own_strip
    parked = any(item.is_motor and look.stands(item.track.speed) and not item.overlaps(right, left) for item in look.around.others)
    return {
        "pedestrian.present": "pedestrian" in kinds, "bicycle.present": "bicycle" in kinds, "motorcycle.present": "motorcycle" in kinds,
        "animal.ahead": any(item.track.kind == "animal" and item.front > look.around.front for item in look.around.others),
        "parked_vehicle.present": parked,
    }  # fmt: skip


def _other_lanes(look: Look) -> dict[str, Value]:
    facts: dict[str, Value] = {}
    if look.target_strip is None:
        facts["target_lane.hazard"] = False
    elif (hazard := near_in_lane(look, look.target_strip)) is not None:
        facts["target_lane.hazard"] = hazard
    available = _available(look)
    if available is not None:
        facts["lane.same_direction_available"] = available
    return facts


def near_in_lane(look: Look, strip: Strip) -> bool | None:
    """Whether somebody in a lane is so near that moving into it is no longer reasonably safe: alongside, or behind and too fast; None: open."""
    there = [item for item in look.around.among(*strip) if item.track.kind not in ("pedestrian", "obstacle")]
    answers = [_near(look, item) for item in there if item.along >= -look.settings.standstill]
    return True if True in answers else None if None in answers else False


def _near(look: Look, item: Beside) -> bool | None:
    if item.rear > look.around.front:
        return False
    gap = look.around.rear - item.front
    if gap <= 0.0:
        return True
    if look.stands(item.along):
        return False
    return look.judged("target_lane.hazard", {"rear_speed": max(0.0, item.along), "front_speed": look.speed, "gap": gap})


def _available(look: Look) -> bool | None:
    """Whether another lane for the same direction is there and may be moved into practicably and safely; None: open."""
    sides: Iterable[Side] = ("left", "right") if look.maneuver.passing_side == "none" else (look.maneuver.passing_side,)
    answers = [_side_available(look, side) for side in sides]
    return True if True in answers else None if None in answers else False


def _side_available(look: Look, side: Side) -> bool | None:
    found = look.strip_beside(side)
    if found is None or not is_for_traffic(found[0]):
        return False
    marking = look.own.left_marking if side == "left" else look.own.right_marking
    if marking in IMPASSABLE:
        return False
    hazard = near_in_lane(look, found[1])
    blocked = _blocked_ahead(look, found[1])
    if hazard is True or blocked is True:
        return False
    return None if hazard is None or blocked is None or marking == "unknown" else True


def _blocked_ahead(look: Look, strip: Strip) -> bool | None:
    """Whether the next one ahead in a lane is nearer than the vehicle may follow it."""
    ahead = next((item for item in look.around.among(*strip) if item.rear > look.around.front and item.track.kind != "pedestrian"), None)
    if ahead is None:
        return False
    measured = {"rear_speed": look.speed, "front_speed": max(0.0, ahead.along), "gap": ahead.rear - look.around.front}
    return look.judged("lead.following_unsafe", measured)
