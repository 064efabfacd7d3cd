"""SUMO connections and traffic lights: which lane leads into which, how the entry is regulated, and what each light shows when."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from itertools import groupby

from regdb_runtime.maps.road_map import Control, Lane, Light, Phase, SignalDirection, Turn
from regdb_runtime.maps.xml_source import XmlNode

TURNS: Mapping[str, Turn] = {"s": "straight", "l": "left", "L": "left", "r": "right", "R": "right", "t": "u_turn"}
CONTROLS: Mapping[str, Control] = {"s": "stop", "w": "all_way_stop", "M": "none", "=": "none", "Z": "none"}
COLORS: Mapping[str, str] = {
    "G": "green", "g": "green", "y": "yellow", "Y": "yellow", "r": "red", "s": "red", "u": "red_yellow", "o": "inactive", "O": "inactive"
}  # fmt: skip
"""`s` is SUMO's red with right turn after a stop: red, what may be done at it is the law's; blinking and dark lights are inactive."""
DIRECTIONS: Mapping[frozenset[Turn], SignalDirection] = {
    frozenset(("straight",)): "straight", frozenset(("left",)): "left", frozenset(("right",)): "right", frozenset(("u_turn",)): "left",
    frozenset(("left", "u_turn")): "left", frozenset(("left", "straight")): "left_straight", frozenset(("straight", "right")): "straight_right",
    frozenset(("left", "right")): "left_right", frozenset(("left", "straight", "u_turn")): "left_straight",
    frozenset(("left", "right", "u_turn")): "left_right",
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class Link:
    """A connection from a lane onto another, through a lane within the junction where there is one; the signal and its index that regulate it."""

    edge: str
    start: str
    onto: str
    via: str | None
    direction: str
    state: str
    signal: str = ""
    index: int = -1


def read_links(root: XmlNode, functions: Mapping[str, str], known: set[str]) -> list[Link]:
    """Every `<connection>` between lanes for vehicles; those of pedestrians are left out."""
    links = []
    for node in root.all("connection"):
        edge, onto = node.attribute("from"), node.attribute("to")
        if any(functions.get(name) in ("walkingarea", "crossing") for name in (edge, onto)):
            continue
        via, signal = node.element.get("via"), node.element.get("tl", "")
        link = Link(
            edge, f"{edge}_{node.attribute('fromLane')}", f"{onto}_{node.attribute('toLane')}", via, node.element.get("dir", "s"),
            node.element.get("state", ""), signal, int(node.number_of("linkIndex", -1)) if signal else -1,
        )  # fmt: skip
        place = f"<connection> from {link.start} to {link.onto}"
        for lane in (link.start, link.onto, link.via):
            if lane is not None and lane not in known:
                raise root.fail(f"has a {place}, which names lane {lane}, which the file does not define")
        links.append(link)
    return links


def control_of(way: Link, major: Collection[str]) -> Control:
    """How a connection's entry is regulated. A minor connection of a `major` edge, one whose others have priority, only gives way to oncoming
    traffic."""
    if way.signal:
        return "signal"
    if way.state != "m":
        return CONTROLS.get(way.state, "unknown")
    return "none" if way.edge in major else "yield"


def read_signals(
    root: XmlNode, links: list[Link], lanes: Mapping[str, Lane], notes: list[str]
) -> tuple[dict[str, Light], dict[str, tuple[str, ...]]]:
    """A light for every signal index (`<tl>/<index>`), with its nominal plan; and for each lane the lights that regulate its connections."""
    programs: dict[str, XmlNode] = {}
    for node in root.all("tlLogic"):
        name = node.attribute("id")
        if name in programs:
            notes.append(f"program {node.element.get('programID', '')!r} of <tlLogic> {name} is not read; the first one is the nominal plan")
        else:
            programs[name] = node
    ways: dict[str, list[Link]] = {}
    for link in links:
        if link.signal:
            ways.setdefault(f"{link.signal}/{link.index}", []).append(link)
    lights: dict[str, Light] = {}
    carried: dict[str, list[str]] = {}
    for name, group in ways.items():
        lights[name] = _light(root, name, group, programs, lanes)
        for link in group:
            carried.setdefault(link.start, []).append(name)
    if lights:
        notes.append("light cycles are a nominal plan; they are no truth about any moment")
    return lights, {lane: tuple(dict.fromkeys(names)) for lane, names in carried.items()}


def _light(root: XmlNode, name: str, group: list[Link], programs: Mapping[str, XmlNode], lanes: Mapping[str, Lane]) -> Light:
    program = programs.get(group[0].signal)
    if program is None:
        raise root.fail(f"has a <connection> with tl={group[0].signal!r}, of which there is no <tlLogic>")
    turns = frozenset(TURNS.get(link.direction, "straight") for link in group)
    end = lanes[group[0].start].center[-1]
    return Light(
        id=name,
        position=(float(end[0]), float(end[1])),
        direction=DIRECTIONS.get(turns, "all"),
        cycle=_phases(program, group[0].index),
        offset=program.number_of("offset", 0.0),
    )


def _phases(program: XmlNode, index: int) -> tuple[Phase, ...]:
    """What one index shows, phase after phase; equal neighbours are one."""
    shown = []
    for phase in program.all("phase"):
        states = phase.attribute("state")
        if not 0 <= index < len(states):
            raise program.fail(f"has a phase of {len(states)} signals, a <connection> asks for number {index}")
        if states[index] not in COLORS:
            raise program.fail(f"shows {states[index]!r}, which is no signal of the format")
        shown.append((COLORS[states[index]], phase.number_of("duration")))
    return tuple(Phase(color, sum(duration for _, duration in run)) for color, run in groupby(shown, key=lambda item: item[0]))
