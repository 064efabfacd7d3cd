"""Junctions: the lane of every movement, limit lines, crosswalks, lights with their cycles, and the signs that control them."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from regdb.vocabulary import Value
from regdb_runtime.errors import WorldError
from regdb_runtime.maps.road_map import Crosswalk, Floats, Lane, Light, Phase, Sign, SignalDirection, StopLine, Turn
from regdb_runtime.worlds.curves import aside, connection
from regdb_runtime.worlds.road_spec import Arm, Control, JunctionSpec, RoadEnd
from regdb_runtime.worlds.streets import Carriageway, Streets, compass

CROSSWALK = (4.0, 1.0)
"""From the road's end back to a crosswalk's far and near side, metres: 3 m (10 ft) wide, as is usual (CA MUTCD 3B.18: 6 ft at least)."""
LINE_BEFORE_CROSSWALK = 1.22
"""From a limit line to the crosswalk, metres: 4 ft (CA MUTCD 3B.16)."""
LINE_BEFORE_END = 0.6
"""From a limit line to the road's end where there is no crosswalk, metres."""
_CONTROL_FACT: dict[Control, str] = {"signal": "signal", "stop": "stop_ego", "all_way_stop": "stop_all", "yield": "yield_ego", "none": "none"}
TURNS: tuple[Turn, ...] = ("left", "straight", "right")
_STRAIGHT_WITHIN = math.radians(45)
_U_TURN_BEYOND = math.radians(150)


@dataclass(frozen=True, eq=False)
class Approach:
    """One arm with its two directions; either may be missing on a one-way road."""

    arm: Arm
    control: Control
    incoming: Carriageway | None
    outgoing: Carriageway | None

    @property
    def heading(self) -> float:
        """Direction of travel into the junction, radians."""
        side = self.incoming
        if side is not None:
            return float(side.headings[-1])
        assert self.outgoing is not None
        return float(self.outgoing.headings[0]) + math.pi

    @property
    def marks_crosswalk(self) -> bool:
        """Whether a crosswalk is marked across the arm."""
        return self.control != "none" if self.arm.crosswalk is None else self.arm.crosswalk

    @property
    def point(self) -> Floats:
        """The road's middle where the junction begins."""
        side = self.incoming
        if side is not None:
            return np.asarray(side.line[-1])
        assert self.outgoing is not None
        return np.asarray(self.outgoing.line[0])


@dataclass(frozen=True, slots=True)
class Movement:
    """One way through a junction: from an approach's lane number (from the right) to another's."""

    turn: Turn
    from_lane: int
    to_lane: int
    exit: int


def build_junctions(streets: Streets) -> tuple[dict[str, Light], tuple[Crosswalk, ...], frozenset[tuple[str, RoadEnd]]]:
    """Lay all junctions; their lights, crosswalks, and the road ends that meet in them."""
    lights: dict[str, Light] = {}
    crosswalks: list[Crosswalk] = []
    ends: set[tuple[str, RoadEnd]] = set()
    for spec in streets.spec.junctions:
        approaches = [_approach(streets, spec, arm) for arm in spec.arms]
        if len(approaches) < 2:
            raise WorldError(f"junction {spec.id!r} needs two arms or more")
        ends.update((arm.road, arm.end) for arm in spec.arms)
        for index, approach in enumerate(approaches):
            crosswalks.extend(_crosswalk(spec, approach))
            if approach.incoming is not None:
                _lay_approach(streets, spec, approaches, index, lights)
    return lights, tuple(crosswalks), frozenset(ends)


def _approach(streets: Streets, spec: JunctionSpec, arm: Arm) -> Approach:
    forward, backward = streets.carriageway(arm.road, backward=False), streets.carriageway(arm.road, backward=True)
    incoming, outgoing = (forward, backward) if arm.end == "end" else (backward, forward)
    return Approach(arm, arm.control or spec.control, incoming, outgoing)


