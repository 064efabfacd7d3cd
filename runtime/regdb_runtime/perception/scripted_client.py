"""A describer that answers from a script; whatever it says is labelled `scripted` and never passes for a model."""

from __future__ import annotations

import time
from bisect import bisect_right
from collections.abc import Callable, Iterable

from regdb_runtime.observation import Provenance
from regdb_runtime.perception.describer import Description, Frame, Prompt

Answer = Callable[[Frame, Prompt], str]
"""What is said of a frame and a prompt."""


class ScriptedDescriber:
    """Answers by a function of frame and prompt, after `takes` seconds; an answer that would take longer than the deadline is a failure."""

    provenance: Provenance = "scripted"

    def __init__(self, answer: Answer, takes: float = 0.0, sleep: Callable[[float], None] = time.sleep, model: str = "script") -> None:
        self._answer, self._takes, self._sleep, self._model = answer, takes, sleep, model

    @classmethod
    def by_time(cls, lines: Iterable[tuple[float, str]], takes: float = 0.0, sleep: Callable[[float], None] = time.sleep) -> ScriptedDescriber:
        """(seconds since the run began, text): of a frame is said the last line that begins not later than its capture; before the first
        nothing is known, in a sentence that says no fact."""
        ordered = sorted(lines)
        times = [when for when, _ in ordered]

        def answer(frame: Frame, prompt: Prompt) -> str:  # noqa: ARG001  # a script by time does not care what is asked
            place = bisect_right(times, frame.captured) - 1
            return ordered[place][1] if place >= 0 else "Nothing is known yet."

        return cls(answer, takes, sleep)

    def describe(self, frame: Frame, prompt: Prompt, deadline: float) -> Description:
        """The script's answer; it never raises."""
        self._sleep(min(self._takes, deadline))
        if self._takes > deadline:
            return Description("", "deadline", f"the script takes {self._takes:g} s", deadline, self._model)
        try:
            text = self._answer(frame, prompt)
        except Exception as error:  # noqa: BLE001  # a client never raises
            return Description("", "malformed", f"the script failed: {error}", self._takes, self._model)
        if not text:
            return Description("", "malformed", "the script says nothing of this frame", self._takes, self._model)
        return Description(text, took=self._takes, model=self._model)
