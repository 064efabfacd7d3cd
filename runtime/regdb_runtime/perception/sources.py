"""Sources other than the model, in the same words: what map, clock, GNSS position and object detector say, as statements with their evidence."""

from __future__ import annotations

import datetime
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Protocol

from regdb.situation import quiet_facts
from regdb.vocabulary import FactError, Value, Vocabulary
from regdb_runtime.errors import MapError
from regdb_runtime.perception.areas import Area, Point
from regdb_runtime.perception.evidence import Certainty, Reading, Source, Statement
from regdb_runtime.perception.policies import restricts

WEEKDAYS = ("monday", "tuesday", "wednesday", "thursday", "friday", "saturday", "sunday")


def known_facts(facts: Mapping[str, Value], captured: float, source: Source = "map", rule: str = "map") -> Reading:
    """Facts that a map (or another source that knows) tells here and now."""
    return Reading("", tuple(Statement(name, facts[name], source=source, captured=captured, rule=rule) for name in sorted(facts)))


def clock_reading(clock: datetime.datetime, captured: float) -> Reading:
    """Local date, weekday and time of day; darkness, which takes the place too, is the scene builder's to work out."""
    facts: dict[str, Value] = {
        "clock.time": clock.hour * 3600 + clock.minute * 60 + clock.second,
        "clock.date": clock.toordinal(),
        "clock.weekday": WEEKDAYS[clock.weekday()],
    }
    return known_facts(facts, captured, "clock", "clock")


@dataclass(frozen=True, slots=True)
class Fix:
    """A GNSS position: longitude and latitude in degrees, `accuracy` in metres (the receiver's own 95 % bound), seconds since the run began."""

    point: Point
    accuracy: float
    captured: float


class ZoneMap:
    """Areas in which facts hold, from GeoJSON: a feature's property `facts` maps facts to values as people write them.

    Raises MapError for facts or values that are not in the vocabulary.
    """

    def __init__(self, vocabulary: Vocabulary, areas: Iterable[Area]) -> None:
        self._vocabulary, self._quiet = vocabulary, quiet_facts(vocabulary)
        self._areas = tuple((area, self._facts(area, number)) for number, area in enumerate(areas))

    def _facts(self, area: Area, number: int) -> Mapping[str, Value]:
        raw = area.properties.get("facts")
        if not isinstance(raw, dict) or not raw:
            raise MapError(f"area {number} says no facts")
        found: dict[str, Value] = {}
        for name, text in raw.items():
            try:
                value = self._vocabulary.fact(name).read(text)
            except FactError as error:
                raise MapError(f"area {number}: {error}") from None
            if value is not None:
                found[name] = value
        return found

    def reading(self, fix: Fix) -> Reading:
        """What the zones say of a position. A value that restricts holds wherever the vehicle may be inside; one that permits, and that a zone
        is over, only where it surely is inside or outside."""
        said: dict[tuple[str, Value], Statement] = {}
        for number, (area, facts) in enumerate(self._areas):
            may = area.may_contain(fix.point, fix.accuracy)
            sure = area.surely_contains(fix.point, fix.accuracy)
            for name, value in facts.items():
                if may and (sure or self._restricts(name, value)):
                    said[name, value] = self._statement(name, value, fix, f"area {number}")
        outside = {name for area, facts in self._areas if not area.may_contain(fix.point, fix.accuracy) for name in facts}
        open_ = {name for area, facts in self._areas if area.may_contain(fix.point, fix.accuracy) for name in facts}
        for name in sorted(outside - open_):
            if name in self._quiet:
                said[name, self._quiet[name]] = self._statement(name, self._quiet[name], fix, "outside every area")
        return Reading("", tuple(said[key] for key in sorted(said, key=str)))

    def _restricts(self, name: str, value: Value) -> bool:
        policy = self._vocabulary.fact(name).fusion
        return policy is None or restricts(policy, value)

    def _statement(self, name: str, value: Value, fix: Fix, rule: str) -> Statement:
        return Statement(name, value, source="map", captured=fix.captured, rule=f"gnss in {rule}")


