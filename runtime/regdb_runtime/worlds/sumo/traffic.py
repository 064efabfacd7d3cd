"""Everybody but the ego and people on foot, driven by SUMO through libsumo; it stands where the built-in world's own traffic stands.

One process runs one simulation, as libsumo has it.
"""

from __future__ import annotations

import math
import tempfile
import warnings
from collections.abc import Iterable
from contextlib import redirect_stderr, redirect_stdout
from io import StringIO
from pathlib import Path
from typing import Any

from regdb_runtime.errors import MissingExtra, WorldError
from regdb_runtime.maps.road_map import RoadMap
from regdb_runtime.observation import EgoState, Footprint, Track
from regdb_runtime.worlds.built_in.lane_tables import LaneTables
from regdb_runtime.worlds.built_in.mover import Mover, TrafficSettings
from regdb_runtime.worlds.built_in.people import Pedestrian
from regdb_runtime.worlds.built_in.signals import Signals
from regdb_runtime.worlds.built_in.traffic import EgoAhead
from regdb_runtime.worlds.sumo.net_layout import Link, Node, layout
from regdb_runtime.worlds.sumo.net_writer import net_xml
from regdb_runtime.worlds.sumo.terms import ALONG_ROUTE, angle_of, heading_of, move, track_of

EGO = "ego"
_LATERAL = 0.3
"""Width of SUMO's sublanes, metres: fine enough for a cyclist at the edge of a lane."""
_running: list[SumoTraffic] = []


def libsumo() -> Any:
    """SUMO as a library. Raises MissingExtra with the command that installs it."""
    try:
        # It prints and warns of another version of a library that it brings itself.
        with warnings.catch_warnings(), redirect_stdout(StringIO()), redirect_stderr(StringIO()):
            warnings.simplefilter("ignore")
            import libsumo as library
    except ModuleNotFoundError as error:
        raise MissingExtra("libsumo", "sim", "a drive in SUMO") from error
    return library


