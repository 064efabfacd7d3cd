"""What stands in for the vision-language model: facts that a drive's perception reports, labelled by where they come from."""

from __future__ import annotations

import json
import math
from bisect import bisect_right
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from regdb.situation import quiet_facts
from regdb.vocabulary import FactError, Value, Vocabulary
from regdb_runtime.errors import WorldError
from regdb_runtime.observation import EgoState, Provenance
from regdb_runtime.scenes.tellers import eye_facts
from regdb_runtime.worlds.scene_spec import EyeSpec, SightingSpec

Look = tuple[Mapping[str, Value], frozenset[str]]
"""Facts reported now, and the facts that would be reported but are not."""


class Eye(Protocol):
    """Perception's model as the planner sees it: facts in the vocabulary's words and SI, and what stays silent."""

    @property
    def provenance(self) -> Provenance: ...

    def look(self, time: float, ego: EgoState) -> Look:
        """Facts reported at `time` (seconds since the run began), and the names of those that perception would report but does not."""
        ...


@dataclass(frozen=True)
class Sighting:
    """Facts that hold while the ego is within `range` of `position` or inside `area` (everywhere without both), from `start` to `until`."""

    facts: Mapping[str, Value]
    position: tuple[float, float] | None = None
    range: float = 100.0
    area: tuple[tuple[float, float], ...] = ()
    start: float = 0.0
    until: float = 1e9

    def seen(self, time: float, ego: EgoState) -> bool:
        """Whether it is there to be seen now."""
        if not self.start <= time < self.until:
            return False
        near = self.position is not None and math.hypot(self.position[0] - ego.x, self.position[1] - ego.y) <= self.range
        return near or (bool(self.area) and inside(self.area, ego.x, ego.y)) or (self.position is None and not self.area)


class NoEye:
    """Perception that reports nothing: its facts are unknown, and nothing may be assumed of them."""

    provenance: Provenance = "none"

    def __init__(self, vocabulary: Vocabulary) -> None:
        self._silent = eye_facts(vocabulary)

    def look(self, time: float, ego: EgoState) -> Look:  # noqa: ARG002  # what it sees does not depend on anything
        """Nothing; every fact that is perception's to tell is silent."""
        return {}, self._silent


class ScriptedEye:
    """Ground truth, written beforehand: facts of the sightings in view, else the quiet value of every fact it attends to.

    Facts it does not attend to, or always misses, are unknown. Raises WorldError for facts that are not the eye's to tell.
    """

    provenance: Provenance = "scripted"

    def __init__(
        self, vocabulary: Vocabulary, sightings: Sequence[Sighting] = (), attends: Iterable[str] | None = None, misses: Iterable[str] = ()
    ) -> None:
        own = eye_facts(vocabulary)
        missed = frozenset(misses)
        attended = own if attends is None else frozenset(attends)
        for name in sorted({name for item in sightings for name in item.facts} | attended | missed):
            if name not in own:
                raise WorldError(f"{name} is not the eye's to tell{vocabulary.hint(name) if name not in vocabulary else ''}")
        quiet = quiet_facts(vocabulary)
        self._sightings = tuple(sightings)
        self._known = attended - missed
        self._quiet = {name: quiet[name] for name in sorted(self._known) if name in quiet}
        self._silent = own - self._known
        self._last: tuple[tuple[int, ...], Mapping[str, Value]] = ((), self._quiet)

    def look(self, time: float, ego: EgoState) -> Look:
        """What is there to be seen from here now; later sightings win over earlier ones."""
        seen = tuple(index for index, item in enumerate(self._sightings) if item.seen(time, ego))
        if seen != self._last[0]:
            facts = dict(self._quiet)
            for index in seen:
                facts.update({name: value for name, value in self._sightings[index].facts.items() if name in self._known})
            self._last = seen, facts
        return self._last[1], self._silent


class RecordedEye:
    """Replays what a model said: (time, facts) in order of time; a report older than `valid_for` seconds is no longer perception."""

    provenance: Provenance = "recorded"

    def __init__(self, vocabulary: Vocabulary, reports: Iterable[tuple[float, Mapping[str, Value]]], valid_for: float = 2.0) -> None:
        own = eye_facts(vocabulary)
        ordered = sorted(reports, key=lambda report: report[0])
        self._times = [time for time, _ in ordered]
        self._reports = [{name: value for name, value in facts.items() if name in own} for _, facts in ordered]
        self._silent = [own.difference(facts) for facts in self._reports]
        self._nothing = own
        self._valid_for = valid_for

    @classmethod
    def read(cls, vocabulary: Vocabulary, path: Path, valid_for: float = 2.0) -> RecordedEye:
        """From JSONL: `{"time": 1.5, "facts": {"sign.school": true, "posted.advisory_speed": "25 mph"}}` a line. Raises WorldError."""
        reports: list[tuple[float, Mapping[str, Value]]] = []
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
            if line.strip():
                try:
                    raw = json.loads(line)
                    reports.append((float(raw["time"]), read_facts(raw["facts"], vocabulary, f"{path}:{number}")))
                except (ValueError, KeyError, TypeError, AttributeError) as error:
                    raise error if isinstance(error, WorldError) else WorldError(f"{path}:{number}: no report of perception: {error}") from None
        return cls(vocabulary, reports, valid_for)

    def look(self, time: float, ego: EgoState) -> Look:  # noqa: ARG002  # a record does not depend on where the ego is
        """The latest report not later than now and not too old; else nothing."""
        index = bisect_right(self._times, time) - 1
        if index < 0 or time - self._times[index] > self._valid_for:
            return {}, self._nothing
        return self._reports[index], self._silent[index]


def read_facts(raw: Mapping[str, object], vocabulary: Vocabulary, place: str) -> dict[str, Value]:
    """Facts as people write them, in SI; those written `unknown` are left out. Raises WorldError that names the place."""
    found: dict[str, Value] = {}
    for name, text in raw.items():
        try:
            value = vocabulary.fact(name).read(text)
        except FactError as error:
            raise WorldError(f"{place}: {error}") from None
        if value is not None:
            found[name] = value
    return found


def build_eye(spec: EyeSpec, vocabulary: Vocabulary, place: str = "eye", extra: Sequence[Sighting] = ()) -> Eye:
    """The eye a scene asks for; `extra` sightings come before the scene's own. Raises WorldError."""
    if spec.kind == "none":
        return NoEye(vocabulary)
    if spec.kind == "recorded":
        return RecordedEye.read(vocabulary, Path(spec.record))
    own = [_sighting(item, vocabulary, f"{place}.sightings[{index}]") for index, item in enumerate(spec.sightings)]
    return ScriptedEye(vocabulary, [*extra, *own], spec.attends or None, spec.misses)


def _sighting(spec: SightingSpec, vocabulary: Vocabulary, place: str) -> Sighting:
    facts = read_facts(spec.facts, vocabulary, place)
    return Sighting(facts, spec.position, spec.range, spec.area, spec.start, spec.until)


def inside(polygon: Sequence[tuple[float, float]], x: float, y: float) -> bool:
    """Whether a point lies in a polygon (even-odd rule)."""
    found, (ax, ay) = False, polygon[-1]
    for bx, by in polygon:
        if (ay > y) != (by > y) and x < ax + (y - ay) / (by - ay) * (bx - ax):
            found = not found
        ax, ay = bx, by
    return found