class Detection(Protocol):
    """One object that a detector found in a frame. `kind`: its class's name, or a sign's MUTCD code; `box`: left, top, right, bottom in pixels;
    `confidence` from 0 to 1; `track`: the same for one object over frames, empty without tracking."""

    @property
    def kind(self) -> str: ...
    @property
    def box(self) -> tuple[float, float, float, float]: ...
    @property
    def confidence(self) -> float: ...
    @property
    def track(self) -> str: ...


@dataclass(frozen=True, slots=True)
class Box:
    """A detection as plain data."""

    kind: str
    box: tuple[float, float, float, float]
    confidence: float
    track: str = ""


COCO: Mapping[str, tuple[str, Value]] = MappingProxyType({
    "person": ("pedestrian.present", True), "bicycle": ("bicycle.present", True), "motorcycle": ("motorcycle.present", True),
    "stop sign": ("sign.stop", True), "train": ("rail.train_near", True), "horse": ("animal.ahead", True), "cow": ("animal.ahead", True),
})  # fmt: skip
"""Classes of the COCO data set (Lin et al., 2014) that are facts by themselves. A car in view is no fact: roles take places and speeds."""
LIGHTS: Mapping[str, tuple[str, Value]] = MappingProxyType({
    f"traffic light: {color}": ("signal.color", color) for color in ("red", "yellow", "green")
})  # fmt: skip
"""Classes of detectors that read the lens at the place where the map has the light that governs."""


@dataclass(frozen=True)
class DetectorSettings:
    """What a detector's classes mean. `asserted`: confidence from which a detection is a statement, `hedged`: from which it is a hedged one
    (the usual operating points of detectors scored by mAP); `covers`: kinds of which it finds every one in range, so that none is a statement too."""

    kinds: Mapping[str, tuple[str, Value]] = field(default_factory=lambda: {**COCO, **LIGHTS})
    asserted: float = 0.6
    hedged: float = 0.3
    covers: frozenset[str] = frozenset()


class DetectionReader:
    """Detections -> statements. Signs are known by their MUTCD codes, which the vocabulary has; other kinds by the settings."""

    def __init__(self, vocabulary: Vocabulary, settings: DetectorSettings | None = None) -> None:
        self.settings = settings or DetectorSettings()
        self._kinds: Mapping[str, tuple[str, Value]] = {**_signs(vocabulary), **self.settings.kinds}
        self._quiet = quiet_facts(vocabulary)

    def read(self, detections: Sequence[Detection], captured: float, frame: str = "", model: str = "") -> Reading:
        """Statements by fact; the box, and the track where there is one, stand in the rule. Kinds that mean no fact say nothing."""
        said: dict[tuple[str, Value, Certainty], Statement] = {}
        for item in sorted(detections, key=lambda found: (-found.confidence, found.kind, found.box)):
            if item.kind not in self._kinds or item.confidence < self.settings.hedged:
                continue
            fact, value = self._kinds[item.kind]
            certainty: Certainty = "asserted" if item.confidence >= self.settings.asserted else "hedged"
            box = ",".join(f"{edge:g}" for edge in item.box)
            rule = f"{item.kind} {item.confidence:.2f} at {box}" + (f" track {item.track}" if item.track else "")
            said.setdefault((fact, value, certainty), Statement(fact, value, certainty, "detector", captured, rule=rule, frame=frame, model=model))
        named = {fact for fact, _, _ in said}
        for fact in sorted({self._kinds[kind][0] for kind in self.settings.covers if kind in self._kinds} - named):
            if fact in self._quiet:
                said[fact, self._quiet[fact], "asserted"] = Statement(
                    fact, self._quiet[fact], "asserted", "detector", captured, rule="nothing of its kinds", frame=frame, model=model
                )
        return Reading("", tuple(said.values()))


def _signs(vocabulary: Vocabulary) -> dict[str, tuple[str, Value]]:
    """MUTCD code -> the sign it is the code of; of signs that share one, none: the code does not tell them apart."""
    coded = [(fact.codes["mutcd"], fact.name) for fact in vocabulary if fact.name.startswith("sign.") and "mutcd" in fact.codes]
    codes = [code for code, _ in coded]
    return {code: (name, True) for code, name in coded if codes.count(code) == 1}
