"""The perception loop: a thread asks the model about the latest frame, one call at a time; the planner reads a snapshot and never waits."""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Protocol

from regdb.vocabulary import Value, Vocabulary
from regdb_runtime.observation import EgoState, Provenance
from regdb_runtime.perception.answer_reading import ReadsText, read_answer
from regdb_runtime.perception.describer import Closing, Describer, Description, Frame
from regdb_runtime.perception.evidence import Reading, Snapshot
from regdb_runtime.perception.loop_core import AsksPrompts, Attention, Call, Health, Locate, LoopCore, LoopSettings, degraded
from regdb_runtime.perception.questions import answer


class Fuses(Protocol):
    """Whatever holds what is believed: perception's fusion. It is only ever called from one thread."""

    def update(self, reading: Reading, travelled: float, now: float) -> object:
        """Take in what one answer said. `travelled`: metres since the run began, where the frame was taken; `now`: seconds, when it was read."""
        ...

    def snapshot(self, now: float, travelled: float, relevant: frozenset[str] | None = None) -> Snapshot:
        """What holds now, here; `relevant`: the facts that matter here, None for all."""
        ...


@dataclass(frozen=True)
class Belief:
    """What turns descriptions into a snapshot."""

    fusion: Fuses
    matcher: ReadsText | None
    vocabulary: Vocabulary

    def read(self, call: Call, description: Description, provenance: Provenance) -> Reading:
        """The statements of one answer, captured when its frame was; those of a script are labelled so."""
        if call.question is not None:
            found = answer(call.question, description.text, call.frame.captured, call.frame.id, description.model)
        else:
            found = read_answer(description, self.matcher, self.vocabulary, call.frame, call.prompt)
        if provenance != "scripted":
            return found
        return replace(found, statements=tuple(replace(item, source="scripted") for item in found.statements))

    def snapshot(self, health: Health, settings: LoopSettings, now: float, attention: Attention) -> Snapshot:
        """The fusion's snapshot; where the loop knows why perception is degraded, it says so."""
        found = self.fusion.snapshot(now, attention.travelled, attention.relevant)
        why = degraded(health, now, settings)
        return replace(found, degraded=why) if why else found


