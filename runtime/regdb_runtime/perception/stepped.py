"""The perception loop in simulated time: the same state machine and no thread; an answer counts when it would have come."""

from __future__ import annotations

from collections.abc import Callable

from regdb_runtime.observation import Provenance
from regdb_runtime.perception.describer import Describer, Description, Frame
from regdb_runtime.perception.evidence import Snapshot
from regdb_runtime.perception.loop import Belief
from regdb_runtime.perception.loop_core import AsksPrompts, Attention, Call, Health, Locate, LoopCore, LoopSettings


class SteppedPerception:
    """`attend`, `offer` and `snapshot` as PerceptionLoop has them, for worlds whose time is not the wall's.

    The describer is asked at once, and its answer kept until `took` seconds of simulated time have passed; one that took longer than the
    deadline becomes that failure at the deadline. Whatever is to happen between two calls happens at its own time, in order, so a drive does
    not depend on how fast the machine is. `clock`: simulated seconds since the run began.
    """

    def __init__(
        self, describer: Describer, prompts: AsksPrompts, belief: Belief, clock: Callable[[], float], settings: LoopSettings | None = None,
        initial: str = "lane_following.go_straight", locate: Locate | None = None,
    ) -> None:  # fmt: skip
        self._describer, self._belief, self._clock = describer, belief, clock
        self._settings = settings or LoopSettings()
        self._core = LoopCore(prompts, self._settings, locate)
        self._attention = Attention(initial)
        self._due: tuple[float, Description] | None = None
        self.latest = belief.snapshot(self._core.health, self._settings, clock(), self._attention)
        self.last_answer: tuple[Call, Description] | None = None

    @property
    def provenance(self) -> Provenance:
        """Where the facts come from: the describer's."""
        return self._describer.provenance

    @property
    def health(self) -> Health:
        """How the model answers."""
        return self._core.health

    def attend(self, state: str, missing: tuple[str, ...] = (), travelled: float = 0.0, relevant: frozenset[str] | None = None) -> None:
        """Say what the planner is at, as PerceptionLoop.attend."""
        self._attention = Attention(state, missing, travelled, relevant)

    def offer(self, frame: Frame) -> None:
        """A new frame; it replaces one not asked about yet. What was due before it happens first."""
        now = self._clock()
        self._until(now)
        self._core.offer(frame, self._attention)
        self._ask(now)

    def snapshot(self) -> Snapshot:
        """What holds now."""
        now = self._clock()
        self._until(now)
        self.latest = self._belief.snapshot(self._core.health, self._settings, now, self._attention)
        self._core.questions = self.latest.questions
        return self.latest

    def _until(self, now: float) -> None:
        """Everything up to now: answers that come, and the questions that they, or the end of a pause, make room for."""
        while self._due is not None and self._due[0] <= now:
            when, description = self._due
            self._due = None
            self._finish(description, when)
            self._ask(min(max(when, self._core.waits_until), now))
        self._ask(now)

    def _ask(self, now: float) -> None:
        call = self._core.next_call(now)
        if call is None:
            return
        found = self._describer.describe(call.frame, call.prompt, self._settings.deadline)
        took = min(found.took, self._settings.deadline)
        if found.took > self._settings.deadline and not found.failure:
            found = Description("", "deadline", f"the answer took {found.took:.2f} s", took, found.model)
        self._due = now + took, found

    def _finish(self, description: Description, when: float) -> None:
        call = self._core.finished(description, when)
        self.last_answer = call, description
        if not description.failure:
            reading = self._belief.read(call, description, self._describer.provenance)
            self._belief.fusion.update(reading, call.travelled, when)