class SumoTraffic:
    """Held by the world; has the methods of `worlds.built_in.traffic.Traffic`. `close` ends the simulation.

    Raises WorldError while another simulation runs in this process.
    """

    def __init__(
        self, road_map: RoadMap, tables: LaneTables, signals: Signals, settings: TrafficSettings, seed: int, footprint: Footprint,
        route: tuple[str, ...],
    ) -> None:  # fmt: skip
        if _running:
            raise WorldError("a SUMO simulation runs in this process already; close it first")
        self._sumo = libsumo()
        self._tables, self._signals, self._settings, self._footprint = tables, signals, settings, footprint
        self._map = road_map
        self._layout = layout(road_map)
        self._edge_of = {lane: (edge.id, index) for edge in self._layout.edges for index, lane in enumerate(edge.lanes)}
        self.movers: list[Mover] = []
        self._added: dict[str, Mover] = {}
        self._headings: dict[str, float] = {}
        self._standing: list[Track] = []
        self._blockers: set[str] = set()
        self._folder = tempfile.TemporaryDirectory(prefix="regdb-sumo-")
        self._start(seed)
        self._add_ego(route)
        _running.append(self)

    def _start(self, seed: int) -> None:
        net = Path(self._folder.name) / "streets.net.xml"
        net.write_text(net_xml(self._map, self._layout), encoding="utf-8")
        options = {
            "--net-file": str(net), "--step-length": f"{self._settings.step}", "--seed": str(seed + 1), "--lateral-resolution": str(_LATERAL),
            "--collision.action": "none", "--time-to-teleport": "-1", "--no-warnings": "true", "--no-step-log": "true", "--time-to-impatience": "30",
        }  # fmt: skip
        try:
            self._sumo.start(["sumo", *(word for pair in options.items() for word in pair)])
        except Exception as error:
            raise WorldError(f"SUMO refuses these streets: {error}") from error

    def close(self) -> None:
        """End the simulation; a second call does nothing."""
        if self in _running:
            _running.remove(self)
            self._sumo.close()
            self._folder.cleanup()

    def add_standing(self, track: Track) -> None:
        """Something that never moves; it stands in SUMO's way where it reaches into a lane."""
        self._standing.append(track)

    def room_at(self, lane: str, station: float, half_length: float, gap: float) -> bool:
        """Whether a vehicle could appear there with `gap` metres before and behind."""
        x, y, _ = self._tables[lane].pose(station, 0.0)
        waiting = any(mover.id not in self._added and mover.route[0] == lane for mover in self.movers)
        return not waiting and all(math.hypot(track.x - x, track.y - y) > track.length / 2 + half_length + gap for track in self.tracks(-math.inf))

    def step(self, time: float, step: float, ego: EgoState, footprint: Footprint, ahead: EgoAhead, people: Iterable[Pedestrian]) -> None:  # noqa: ARG002
        """One step of SUMO's, with the ego, the people on foot and the lights as they are now. `step` is the settings' own."""
        self._let_in(time)
        self._show_lights(time)
        move(self._sumo.vehicle, EGO, ego.front_bumper(footprint), ego.heading, ego.speed)
        self._block(people)
        self._wish(time)
        self._headings = {name: self._heading(name) for name in self._present()}
        self._sumo.simulationStep()
        present = set(self._sumo.vehicle.getIDList())
        arrived = {name for name in self._sumo.simulation.getArrivedIDList() if name in self._added}
        self.movers = [mover for mover in self.movers if mover.id not in arrived and not self._left(mover, present)]

    def tracks(self, time: float) -> list[Track]:
        """Everybody who is there now, in the order in which they came."""
        present = set(self._sumo.vehicle.getIDList())
        waiting = [mover.track() for mover in self.movers if mover.id not in self._added and mover.enters <= time + 1e-9]
        return [self._track(mover) for name, mover in self._added.items() if name in present] + waiting

    def _present(self) -> list[str]:
        here = set(self._sumo.vehicle.getIDList())
        return [name for name in self._added if name in here]

    def _add_ego(self, route: tuple[str, ...]) -> None:
        self._sumo.vehicletype.copy("DEFAULT_VEHTYPE", EGO)
        self._sumo.vehicletype.setLength(EGO, self._footprint.length)
        self._sumo.vehicletype.setWidth(EGO, self._footprint.width)
        self._sumo.route.add(EGO, self._edges(route))
        self._sumo.vehicle.add(EGO, EGO, typeID=EGO, departSpeed="0")
        self._sumo.vehicle.setSpeedMode(EGO, 0)
        self._sumo.vehicle.setLaneChangeMode(EGO, 0)

    def _edges(self, lanes: Iterable[str]) -> list[str]:
        """The edges of a way along lanes; those within junctions are SUMO's to find."""
        return list(dict.fromkeys(self._edge_of[lane][0] for lane in lanes if lane in self._edge_of))

    def _let_in(self, time: float) -> None:
        for mover in self.movers:
            if mover.id not in self._added and mover.enters <= time + 1e-9:
                self._added[mover.id] = mover
                self._add(mover, time)

    def _add(self, mover: Mover, time: float) -> None:
        sumo, name = self._sumo, mover.id
        lane = next((lane for lane in mover.route if lane in self._edge_of), None)
        if lane is None:
            raise WorldError(f"{name}: SUMO lets nobody begin within a junction")
        station = mover.station if lane == mover.route[0] else 0.0
        kind = sumo.vehicletype
        kind.copy("DEFAULT_BIKETYPE" if mover.bicycle else "DEFAULT_VEHTYPE", name)
        for write, value in (
            (kind.setLength, mover.length), (kind.setWidth, mover.width), (kind.setTau, mover.idm.headway), (kind.setMinGap, mover.idm.jam_distance),
            (kind.setAccel, mover.idm.acceleration), (kind.setDecel, max(mover.idm.braking, self._settings.comfortable)),
        ):  # fmt: skip
            write(name, value)
        kind.setLateralAlignment(name, f"{mover.resting_offset:.3f}" if mover.bicycle else "center")
        sumo.route.add(name, self._edges(mover.route))
        front = min(station + mover.half_length, self._tables[lane].length)
        sumo.vehicle.add(
            name, name, typeID=name, departLane=str(self._edge_of[lane][1]), departPos=f"{front:.3f}", departSpeed=f"{mover.speed:.3f}"
        )
        if mover.bicycle:
            edge, index = self._edge_of[lane]
            x, y, heading = self._tables[lane].pose(front, mover.resting_offset)
            sumo.vehicle.moveToXY(name, edge, index, x, y, angle_of(heading), ALONG_ROUTE)
            sumo.vehicle.setPreviousSpeed(name, mover.speed)
        sumo.vehicle.setParameter(name, "laneChangeModel.lcKeepRight", "0")
        sumo.vehicle.setSpeedFactor(name, mover.scattered)
        self._set_wish(mover, mover.wished_speed(time) if mover.wish is not None or mover.speeds else None)

    def _wish(self, time: float) -> None:
        """Those whose wishes change with time."""
        for name in self._present():
            mover = self._added[name]
            if mover.speeds:
                self._set_wish(mover, mover.wished_speed(time))

    def _set_wish(self, mover: Mover, wish: float | None) -> None:
        if wish is None:
            return
        self._sumo.vehicle.setSpeedFactor(mover.id, 3.0)
        self._sumo.vehicle.setMaxSpeed(mover.id, max(wish, 0.1))
        if mover.speeds:
            self._sumo.vehicle.setSpeed(mover.id, 0.0 if wish < 0.1 else -1.0)

    def _left(self, mover: Mover, present: set[str]) -> bool:
        """A cyclist who turns off the road leaves SUMO there."""
        if mover.leaves_at is None or mover.id not in present:
            return False
        lane = self._edge_of.get(mover.route[0])
        where = self._sumo.vehicle.getLaneID(mover.id)
        if lane is None or where != f"{lane[0]}_{lane[1]}" or self._sumo.vehicle.getLanePosition(mover.id) < mover.leaves_at:
            return False
        self._sumo.vehicle.remove(mover.id)
        return True

    def _show_lights(self, time: float) -> None:
        for node in self._layout.nodes:
            if node.lights:
                self._sumo.trafficlight.setRedYellowGreenState(node.id, "".join(self._letter(node, link, time) for link in node.links))

    def _letter(self, node: Node, link: Link, time: float) -> str:
        """SUMO's letter for a link: `G` go, `g` go after giving way, `y`, `r`, `s` go after a stop (right on red)."""
        lights = () if link.inner is None else self._map.lanes[link.inner].lights
        name = self._signals.governing(lights)
        if name is None:
            return "o"
        color = self._signals.color(name, time)
        if color == "red" and link.turn == "right" and not self._signals.is_arrow(name) and self._settings.right_on_red:
            return "s"
        gives_way = link.turn in {"left", "u_turn", "right"} and not self._signals.is_arrow(name)
        return {"green": "g" if gives_way else "G", "yellow": "y", "red": "r"}.get(color, "o" if node.lights else "O")

    def _block(self, people: Iterable[Pedestrian]) -> None:
        """People on the roadway and things that stand there, as small vehicles that SUMO's drivers see."""
        wanted = {f"person {p.spec.id}": (p.place(), p.spec.size, p.spec.size) for p in people}
        wanted |= {f"standing {t.id}": ((t.x, t.y, t.heading), t.length, t.width) for t in self._standing}
        on_road = {name: item for name, item in wanted.items() if self._on_lane(*item)}
        for name in sorted(self._blockers - on_road.keys()):
            self._sumo.vehicle.remove(name)
            self._blockers.discard(name)
        for name, ((x, y, heading), length, width) in on_road.items():
            if name not in self._blockers:
                self._add_blocker(name, length, width)
            front = x + length / 2 * math.cos(heading), y + length / 2 * math.sin(heading)
            move(self._sumo.vehicle, name, front, heading, 0.0)

    def _on_lane(self, place: tuple[float, float, float], length: float, width: float) -> bool:
        x, y, _ = place
        return any(abs(offset) < table.half_width + width / 2 for table, _, offset in self._tables.under(x, y, length))

    def _add_blocker(self, name: str, length: float, width: float) -> None:
        if name not in self._sumo.vehicletype.getIDList():
            self._sumo.vehicletype.copy("DEFAULT_VEHTYPE", name)
            self._sumo.vehicletype.setLength(name, length)
            self._sumo.vehicletype.setWidth(name, width)
            self._sumo.route.add(name, self._sumo.route.getEdges(EGO))
        self._sumo.vehicle.add(name, name, typeID=name, departSpeed="0")
        self._sumo.vehicle.setSpeedMode(name, 0)
        self._sumo.vehicle.setLaneChangeMode(name, 0)
        self._blockers.add(name)

    def _heading(self, name: str) -> float:
        return heading_of(self._sumo.vehicle.getAngle(name))

    def _track(self, mover: Mover) -> Track:
        heading = self._heading(mover.id)
        turned = math.remainder(heading - self._headings.get(mover.id, heading), math.tau)
        lights = mover.warning_lights, mover.hazard_kind
        return track_of(self._sumo.vehicle, mover.id, mover.kind, (mover.length, mover.width), turned / self._settings.step, lights)
