"""Overtaking: pass what is slow within the lane, or by the lane to the left and back, when the pass ends before the next line or junction."""

from __future__ import annotations

import math
from dataclasses import replace

from regdb_runtime.maneuver import Maneuver
from regdb_runtime.planning.goal import Goal
from regdb_runtime.strategy.lane_following import into_lane, keep_lane, refuse
from regdb_runtime.strategy.machine import Step
from regdb_runtime.strategy.memory import Pass
from regdb_runtime.strategy.picture import Picture, follow
from regdb_runtime.strategy.surroundings import Placed

STANDS = 0.5
"""m/s under which what is passed counts as standing."""


def wanted(picture: Picture) -> tuple[Placed | None, str]:
    """What is worth passing now, or why nothing is."""
    settings = picture.settings
    slow = picture.ahead(0.0)
    if slow is None or slow.rear - picture.front > max(settings.overtake_distance, settings.overtake_time * picture.speed):
        return None, "nothing_slow"
    if slow.along > settings.slow_share * picture.free_speed or picture.free_speed - slow.along < settings.least_gain or slow.along < -0.5:
        return None, "nothing_slow"
    if picture.handling:
        return None, "junction"
    if picture.need.side is not None:
        return None, "lane_needed"
    if _pass_length(picture, slow) + settings.finish_margin > _free_road(picture):
        return None, "no_room"
    return slow, ""


def done(picture: Picture, passed: Placed | None) -> bool:
    """Whether what is passed lies far enough behind, or is gone."""
    if passed is None:
        return True
    gap = picture.settings.return_gap + picture.settings.return_time * max(passed.along, 0.0)
    return picture.rear > passed.front + gap


def passed_now(picture: Picture) -> Placed | None:
    """The track being passed, where it is now; None when nothing is or it is gone."""
    under_way = picture.memory.passing
    if under_way is None:
        return None
    return next((item for item in picture.placed if item.track.id == under_way.track), None)


def go_straight(picture: Picture, step: Step) -> Maneuver:
    """Pass: within the lane (several offsets), or straight on in the lane beside; straight on in lane when the pass is done."""
    under_way = picture.memory.passing
    if under_way is None:
        slow, refused = wanted(picture)
        return refuse(picture, step, refused) if slow is None else _in_lane(picture, step, slow)
    if picture.memory.target_lane is not None and step.current == step.next:
        return refuse(picture, step, "changing")
    passed = passed_now(picture)
    if done(picture, passed):
        if under_way.mode == "by_lane" and picture.lane != picture.paths.onto(under_way.home, picture.lane):
            return keep_lane(picture, step, follow(picture.lead))
        return refuse(picture, step, "passed")
    assert passed is not None
    if under_way.mode == "in_lane":
        return _in_lane(picture, step, passed)
    if passed.left < _right_edge(picture):
        return replace(keep_lane(picture, step, follow(picture.lead)), passes=passed.track.id, passing_side=under_way.side)
    slow, refused = wanted(picture)
    return refuse(picture, step, refused) if slow is None else _in_lane(picture, step, slow)


def prepare_left(picture: Picture, step: Step) -> Maneuver:
    """Signal to pass by the lane on the left, behind what is slow."""
    slow, refused = _by_lane(picture)
    if slow is None:
        return refuse(picture, step, refused)
    found = replace(keep_lane(picture, step, follow(picture.lead), "left"), credit=picture.settings.lane_change_cost)
    waited = picture.observation.time - picture.memory.entered
    if picture.memory.state == step.next and waited <= picture.settings.patience:
        return found
    prepared = change_left(picture, Step(step.next, f"{step.next.partition('.')[0]}.lane_change_left"))
    return refuse(picture, step, prepared.refused) if prepared.refused else replace(found, prepares=prepared)


def change_left(picture: Picture, step: Step) -> Maneuver:
    """Move to the lane on the left to pass."""
    under_way = picture.memory.passing
    if picture.memory.target_lane is not None and under_way is not None:
        if step.current != step.next:
            return refuse(picture, step, "changing")
        target = picture.paths.onto(picture.memory.target_lane, picture.lane)
        return into_lane(picture, step, "left", target, under_way.track)
    slow, refused = _by_lane(picture)
    beside = picture.beside("left")
    if slow is None or beside is None:
        return refuse(picture, step, refused or "no_lane")
    return replace(into_lane(picture, step, "left", beside, slow.track.id), credit=picture.settings.lane_change_cost)


