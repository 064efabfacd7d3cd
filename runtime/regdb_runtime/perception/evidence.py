"""What one source said of one fact, and where exactly it said so: the unit that fusion works on and that a log shows."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from regdb.vocabulary import Value

Source = Literal["model", "map", "gnss", "clock", "detector", "scripted"]
Certainty = Literal["asserted", "hedged"]
"""`hedged`: said with may, might, possibly; such a statement never makes a fact known by itself."""


@dataclass(frozen=True, slots=True)
class Span:
    """A piece of a text: [start, end) in characters of the text as it was received, before any normalisation."""

    start: int
    end: int


@dataclass(frozen=True, slots=True)
class Statement:
    """One source's word on one fact. `value` in the vocabulary's form and SI; of a boolean fact False says that it is absent.

    `spans`: the words it rests on; `rule`: the phrase, pattern or schema key that made it of them. `captured`: seconds since the run
    began at which the frame (or measurement) was taken, not when the answer came. `frame`, `prompt`, `model` identify where it came from.
    """

    fact: str
    value: Value
    certainty: Certainty = "asserted"
    source: Source = "model"
    captured: float = 0.0
    spans: tuple[Span, ...] = ()
    rule: str = ""
    frame: str = ""
    prompt: str = ""
    model: str = ""


@dataclass(frozen=True, slots=True)
class Reading:
    """All that one text (or answer) says: statements in the order of their places, and what was read but set aside, with why
    (`hypothetical`, `other road user`, `ended` …)."""

    text: str
    statements: tuple[Statement, ...] = ()
    set_aside: tuple[tuple[str, Span, str], ...] = ()

    def by_fact(self) -> Mapping[str, tuple[Statement, ...]]:
        """Fact -> its statements."""
        found: dict[str, list[Statement]] = {}
        for item in self.statements:
            found.setdefault(item.fact, []).append(item)
        return {name: tuple(items) for name, items in found.items()}


@dataclass(frozen=True, slots=True)
class Choice:
    """One answer to a closed question: the fact and value it stands for, and the words that name it."""

    fact: str
    value: Value
    label: str


@dataclass(frozen=True, slots=True)
class Question:
    """A closed question about one thing in the picture, put on a crop of it: which of these look-alikes is it, or none of them?"""

    fact: str
    choices: tuple[Choice, ...]
    text: str


@dataclass(frozen=True)
class Snapshot:
    """What perception holds to be so at one instant; immutable, read by the planner without waiting.

    `facts`: known ones; `evidence`: fact -> the statements it rests on; `age`: fact -> seconds since the newest of them was captured;
    `silent`: facts that perception should report and does not now; `degraded`: why, in words, empty when all is well.
    `assumed`: those of `facts` that nobody saw and that do not matter here, at their quiet value; `questions`: what only a closed choice settles.
    """

    time: float
    facts: Mapping[str, Value] = field(default_factory=dict)
    evidence: Mapping[str, tuple[Statement, ...]] = field(default_factory=dict)
    age: Mapping[str, float] = field(default_factory=dict)
    silent: frozenset[str] = frozenset()
    degraded: str = ""
    assumed: frozenset[str] = frozenset()
    questions: tuple[Question, ...] = ()
