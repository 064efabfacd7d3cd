"""Manoeuvres between intersections: keep the lane, follow, signal for and make the lane changes that the route, or what stands beside it, needs."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Literal

from regdb_runtime.maneuver import LanePath, Maneuver
from regdb_runtime.observation import TurnSignal
from regdb_runtime.planning.goal import Follow, Goal, StopPoint
from regdb_runtime.strategy.machine import Step
from regdb_runtime.strategy.picture import Picture, follow
from regdb_runtime.strategy.surroundings import Placed, in_strip, place

Build = Callable[[Picture, Step], Maneuver]


def keep_lane(
    picture: Picture, step: Step, following: Follow | None = None, signal: TurnSignal = "off", stop: StopPoint | None = None,
    biases: tuple[tuple[str, float], ...] = (), refused: str = "",
) -> Maneuver:  # fmt: skip
    """Along the own lane, behind what is followed, to a stop where one is given (else to where no crossing is meant to go on)."""
    goal = Goal((0.0,), picture.settings.cruise_speed, picture.curves, stop or picture.halt, following)
    return Maneuver(
        step.current, step.next, picture.lane, picture.lane_path, goal, signal,
        lead=None if following is None else following.track, junction=picture.junction, refused=refused, via=step.via, biases=biases,
    )  # fmt: skip


def refuse(picture: Picture, step: Step, because: str) -> Maneuver:
    """A state that cannot be entered now, with the reason."""
    return keep_lane(picture, step, refused=because)


def go_straight(picture: Picture, step: Step) -> Maneuver:
    """Keep the lane with nothing ahead to follow."""
    if picture.handling:
        return refuse(picture, step, "junction")
    if picture.lead is not None:
        return refuse(picture, step, f"lead:{picture.lead.track.id}")
    return keep_lane(picture, step)


def car_following(picture: Picture, step: Step) -> Maneuver:
    """Keep the lane behind a slower vehicle."""
    if picture.handling:
        return refuse(picture, step, "junction")
    if picture.lead is None:
        return refuse(picture, step, "no_lead")
    return keep_lane(picture, step, follow(picture.lead))


def slow_down(picture: Picture, step: Step) -> Maneuver:
    """Ease out of an emergency: along the lane, no faster than now, and not over a line ahead."""
    found = keep_lane(picture, step, follow(picture.lead))
    return replace(found, goal=replace(found.goal, cruise_speed=min(picture.speed, found.goal.cruise_speed)))


def prepare(side: Literal["left", "right"]) -> Build:
    """Signal and look for a gap: only for a change that the route needs, or that gives room to what stands beside the lane."""

    def build(picture: Picture, step: Step) -> Maneuver:
        refused = _no_change(picture, side)
        if refused:
            return refuse(picture, step, refused)
        found = keep_lane(picture, step, follow(picture.lead), side, biases=_needed(picture))
        blocker = _blocker(picture, side)
        if blocker is None:
            return found
        slower = max(min(blocker.along, picture.speed) - picture.settings.open_gap, picture.settings.open_gap)
        return replace(found, goal=replace(found.goal, cruise_speed=min(slower, found.goal.cruise_speed)))

    return build


def _blocker(picture: Picture, side: Literal["left", "right"]) -> Placed | None:
    """Who drives beside and keeps the vehicle from changing: it falls back behind him."""
    half = float(picture.here.widths.min()) / 2
    strip = (half, 3 * half) if side == "left" else (-3 * half, -half)
    settings = picture.settings
    rear, front = picture.rear - settings.lane_change_gap_behind, picture.front + settings.lane_change_gap_ahead
    beside = in_strip(picture.placed, *strip, rear, front)
    return next((item for item in beside if item.along > 0.5), None)


def change(side: Literal["left", "right"]) -> Build:
    """Move into the lane beside: begun out of its preparation, and gone on with until it is over."""

    def build(picture: Picture, step: Step) -> Maneuver:
        if picture.memory.target_lane is not None:
            return _go_on(picture, step, side)
        refused = _no_change(picture, side)
        if refused:
            return refuse(picture, step, refused)
        target = picture.beside(side)
        if target is None:
            return refuse(picture, step, "no_lane")
        return into_lane(picture, step, side, target, biases=_needed(picture))

    return build


def into_lane(
    picture: Picture, step: Step, side: Literal["left", "right"], target: str, passes: str | None = None,
    biases: tuple[tuple[str, float], ...] = (),
) -> Maneuver:  # fmt: skip
    """A change to the lane beside: along its own path, from the offset the vehicle has to it, behind who is ahead there."""
    path = picture.paths.along(target, picture.lane_station)
    station, offset = picture.paths.station(path, picture.observation.ego)
    others = place(path.path, picture.observation.tracks)
    front, rear = station + picture.footprint.front, station - picture.footprint.rear_overhang
    half = picture.road_map.lanes[target].widths.min() / 2
    settings = picture.settings
    beside = in_strip(others, -half, half, rear - settings.lane_change_gap_behind, front + settings.lane_change_gap_ahead)
    refused = f"gap:{beside[0].track.id}" if beside and picture.memory.target_lane is None else ""
    ahead = next((item for item in others if item.rear > front - 1.0 and item.left > -half and item.right < half), None)
    ahead = ahead if ahead is not None and picture.is_near_at(ahead, front) else None
    goal = Goal((0.0,), settings.cruise_speed, picture.paths.curves(path), _halt(picture, path, front, rear), follow(ahead))
    over = offset > -settings.settled_offset if side == "left" else offset < settings.settled_offset
    return Maneuver(
        step.current, step.next, picture.lane, path, goal, side, target, passes, side if passes else "none",
        None if ahead is None else ahead.track.id, picture.paths.junction(path, rear), refused=refused or ("settled" if over else ""),
        via=step.via, biases=(*biases, ("move", -settings.move)),
    )  # fmt: skip


def _halt(picture: Picture, path: LanePath, front: float, rear: float) -> StopPoint | None:
    """`Picture.halt` on the target lane's path."""
    junction = picture.paths.junction(path, rear)
    if picture.halt is None or picture.halt is picture.end or junction is None or front > junction.stop_station:
        return picture.paths.end(path, front)
    return replace(picture.halt, station=junction.stop_station)


def _go_on(picture: Picture, step: Step, side: Literal["left", "right"]) -> Maneuver:
    """The change under way; refused when it leads to the other side or is over."""
    target = picture.memory.target_lane
    assert target is not None
    if step.current != step.next or not step.next.endswith(side):
        return refuse(picture, step, "route")
    return into_lane(picture, step, side, picture.paths.onto(target, picture.lane), biases=_needed(picture))


def _no_change(picture: Picture, side: Literal["left", "right"]) -> str:
    """Why no change of lane to a side is made, empty when it is needed now."""
    if side not in (picture.need.side, picture.makes_room) or picture.inside:
        return "route"
    if picture.beside(side) is None:
        return "no_lane"
    if picture.need.side != side:
        return ""
    return "far" if picture.need.room > picture.settings.lane_change_distance * picture.need.changes else ""


def _needed(picture: Picture) -> tuple[tuple[str, float], ...]:
    settings = picture.settings
    if picture.need.side is None:
        return (("makes_room", -settings.give_room),)
    near = 1.0 - min(max(picture.need.room, 0.0) / (settings.lane_change_distance * max(picture.need.changes, 1)), 1.0)
    return (("lane_needed", -settings.need_lane * (0.25 + 0.75 * near)),)