def _lay_approach(streets: Streets, spec: JunctionSpec, approaches: list[Approach], index: int, lights: dict[str, Light]) -> None:
    approach = approaches[index]
    incoming = approach.incoming
    assert incoming is not None
    movements = _movements(approaches, index)
    heads = _heads(spec, approach, approaches) if approach.control == "signal" else {}
    lights.update(heads)
    signs = _signs(streets, spec, approach)
    facts = _facts(spec, approaches, index, movements)
    by_turn: dict[str, tuple[str, ...]] = {turn: tuple(i for i, light in heads.items() if speaks_to(light, turn)) for turn in TURNS}
    for number, lane in enumerate(incoming.lanes, 1):
        own = [item for item in movements if item.from_lane == number]
        told = tuple(dict.fromkeys(light for item in own for light in by_turn[item.turn]))
        _finish_lane(streets, lane, approach, told, signs, frozenset(item.turn for item in own))
    for movement in movements:
        exit_side = approaches[movement.exit].outgoing
        assert exit_side is not None
        suffix = f".{movement.from_lane}" if movement.turn == "straight" else ""
        twin = sum(1 for item in movements if (item.turn, item.from_lane) == (movement.turn, movement.from_lane) and item.exit < movement.exit)
        lane_id = f"{spec.id}.{compass(approach.heading)}.{movement.turn}{suffix}" + (f".{exit_side.road.id}" if twin else "")
        _connect(
            streets, lane_id, spec.id, incoming.lanes[movement.from_lane - 1], exit_side.lanes[movement.to_lane - 1], movement.turn,
            by_turn[movement.turn], facts, approach.control,
        )  # fmt: skip
    _connect_bicycles(streets, spec, approaches, index, facts, by_turn["straight"])


def _movements(approaches: list[Approach], index: int) -> list[Movement]:
    """Every movement from one arm: right turns from the right-hand lane to the right-hand lane, left from left to left, straight lane by lane."""
    approach, found = approaches[index], []
    assert approach.incoming is not None
    count = len(approach.incoming.lanes)
    turns = {exit_index: _turn(approach, other) for exit_index, other in enumerate(approaches) if exit_index != index and other.outgoing is not None}
    offered = {turn for turn in turns.values() if turn is not None}
    for exit_index, turn in turns.items():
        outgoing = approaches[exit_index].outgoing
        assert outgoing is not None
        lanes_out = len(outgoing.lanes)
        if turn is None or (approach.arm.allowed and turn not in approach.arm.allowed):
            continue
        if turn == "right":
            found.append(Movement("right", 1, 1, exit_index))
        elif turn == "left":
            found.append(Movement("left", count, lanes_out, exit_index))
        else:
            for number in range(1, count + 1):
                for_turn = (number == 1 and approach.arm.right_turn_lane and "right" in offered and count > 1) or (
                    number == count and approach.arm.left_turn_lane and "left" in offered and count > 1)
                if not for_turn:
                    found.append(Movement("straight", number, max(1, min(lanes_out, lanes_out - count + number)), exit_index))
    return found


def _turn(approach: Approach, other: Approach) -> Turn | None:
    """How the way from one arm to another leads; None when it leads back."""
    angle = math.remainder(other.heading + math.pi - approach.heading, 2 * math.pi)
    if abs(angle) > _U_TURN_BEYOND:
        return None
    return "straight" if abs(angle) < _STRAIGHT_WITHIN else "left" if angle > 0 else "right"


def _facts(spec: JunctionSpec, approaches: list[Approach], index: int, movements: list[Movement]) -> dict[str, Value]:
    """What the map knows of a junction as seen from one arm."""
    others = {item.control for place, item in enumerate(approaches) if place != index}
    control = _CONTROL_FACT[approaches[index].control]
    if control == "none" and "stop" in others:
        control = "stop_cross"
    elif control == "none" and "yield" in others:
        control = "yield_cross"
    straight = any(item.turn == "straight" for item in movements)
    return {
        "intersection.control": control, "intersection.highway_terminates": not straight,
        "intersection.crossing_highway_terminates": straight and len(spec.arms) == 3,
    }  # fmt: skip


