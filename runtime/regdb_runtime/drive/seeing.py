"""A drive that sees through frames: camera, question by state, a model's answer, its reading, fusion; all in the drive's own time.

Nothing runs beside the drive: a question put at one tick is answered so many seconds later, as the model's `took` says, and until then
the planner drives by what is believed. So a drive repeats to the bit, at any rate of the model.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Protocol

from regdb.vocabulary import Value, Vocabulary
from regdb_runtime.database import RegulationDatabase
from regdb_runtime.decision import Decision
from regdb_runtime.drive.frame_camera import Shot
from regdb_runtime.legality import View
from regdb_runtime.observation import EgoState, Observation, Provenance
from regdb_runtime.perception.answer_reading import ReadsText, read_answer
from regdb_runtime.perception.describer import Describer, Description
from regdb_runtime.perception.evidence import Snapshot
from regdb_runtime.perception.fusion import Fusion
from regdb_runtime.perception.loop_core import Attention, Call, LoopCore, LoopSettings
from regdb_runtime.perception.prompts import PromptMaker
from regdb_runtime.perception.relevance import relevant_facts
from regdb_runtime.planner import Planner
from regdb_runtime.scenes.tellers import eye_facts
from regdb_runtime.worlds.built_in.world import BuiltInWorld

UNKNOWN = 1
"""Rank of a candidate of which nobody can say whether it is lawful."""
ASKS_EVERY = LoopSettings(period=0.5)
"""Two questions a second: LLaVA-1.5-7B in 4 bit (paper, Table IV)."""
AHEAD = 120.0
"""Metres ahead within which a junction or zone of the map makes its facts matter."""


class Prompts:
    """Makers of prompts, one for each set of facts that matters somewhere."""

    def __init__(self, database: RegulationDatabase, view: View) -> None:
        self._database, self._view = database, view
        self._makers: dict[frozenset[str], PromptMaker] = {}

    def about(self, facts: frozenset[str]) -> PromptMaker:
        """The maker that asks about these facts alone."""
        if facts not in self._makers:
            self._makers[facts] = PromptMaker(self._database.machine, self._database.vocabulary, self._view, asks=facts)
        return self._makers[facts]


class Camera(Protocol):
    """Whatever takes frames of the drive."""

    def take(self) -> Shot: ...


@dataclass(frozen=True, eq=False)
class Chain:
    """What stands between a frame and a fact."""

    camera: Camera
    describer: Describer
    prompts: Prompts
    matcher: ReadsText
    vocabulary: Vocabulary


class FramesEye:
    """An eye of a world. `attend` tells it what the planner is at; `snapshot` is what it believed at the last look."""

    def __init__(self, world: BuiltInWorld, chain: Chain, settings: LoopSettings = ASKS_EVERY) -> None:
        self._world, self._chain = world, chain
        self._tells = eye_facts(chain.vocabulary)
        self._core = LoopCore(chain.prompts.about(self._tells), settings)
        self._fusion = Fusion(chain.vocabulary, tells=self._tells)
        self._places = _Places(world)
        self._settings = settings
        self._pending: tuple[float, Call, Description] | None = None
        self._attention = Attention("lane_following.go_straight")
        self._at: tuple[float, float] | None = None
        self._travelled = 0.0
        self.snapshot = Snapshot(0.0, silent=self._tells)
        self.answers: list[tuple[float, Call, Description]] = []

    @property
    def provenance(self) -> Provenance:
        """Where the facts come from: the describer's."""
        return self._chain.describer.provenance

    def attend(self, decision: Decision) -> None:
        """What the planner is at: its state, and the facts that would settle what it does not know, for the next question."""
        if not decision.strategic:
            self._attention = replace(self._attention, state=decision.state)  # it weighed no other state, so it missed nothing
            return
        unknown = [item for item in decision.candidates if item.rank == UNKNOWN and item.verdict is not None and item.cost is not None]
        unknown.sort(key=lambda item: item.cost.total if item.cost is not None else 0.0)
        missing = dict.fromkeys(fact for item in unknown if item.verdict is not None for fact in item.verdict.missing)
        self._attention = Attention(decision.state, tuple(missing), self._travelled)

    def look(self, time: float, ego: EgoState) -> tuple[Mapping[str, Value], frozenset[str]]:
        """Facts believed now, and those that perception would report but does not."""
        if self._at is not None:
            self._travelled += math.dist(self._at, (ego.x, ego.y))
        self._at = ego.x, ego.y
        self._take_in(time)
        relevant = relevant_facts(self._chain.vocabulary, self._places.known(ego))
        self._ask(time, relevant)
        self.snapshot = self._fusion.snapshot(time, self._travelled, relevant)
        facts = {name: value for name, value in self.snapshot.facts.items() if name in self._tells}
        # While the model answers, what it does not speak of may be assumed as the vocabulary says; nothing may while it does not.
        return facts, self._tells.difference(facts) if self.snapshot.degraded else frozenset()

    def _take_in(self, time: float) -> None:
        """The answer that has come by now."""
        if self._pending is None or time < self._pending[0] - 1e-9:
            return
        _, call, description = self._pending
        self._pending = None
        self._core.finished(description, time)
        reading = read_answer(description, self._chain.matcher, self._chain.vocabulary, call.frame, call.prompt)
        if not description.failure:
            self._fusion.update(reading, call.travelled, time)
        self.answers.append((time, call, description))

    def _ask(self, time: float, relevant: frozenset[str]) -> None:
        """The next question, if one may be put, about what matters here; a frame is taken only for it."""
        if self._core.in_flight is not None or time < self._core.waits_until - 1e-9:
            return
        self._core.prompts = self._chain.prompts.about(relevant & self._tells)
        self._core.offer(self._chain.camera.take().frame, Attention(self._attention.state, self._attention.missing, self._travelled))
        call = self._core.next_call(time)
        if call is not None:
            description = self._chain.describer.describe(call.frame, call.prompt, self._settings.deadline)
            self._pending = time + description.took, call, description