def prepare_right(picture: Picture, step: Step) -> Maneuver:
    """Signal to return, when what was passed is far enough behind."""
    refused = _no_return(picture)
    if refused:
        return refuse(picture, step, refused)
    return keep_lane(picture, step, follow(picture.lead), "right", biases=(("return", -picture.settings.return_to_lane),))


def change_right(picture: Picture, step: Step) -> Maneuver:
    """Move back to the lane on the right."""
    if picture.memory.target_lane is not None:
        if step.current != step.next:
            return refuse(picture, step, "changing")
        return into_lane(picture, step, "right", picture.paths.onto(picture.memory.target_lane, picture.lane))
    refused = _no_return(picture)
    beside = picture.beside("right")
    if refused or beside is None:
        return refuse(picture, step, refused or "no_lane")
    return into_lane(picture, step, "right", beside, biases=(("return", -picture.settings.return_to_lane),))


def begun(picture: Picture, maneuver: Maneuver) -> Pass | None:
    """The pass that a chosen manoeuvre begins or goes on with."""
    under_way = picture.memory.passing
    if under_way is not None:
        return under_way
    if maneuver.passes is not None and maneuver.target_lane is None:
        return Pass(maneuver.passes, "left", "in_lane", picture.lane)
    slow = maneuver.passes or maneuver.lead
    return None if slow is None else Pass(slow, "left", "by_lane", picture.lane)


def _in_lane(picture: Picture, step: Step, slow: Placed) -> Maneuver:
    """Offsets that leave each of the clearances aimed at, and the widest that stays in lane.

    Beyond the lane only beside a lane that goes the same way, or round what stands: nobody passes what moves on the half of oncoming traffic,
    since the end of such a pass cannot be seen from its beginning. Whether any of them is lawful, the law says.
    """
    settings, half = picture.settings, picture.footprint.width / 2
    bound = float(picture.here.widths.min()) / 2 - half - settings.edge_margin
    aims = [slow.left + half + clearance + settings.aim_beyond for clearance in settings.pass_clearances]
    leaves = slow.along < STANDS or picture.beside("left") is not None
    offsets = sorted({round(item, 3) for item in (*aims, bound) if item > slow.left + half and 0.0 < item <= (math.inf if leaves else bound)})
    if not offsets and slow.left + half < 0.0:
        offsets = [0.0]
    if not offsets:
        return refuse(picture, step, "no_room_beside")
    beyond = picture.ahead(offsets[0], slow.track.id)
    if beyond is not None and not picture.is_near(beyond):
        beyond = None
    goal = Goal(tuple(offsets), settings.cruise_speed, picture.curves, picture.halt, follow(beyond))
    return Maneuver(
        step.current, step.next, picture.lane, picture.lane_path, goal, "off", None, slow.track.id, "left",
        None if beyond is None else beyond.track.id, picture.junction, via=step.via,
    )  # fmt: skip


def _by_lane(picture: Picture) -> tuple[Placed | None, str]:
    slow, refused = wanted(picture)
    if slow is None:
        return None, refused
    beside = picture.beside("left")
    if beside is None:
        return None, "no_lane"
    if picture.lead is None:
        return None, "far"
    return slow, ""


def _no_return(picture: Picture) -> str:
    under_way = picture.memory.passing
    if under_way is None or under_way.mode != "by_lane":
        return "not_out"
    if picture.lane == picture.paths.onto(under_way.home, picture.lane):
        return "in_lane"
    return "" if done(picture, passed_now(picture)) else "alongside"


def _right_edge(picture: Picture) -> float:
    """Offset of the right boundary of the own lane."""
    return -float(picture.here.widths.min()) / 2


def _pass_length(picture: Picture, slow: Placed) -> float:
    """Metres driven until the pass is over, at the speed that could be had."""
    settings = picture.settings
    behind = settings.return_gap + settings.return_time * max(slow.along, 0.0)
    relative = slow.front - picture.rear + behind
    gain = picture.free_speed - slow.along
    return picture.free_speed * relative / max(gain, settings.least_gain)


def _free_road(picture: Picture) -> float:
    """Metres to the next place where the pass must be over: a line, a junction, the path's end."""
    ends = [picture.lane_path.path.length - picture.front]
    if picture.junction is not None:
        ends.append(picture.junction.stop_station - picture.front)
    return min(ends)