def _heads(spec: JunctionSpec, approach: Approach, approaches: list[Approach]) -> dict[str, Light]:
    """The lights of one arm: arrow heads for the turns that have one, a circular head for the rest, on the far side of the junction."""
    name, arrows = compass(approach.heading), approach.arm.arrows
    rest: list[Turn] = [turn for turn in TURNS if turn not in arrows]
    found: dict[str, Light] = {}
    for place, turn in enumerate(arrows):
        key = f"{name}.{turn}"
        found[f"{spec.id}.{key}.light"] = Light(
            f"{spec.id}.{key}.light", _head_position(approach, approaches, place + 1), _direction([turn]),
            cycle=cycle(spec, key), offset=spec.offset, arrow=True,
        )  # fmt: skip
    if rest:
        position = _head_position(approach, approaches, 0)
        found[f"{spec.id}.{name}.light"] = Light(f"{spec.id}.{name}.light", position, _direction(rest), cycle=cycle(spec, name), offset=spec.offset)
    return found


def _direction(turns: list[Turn]) -> SignalDirection:
    if len(turns) == 3:
        return "all"
    names: dict[frozenset[str], SignalDirection] = {
        frozenset(("left",)): "left", frozenset(("straight",)): "straight", frozenset(("right",)): "right",
        frozenset(("left", "straight")): "left_straight", frozenset(("straight", "right")): "straight_right",
        frozenset(("left", "right")): "left_right",
    }  # fmt: skip
    return names[frozenset(turns)]


def speaks_to(light: Light, turn: str) -> bool:
    """Whether a light speaks to a turn."""
    return light.direction == "all" or turn in light.direction.split("_")


def _head_position(approach: Approach, approaches: list[Approach], place: int) -> tuple[float, float]:
    middle = np.mean([item.point for item in approaches], axis=0)
    ahead = np.array([math.cos(approach.heading), math.sin(approach.heading)])
    right = np.array([ahead[1], -ahead[0]])
    assert approach.incoming is not None
    reach = 2 * float(np.dot(middle - approach.point, ahead))
    x, y = approach.point + ahead * max(reach, 10.0) + right * (approach.incoming.width + 0.8 + 1.2 * place)
    return float(x), float(y)


def cycle(spec: JunctionSpec, key: str) -> tuple[Phase, ...]:
    """What a head shows over one round of its junction's phases, from the first phase's beginning; always red when no phase names it."""
    found: list[Phase] = []
    for index, phase in enumerate(spec.phases):
        following = spec.phases[(index + 1) % len(spec.phases)]
        if key not in phase.heads:
            _append(found, "red", phase.green + phase.yellow + phase.all_red)
        elif key in following.heads:
            _append(found, "green", phase.green + phase.yellow + phase.all_red)
        else:
            _append(found, "green", phase.green)
            _append(found, "yellow", phase.yellow)
            _append(found, "red", phase.all_red)
    return tuple(found) or (Phase("red", 60.0),)


def _append(phases: list[Phase], color: str, duration: float) -> None:
    if duration <= 0.0:
        return
    if phases and phases[-1].color == color:
        phases[-1] = Phase(color, phases[-1].duration + duration)
    else:
        phases.append(Phase(color, duration))


def _signs(streets: Streets, spec: JunctionSpec, approach: Approach) -> tuple[str, ...]:
    """The signs of a controlled arm: STOP (R1-1) with its ALL WAY plaque (R1-3P), or YIELD (R1-2)."""
    codes = {"stop": ("R1-1",), "all_way_stop": ("R1-1", "R1-3P"), "yield": ("R1-2",)}.get(approach.control, ())
    assert approach.incoming is not None
    right = np.array([math.sin(approach.heading), -math.cos(approach.heading)])
    x, y = approach.point + right * (approach.incoming.width + 0.8) - np.array([right[1] * -1, right[0]]) * 2.0
    names = []
    for code in codes:
        name = f"{spec.id}.{compass(approach.heading)}.{code}"
        streets.signs[name] = Sign(name, code, (float(x), float(y)))
        names.append(name)
    return tuple(names)