class SeeingPlanner:
    """A planner whose eye is told after each tick what it is at."""

    def __init__(self, planner: Planner, eye: FramesEye) -> None:
        self._planner, self._eye = planner, eye

    def step(self, observation: Observation) -> Decision:
        """The planner's decision."""
        decision = self._planner.step(observation)
        self._eye.attend(decision)
        return decision


class _Places:
    """What the map knows of where the ego is and what lies ahead on its route, as far as it makes facts matter."""

    def __init__(self, world: BuiltInWorld) -> None:
        self._map, self._route = world.road_map, world.route

    def known(self, ego: EgoState) -> Mapping[str, Value]:
        """The map's facts here, with those of the junctions and zones within reach."""
        found = dict(self._map.facts)
        for lane in (self._map.lanes[name] for name in self._route):
            away = min(math.dist((ego.x, ego.y), place) for place in (lane.center[0], lane.center[-1], lane.center[len(lane.center) // 2]))
            if away <= AHEAD:
                found |= {name: value for name, value in lane.facts.items() if value not in (False, "none")}
                if lane.lights:
                    found |= {"signal.present": True, "signal.place": "intersection"}
                if lane.junction is not None:
                    found |= {"intersection.present": True}
        for zone in self._map.zones:
            if min(math.dist((ego.x, ego.y), place) for place in zone.polygon) <= AHEAD:
                found |= zone.facts
        return found


def seeing(world: BuiltInWorld, database: RegulationDatabase, describer: Describer, camera: Camera, matcher: ReadsText) -> FramesEye:
    """The eye of a world whose questions follow the law of its place and day."""
    vocabulary = database.vocabulary
    view = database.at(world.road_map.jurisdiction or "california", world.spec.start[:10])
    return FramesEye(world, Chain(camera, describer, Prompts(database, view), matcher, vocabulary))
