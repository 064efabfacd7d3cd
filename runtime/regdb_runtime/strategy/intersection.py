"""Manoeuvres at intersections: approach, follow, stop at the line, and cross it the route's way, straight on or by a turn."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from regdb_runtime.maneuver import Maneuver
from regdb_runtime.observation import TurnSignal
from regdb_runtime.planning.goal import Goal
from regdb_runtime.strategy.lane_following import refuse
from regdb_runtime.strategy.picture import Picture, follow
from regdb_runtime.strategy.stop_line import decision_distance, must_stop_on_yellow, stop_point, waiting_distance

if TYPE_CHECKING:
    from regdb_runtime.maneuver import Junction
    from regdb_runtime.strategy.machine import Step

TURNS = {"turn_left": "left", "turn_right": "right", "u_turn": "u_turn"}
"""State -> the turn it makes."""
_SIGNALS: dict[str, TurnSignal] = {"left": "left", "u_turn": "left", "right": "right"}


def go_straight(picture: Picture, step: Step) -> Maneuver:
    """Approach, whatever the route does at the junction, and cross straight on where that is its way."""
    junction = picture.junction
    if junction is None or not picture.handling:
        return refuse(picture, step, "no_junction")
    if picture.lead is not None:
        return refuse(picture, step, f"lead:{picture.lead.track.id}")
    if junction.turn != "straight" and (_inside(picture, junction) or _must_decide(picture, junction)):
        return refuse(picture, step, "route")
    return _through(picture, step, junction, commits=junction.turn == "straight" and _must_decide(picture, junction))


def car_following(picture: Picture, step: Step) -> Maneuver:
    """Approach or cross behind another vehicle; who stands before the line is waited behind."""
    junction = picture.junction
    if junction is None or not picture.handling:
        return refuse(picture, step, "no_junction")
    lead = picture.lead
    if lead is None:
        return refuse(picture, step, "no_lead")
    waits = _waits_before(picture, junction)
    if junction.turn != "straight" and not waits and (_inside(picture, junction) or _must_decide(picture, junction)):
        return refuse(picture, step, "route")
    return _through(picture, step, junction, commits=not waits and _must_decide(picture, junction))


def stop(picture: Picture, step: Step) -> Maneuver:
    """Stop with the front bumper at the line, and stay; past the line at the entrance, and within the junction as soon as is gentle: to wait
    there for somebody is better than to cross his way."""
    junction = picture.junction
    if junction is None or not picture.handling:
        return refuse(picture, step, "no_junction")
    if picture.lead is not None and _waits_before(picture, junction):
        return refuse(picture, step, f"lead:{picture.lead.track.id}")
    point = stop_point(picture.memory.stop, junction, picture.front, picture.settings)
    if _inside(picture, junction):
        needed = picture.speed * picture.speed / (2 * picture.settings.waiting_braking) + picture.settings.stop_margin
        point = replace(point, station=max(junction.entrance, picture.front + needed), margin=0.0)
    goal = Goal((0.0,), picture.settings.cruise_speed, picture.curves, point, follow(picture.lead))
    return _maneuver(picture, step, goal, junction, commits=False)


def turn(picture: Picture, step: Step) -> Maneuver:
    """Turn the route's way through the junction, along its inner lane."""
    junction = picture.junction
    if junction is None or not picture.handling:
        return refuse(picture, step, "no_junction")
    if TURNS.get(step.next.partition(".")[2]) != junction.turn:
        return refuse(picture, step, "route")
    if not _inside(picture, junction) and not _must_decide(picture, junction):
        return refuse(picture, step, "far")
    if picture.lead is not None and _waits_before(picture, junction):
        return refuse(picture, step, f"lead:{picture.lead.track.id}")
    return _through(picture, step, junction, commits=True)


def _through(picture: Picture, step: Step, junction: Junction, commits: bool) -> Maneuver:
    """Along the path and through the junction."""
    settings = picture.settings
    if commits and not _inside(picture, junction):
        signals = picture.observation.signals
        stopping = picture.memory.stop.phase in ("approach", "held", "check")
        if must_stop_on_yellow(junction, signals, picture.front, picture.speed, settings, stopping):
            return refuse(picture, step, "yellow")
        if picture.memory.stop.phase == "held":
            return refuse(picture, step, "check")
    goal = Goal((0.0,), settings.cruise_speed, picture.curves, picture.end, follow(picture.lead))
    return _maneuver(picture, step, goal, junction, commits and not _inside(picture, junction))


def _maneuver(picture: Picture, step: Step, goal: Goal, junction: Junction, commits: bool) -> Maneuver:
    return Maneuver(
        step.current, step.next, picture.lane, picture.lane_path, goal, _SIGNALS.get(junction.turn, "off"),
        lead=None if goal.follow is None else goal.follow.track, junction=junction, via=step.via, commits=commits,
        may_wait=junction.stop_station - picture.front > waiting_distance(picture.speed, picture.settings),
    )  # fmt: skip


def _inside(picture: Picture, junction: Junction) -> bool:
    """Whether the front bumper is past the line."""
    return picture.front > junction.stop_station


def _must_decide(picture: Picture, junction: Junction) -> bool:
    """Whether the line is so near that a stop must begin now, or the junction be entered."""
    return junction.stop_station - picture.front <= decision_distance(picture.speed, picture.settings)


def _waits_before(picture: Picture, junction: Junction) -> bool:
    """Whether what is followed stands, or comes to stand by gentle braking, before the line."""
    lead = picture.lead
    if lead is None or lead.front > junction.stop_station + 1.0:
        return False
    if lead.along < picture.settings.standstill:
        return True
    slows = max(-lead.track.acceleration, 0.0)
    return slows > 0.3 and lead.front + lead.along**2 / (2 * slows) <= junction.stop_station + 1.0