def _finish_lane(streets: Streets, lane_id: str, approach: Approach, lights: tuple[str, ...], signs: tuple[str, ...], turns: frozenset[str]) -> None:
    """Give an approaching lane its limit line, lights, signs and turns."""
    lane = streets.lanes[lane_id]
    line = None
    if approach.control != "none" and approach.arm.stop_line:
        back = CROSSWALK[0] + LINE_BEFORE_CROSSWALK if approach.marks_crosswalk else LINE_BEFORE_END
        left, right = _back_from_end(lane.left_line, back), _back_from_end(lane.right_line, back)
        line = StopLine(f"{lane_id}.stop_line", left, right, marked=True, lights=lights, signs=signs)
    facts: dict[str, Value] = {**lane.facts, "lane.turns": turns} if turns else dict(lane.facts)
    streets.lanes[lane_id] = replace(lane, stop_line=line, lights=lights, signs=(*lane.signs, *signs), facts=facts)


def _back_from_end(line: Floats, distance: float) -> tuple[float, float]:
    stations = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))))
    at = max(0.0, float(stations[-1]) - distance)
    return float(np.interp(at, stations, line[:, 0])), float(np.interp(at, stations, line[:, 1]))


def _connect(
    streets: Streets, lane_id: str, junction: str, before_id: str, after_id: str, turn: Turn, lights: tuple[str, ...], facts: dict[str, Value],
    control: Control,
) -> None:  # fmt: skip
    """Lay the lane of one movement from the end of one lane to the beginning of another."""
    before, after = streets.lanes[before_id], streets.lanes[after_id]
    points, headings = connection(_end_pose(before.center, last=True), _end_pose(after.center, last=False))
    along = np.linspace(0.0, 1.0, len(points))
    half = (before.widths[-1] + (after.widths[0] - before.widths[-1]) * along) / 2
    width = {"lane.width": float(2 * half.min())}
    streets.lanes[lane_id] = Lane(
        lane_id, aside(points, headings, half), aside(points, headings, -half), points, before.speed_limit, before.kinds | {"intersection"},
        before.users, left_marking="none", right_marking="none", lights=lights, junction=junction, turn=turn, road=junction,
        facts={**before.facts, **facts, **width}, control=control,
    )  # fmt: skip
    streets.add_link(before_id, lane_id)
    streets.add_link(lane_id, after_id)


def _connect_bicycles(
    streets: Streets, spec: JunctionSpec, approaches: list[Approach], index: int, facts: dict[str, Value], lights: tuple[str, ...]
) -> None:
    approach = approaches[index]
    assert approach.incoming is not None
    if approach.incoming.bicycle is None:
        return
    for place, other in enumerate(approaches):
        if place != index and other.outgoing is not None and other.outgoing.bicycle is not None and _turn(approach, other) == "straight":
            lane_id = f"{spec.id}.{compass(approach.heading)}.bike"
            _connect(streets, lane_id, spec.id, approach.incoming.bicycle, other.outgoing.bicycle, "straight", lights, facts, approach.control)


def _end_pose(line: Floats, *, last: bool) -> tuple[float, float, float]:
    step = line[-1] - line[-2] if last else line[1] - line[0]
    x, y = line[-1] if last else line[0]
    return float(x), float(y), math.atan2(float(step[1]), float(step[0]))


def _crosswalk(spec: JunctionSpec, approach: Approach) -> list[Crosswalk]:
    """The marked crosswalk over one arm, kerb to kerb; named by the side of the junction it lies on."""
    if not approach.marks_crosswalk:
        return []
    ahead = np.array([math.cos(approach.heading), math.sin(approach.heading)])
    left = np.array([-ahead[1], ahead[0]])
    into = 0.0 if approach.incoming is None else approach.incoming.width
    out = 0.0 if approach.outgoing is None else approach.outgoing.width
    far, near = (approach.point - ahead * distance for distance in CROSSWALK)
    polygon = np.array([far - left * into, near - left * into, near + left * out, far + left * out])
    return [Crosswalk(f"{spec.id}.crosswalk.{compass(approach.heading + math.pi)}", polygon)]