class PerceptionLoop:
    """Start it, `attend` and `offer` as things change, read `snapshot`; `stop` ends it. None of these waits for the model.

    The thread holds no lock while it calls, reads and queues an answer; the planner's thread fuses what has come when it asks for a snapshot,
    so that the fusion is only ever used by one thread and times are the planner's own. `latest` is the last snapshot made, for anyone.
    `clock`: seconds since the run began, the same as frames are stamped with.
    """

    def __init__(
        self, describer: Describer, prompts: AsksPrompts, belief: Belief, clock: Callable[[], float] | None = None,
        settings: LoopSettings | None = None, initial: str = "lane_following.go_straight", locate: Locate | None = None,
    ) -> None:  # fmt: skip
        began = time.monotonic()
        self._describer, self._belief = describer, belief
        self._clock = clock or (lambda: time.monotonic() - began)
        self._settings = settings or LoopSettings()
        self._core = LoopCore(prompts, self._settings, locate)
        self._attention = Attention(initial)
        self._answers: deque[tuple[Reading, float, float]] = deque(maxlen=64)
        self._wake, self._stopping = threading.Event(), threading.Event()
        self._thread: threading.Thread | None = None
        self.latest = belief.snapshot(self._core.health, self._settings, self._clock(), self._attention)
        self.last_answer: tuple[Call, Description] | None = None

    @property
    def provenance(self) -> Provenance:
        """Where the facts come from: the describer's."""
        return self._describer.provenance

    @property
    def health(self) -> Health:
        """How the model answers; counts of calls, answers and frames passed over."""
        return self._core.health

    def start(self) -> PerceptionLoop:
        """Begin to ask. Raises RuntimeError when it has begun already."""
        if self._thread is not None:
            raise RuntimeError("this loop has been started already")
        self._thread = threading.Thread(target=self._run, name="perception-loop", daemon=True)
        self._thread.start()
        return self

    def attend(self, state: str, missing: tuple[str, ...] = (), travelled: float = 0.0, relevant: frozenset[str] | None = None) -> None:
        """Say what the planner is at: the state whose prompt is asked, facts that would settle a verdict, metres travelled so far, and the
        facts that map and state make matter here."""
        self._attention = Attention(state, missing, travelled, relevant)

    def offer(self, frame: Frame) -> None:
        """A new frame; it replaces one not asked about yet."""
        self._core.offer(frame, self._attention)
        self._wake.set()

    def snapshot(self) -> Snapshot:
        """What holds now: takes in what was answered since the last call, and lets the rest age. For the planner's thread alone."""
        now = self._clock()
        while self._answers:
            reading, where, when = self._answers.popleft()
            self._belief.fusion.update(reading, where, when)
        self.latest = self._belief.snapshot(self._core.health, self._settings, now, self._attention)
        self._core.questions = self.latest.questions
        return self.latest

    def stop(self, seconds: float = 5.0) -> bool:
        """End: a call in flight is cancelled where the client can. Whether the thread has ended within `seconds`."""
        self._stopping.set()
        self._wake.set()
        if isinstance(self._describer, Closing):
            self._describer.close()
        if self._thread is None:
            return True
        self._thread.join(seconds)
        return not self._thread.is_alive()

    def __enter__(self) -> PerceptionLoop:
        return self.start()

    def __exit__(self, *_: object) -> None:
        self.stop()

    def _run(self) -> None:
        while not self._stopping.is_set():
            self._wake.clear()
            call = self._next()
            if call is not None:
                self._ask(call)
                continue
            pause = self._core.waits_until - self._clock()
            self._wake.wait(pause if pause > 0 else None)
            if pause > 0:
                self._stopping.wait(max(self._core.waits_until - self._clock(), 0.0))

    def _next(self) -> Call | None:
        """The next question; a prompt that cannot be made is a failure like any other, not the end of the thread."""
        try:
            return self._core.next_call(self._clock())
        except Exception as error:  # noqa: BLE001  # perception degrades, it does not die
            self._core.refused(f"no prompt can be made: {error}", self._clock())
            return None

    def _ask(self, call: Call) -> None:
        description = self._describe(call)
        if self._stopping.is_set():
            return
        reading = Reading("")
        if not description.failure:
            try:
                reading = self._belief.read(call, description, self._describer.provenance)
            except Exception as error:  # noqa: BLE001  # an answer that breaks its reader is an answer that cannot be read
                description = replace(description, text="", failure="malformed", detail=f"the answer cannot be read: {error}")
        now = self._clock()
        if not description.failure:
            self._answers.append((reading, call.travelled, now))
        self._core.finished(description, now)
        self.last_answer = call, description

    def _describe(self, call: Call) -> Description:
        try:
            return self._describer.describe(call.frame, call.prompt, self._settings.deadline)
        except Exception as error:  # noqa: BLE001  # a client should not raise; one that does is no reason to end
            return Description("", "malformed", f"{type(error).__name__}: {error}")


class Perceives(Protocol):
    """A loop, in wall-clock time or in simulated time."""

    @property
    def provenance(self) -> Provenance: ...

    def attend(self, state: str, missing: tuple[str, ...] = (), travelled: float = 0.0, relevant: frozenset[str] | None = None) -> None: ...

    def snapshot(self) -> Snapshot: ...


@dataclass
class LoopEye:
    """A loop as the eye of a world: what it believes now, for the planner. It follows the ego's way by the positions it is shown.

    `attention`: what the planner is at, asked at every look; its `travelled` is worked out here. `tells`: the facts handed on; None is all.
    """

    loop: Perceives
    attention: Callable[[], Attention]
    tells: frozenset[str] | None = None
    _travelled: float = 0.0
    _at: tuple[float, float] | None = field(default=None, repr=False)

    @property
    def provenance(self) -> Provenance:
        """Where the facts come from."""
        return self.loop.provenance

    def look(self, time: float, ego: EgoState) -> tuple[Mapping[str, Value], frozenset[str]]:  # noqa: ARG002  # the loop has the clock
        """Facts believed now, and those that perception would report but does not."""
        if self._at is not None:
            self._travelled += ((ego.x - self._at[0]) ** 2 + (ego.y - self._at[1]) ** 2) ** 0.5
        self._at = ego.x, ego.y
        now = self.attention()
        self.loop.attend(now.state, now.missing, self._travelled, now.relevant)
        found = self.loop.snapshot()
        if self.tells is None:
            return found.facts, found.silent
        return {name: value for name, value in found.facts.items() if name in self.tells}, found.silent
