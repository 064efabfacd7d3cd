"""The perception loop as a state machine fed with events: which frame is asked about next, and how well perception is; no threads, no clock."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any, Protocol

from regdb_runtime.perception.describer import Box, Description, Frame, Prompt
from regdb_runtime.perception.evidence import Question

Locate = Callable[[Frame, str], Box | None]
"""Where in a frame a fact was seen; a detector knows, a language model does not."""


class AsksPrompts(Protocol):
    """Whatever makes prompts: a PromptMaker."""

    def prompt(
        self, state_id: str, missing: tuple[str, ...] = (), history: tuple[tuple[str, str], ...] = (), relevant: frozenset[str] | None = None,
        turn: int = 0,
    ) -> Prompt | None: ...  # fmt: skip


@dataclass(frozen=True)
class LoopSettings:
    """Times in seconds.

    `deadline`: wall-clock bound of one call; the slowest model of the paper's Table IV (13B, 8-bit, below 0.5 Hz) needs more than the default.
    `period`: least time between starts of calls; 0 asks again as soon as an answer is there. `oldest_frame`: a frame older than this is not
    worth asking about. `first_backoff` doubles with each failure in a row up to `longest_backoff`. `late_after`: age of the newest frame
    answered from which perception is called degraded. `turns`: how many answered questions are kept for prompts that carry earlier ones.
    `choice_tokens`: how long the answer to a closed question may become; every other call at most is one, so that the scene stays watched.
    """

    deadline: float = 2.0
    period: float = 0.0
    oldest_frame: float = 0.5
    first_backoff: float = 0.5
    longest_backoff: float = 8.0
    late_after: float = 3.0
    turns: int = 8
    choice_tokens: int = 16


@dataclass(frozen=True, slots=True)
class Attention:
    """What the planner is at: state id, facts that would settle an unknown verdict, metres travelled since the run began, and the facts that
    map and state make matter here (None: all)."""

    state: str
    missing: tuple[str, ...] = ()
    travelled: float = 0.0
    relevant: frozenset[str] | None = None


@dataclass(frozen=True, slots=True)
class Call:
    """One question to the model: when it began, about which frame, and where the vehicle was when that was taken. `question`: the closed one
    that it puts, if it does."""

    frame: Frame
    prompt: Prompt
    travelled: float
    started: float
    question: Question | None = None


@dataclass(frozen=True, slots=True)
class Health:
    """How perception is. `failures`: in a row; `reason`: of the last; `waits_until`: no call before then; `answered`: capture time of the last
    frame that was answered; `asking`: whether the state asks at all; `calls`, `answers`, `skipped`: counts since the start."""

    failures: int = 0
    reason: str = ""
    waits_until: float = 0.0
    answered: float | None = None
    asking: bool = True
    calls: int = 0
    answers: int = 0
    skipped: int = 0


@dataclass
class LoopCore:
    """Feed it `offer` and `finished`; ask it `next_call`. For one thread, save that `offer` may be called, and `questions` set, from another.

    `questions`: the closed ones that are open; `locate` says on which crop to put them, without it they are put on the whole frame.
    """

    prompts: AsksPrompts
    settings: LoopSettings = field(default_factory=LoopSettings)
    locate: Locate | None = None
    questions: tuple[Question, ...] = ()

    def __post_init__(self) -> None:
        self.health = Health()
        self._chose = False
        self._offered: deque[tuple[Frame, Attention]] = deque(maxlen=1)
        self._in_flight: Call | None = None
        self._history: deque[tuple[str, str]] = deque(maxlen=max(self.settings.turns, 1))
        self._next_start = 0.0

    @property
    def in_flight(self) -> Call | None:
        """The call that has no answer yet."""
        return self._in_flight

    def offer(self, frame: Frame, attention: Attention) -> None:
        """A new frame; it takes the place of one that nobody has asked about yet."""
        self._offered.append((frame, attention))

    def next_call(self, now: float) -> Call | None:
        """The question to ask now, if any: one call in flight, none while backing off, none where the state asks nothing."""
        if self._in_flight is not None or now < self.waits_until:
            return None
        try:
            frame, attention = self._offered.pop()
        except IndexError:
            return None
        if now - frame.captured > self.settings.oldest_frame:
            self._change(skipped=self.health.skipped + 1)
            return None
        prompt = self.prompts.prompt(attention.state, attention.missing, tuple(self._history), attention.relevant, self.health.calls)
        self._change(asking=prompt is not None)
        if prompt is None:
            return None
        question = self._choice()
        if question is not None:
            crop = self.locate(frame, question.fact) if self.locate is not None else None
            prompt = Prompt(question.text, name=f"choice:{question.fact}", max_tokens=self.settings.choice_tokens, crop=crop)
        self._in_flight = Call(frame, prompt, attention.travelled, now, question)
        self._next_start = now + self.settings.period
        self._change(calls=self.health.calls + 1)
        return self._in_flight

    def _choice(self) -> Question | None:
        """A closed question, unless the call before was one."""
        open_ones = self.questions
        self._chose = bool(open_ones) and not self._chose
        return open_ones[0] if self._chose else None

    @property
    def waits_until(self) -> float:
        """No call before this time."""
        return max(self.health.waits_until, self._next_start)

    def finished(self, description: Description, now: float) -> Call:
        """The answer to the call in flight, or its failure. Returns that call. Raises RuntimeError when none was in flight."""
        call = self._in_flight
        if call is None:
            raise RuntimeError("an answer came, but no call was in flight")
        self._in_flight = None
        if description.failure:
            self._failed(f"{description.failure}: {description.detail}" if description.detail else description.failure, now)
        else:
            if call.question is None:
                self._history.append((call.prompt.text, description.text))
            self._change(failures=0, reason="", waits_until=0.0, answered=call.frame.captured, answers=self.health.answers + 1)
        return call

    def refused(self, reason: str, now: float) -> None:
        """A question that could not be put at all; it counts as a failure."""
        self._failed(reason, now)

    def _failed(self, reason: str, now: float) -> None:
        count = self.health.failures + 1
        pause = min(self.settings.first_backoff * 2.0 ** min(count - 1, 30), self.settings.longest_backoff)
        self._change(failures=count, reason=reason, waits_until=now + pause)

    def _change(self, **changes: Any) -> None:
        """One new Health in place of the old: readers on other threads see either, never a mixture."""
        self.health = replace(self.health, **changes)


def degraded(health: Health, now: float, settings: LoopSettings) -> str:
    """Why perception is not well, in words; empty when it is. Where the state asks nothing, nothing is amiss."""
    if health.failures:
        times = f", {health.failures} times in a row" if health.failures > 1 else ""
        return f"the model does not answer ({health.reason}{times})"
    if not health.asking:
        return ""
    if health.answered is None:
        return "no frame has been answered yet"
    age = now - health.answered
    return f"the newest frame answered is {age:.1f} s old" if age > settings.late_after else ""
