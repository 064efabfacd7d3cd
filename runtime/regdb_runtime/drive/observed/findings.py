"""What the law says of recorded vehicles: intervals in which a verdict held, and for each rule when, where and how far beyond its bound."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Literal

Word = Literal["legal", "illegal", "unknown"]
WORST: dict[str, int] = {"legal": 0, "unknown": 1, "illegal": 2}


@dataclass(frozen=True, slots=True)
class Said:
    """What one rule says at one instant: `illegal` (broken) or `unknown` (may be). `measured` and `bound` in SI with `unit`, where it has a limit.
    `force`: the kind of limit. `at_line`: it speaks of crossing a line."""

    rule: str
    citation: str
    word: Word
    because: str
    measured: float | None = None
    bound: float | None = None
    unit: str = ""
    missing: tuple[str, ...] = ()
    force: str = ""
    at_line: bool = False

    @property
    def beyond(self) -> float:
        """How far the measured value is past the bound, either way; 0 without one."""
        return 0.0 if self.measured is None or self.bound is None else abs(self.measured - self.bound)


@dataclass(frozen=True, slots=True)
class Moment:
    """One instant of one vehicle: seconds of the recording, its place, its state, the verdict, and what rules say."""

    time: float
    x: float
    y: float
    lane: str
    state: str
    speed: float
    word: Word
    said: tuple[Said, ...]


@dataclass(frozen=True, slots=True)
class Interval:
    """A verdict over time, seconds of the recording, with the states gone through."""

    word: Word
    start: float
    end: float
    states: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Finding:
    """One rule over one unbroken time: from where to where, the states, and the worst that was measured."""

    said: Said
    start: float
    end: float
    lanes: tuple[str, ...]
    place: tuple[float, float]
    states: tuple[str, ...]

    @property
    def seconds(self) -> float:
        """How long."""
        return self.end - self.start


@dataclass(frozen=True)
class Observed:
    """One recorded vehicle, judged. `unmatched`: seconds on no lane of the map, of which nothing is said."""

    vehicle: str
    kind: str
    start: float
    end: float
    intervals: tuple[Interval, ...]
    findings: tuple[Finding, ...]
    moments: tuple[Moment, ...]
    unmatched: float = 0.0

    def seconds(self, word: Word) -> float:
        """How long a verdict held."""
        return sum(item.end - item.start for item in self.intervals if item.word == word)

    @property
    def broken(self) -> tuple[Finding, ...]:
        """Findings of rules that were broken."""
        return tuple(item for item in self.findings if item.said.word == "illegal")

    @property
    def open(self) -> tuple[Finding, ...]:
        """Findings of rules of which it is not known."""
        return tuple(item for item in self.findings if item.said.word == "unknown")


def observed(vehicle: str, kind: str, span: tuple[float, float], moments: Sequence[Moment], period: float) -> Observed:
    """Moments in order, `period` seconds apart, as intervals and findings; each moment stands for the time until the next."""
    unmatched = max(span[1] - span[0] - period * len(moments), 0.0)
    return Observed(
        vehicle, kind, *span, tuple(_intervals(moments, period, span[1])), tuple(_findings(moments, period, span[1])), tuple(moments),
        unmatched if unmatched > period / 2 else 0.0,
    )  # fmt: skip


def _intervals(moments: Iterable[Moment], period: float, last: float) -> list[Interval]:
    found: list[Interval] = []
    for item in moments:
        end = min(item.time + period, last)
        if found and found[-1].word == item.word and item.time - found[-1].end < period / 2:
            found[-1] = Interval(item.word, found[-1].start, end, _added(found[-1].states, item.state))
        else:
            found.append(Interval(item.word, item.time, end, (item.state,)))
    return found


def _findings(moments: Iterable[Moment], period: float, last: float) -> list[Finding]:
    done: list[Finding] = []
    running: dict[tuple[str, str], Finding] = {}
    for item in moments:
        end = min(item.time + period, last)
        for said in item.said:
            key = said.rule, said.word
            held = running.get(key)
            if held is not None and item.time - held.end < period / 2:
                worst = said if said.beyond > held.said.beyond else held.said
                place = (item.x, item.y) if worst is said else held.place
                missing = tuple(dict.fromkeys((*held.said.missing, *said.missing)))
                running[key] = Finding(
                    replace(worst, missing=missing), held.start, end, _added(held.lanes, item.lane), place, _added(held.states, item.state)
                )  # fmt: skip
                continue
            if held is not None:
                done.append(held)
            running[key] = Finding(said, item.time, end, (item.lane,), (item.x, item.y), (item.state,))
    return sorted([*done, *running.values()], key=lambda found: (found.said.word != "illegal", found.start, found.said.citation, found.said.rule))


def _added(words: tuple[str, ...], word: str) -> tuple[str, ...]:
    return words if words[-1] == word else (*words, word)
