"""Judges recorded vehicles by the law of a place: perception and strategy as when driving, the motion taken from the recording.

 recorded places -> lanes driven in -> manoeuvre of each instant -> stretches (facts of the law, roles, history)
 recorded places -> facts of the plan, measured as those of plans are -> verdict of each stretch

Each instant is judged on the motion up to the next, so a rule counts as broken while it is, not before. What the recording does not tell (light
phases, signals, people on foot) is unknown, and the verdict says so.
"""

from __future__ import annotations

import datetime
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np

from regdb.interpretation import Interpretation
from regdb.regulation import Regulation
from regdb.units import SI_SYMBOL, from_si, unit_named
from regdb_runtime.assessment.assessed import RANKS
from regdb_runtime.assessment.assessor import Assessor
from regdb_runtime.assessment.rejections import rejection
from regdb_runtime.assessment.settings import AssessmentSettings
from regdb_runtime.database import RegulationDatabase
from regdb_runtime.decision import Rejection
from regdb_runtime.drive.observed.course import Course
from regdb_runtime.drive.observed.findings import Moment, Observed, Said, Word, observed
from regdb_runtime.drive.observed.matching import match
from regdb_runtime.drive.observed.reading import Reader
from regdb_runtime.drive.observed.unseen import BEYOND_LANES, SHAPE, STRADDLES, YIELDED, recorded_vehicle, unseen_facts, without
from regdb_runtime.errors import RequestError
from regdb_runtime.maneuver import Junction, Maneuver
from regdb_runtime.maps.lane_graph import LaneGraph
from regdb_runtime.maps.lane_path import LanePath, LanePaths
from regdb_runtime.maps.road_map import RoadMap
from regdb_runtime.observation import Footprint, Observation
from regdb_runtime.planning.prediction import Predictions
from regdb_runtime.scenes.settings import SceneSettings
from regdb_runtime.scenes.stretch import Stretch
from regdb_runtime.scenes.stretches import Scenes
from regdb_runtime.strategy.machine import Machine
from regdb_runtime.trajectory import Candidates, Floats
from regdb_runtime.verdict import Verdict
from regdb_runtime.worlds.eye import build_eye
from regdb_runtime.worlds.recorded import completed, ego_of, footprint_of
from regdb_runtime.worlds.replay import Motion, Replay
from regdb_runtime.worlds.scene_spec import EyeSpec

DRIVERS = frozenset(("car", "truck", "bus", "motorcycle"))
"""Whom the rules for drivers of motor vehicles are asked about; riders and walkers are seen, not judged."""
WAY_ON = "the way it took at the junction"
"""What is missing where the recording ends before the junction and the verdict depends on it."""
WORDS: tuple[Word, Word, Word] = ("legal", "unknown", "illegal")
"""By rank."""
ENTERS = frozenset(("plan.enters_intersection", "plan.enters_crosswalk", "plan.enters_rail_crossing"))
"""Facts of one moment: that a line is crossed."""
PLACE, SPEED = "its place, more exactly", "its speed, more exactly"
"""What is missing where the verdict turns within the error of the recording and its map."""


@dataclass(frozen=True)
class ObserverSettings:
    """Where and when the law is asked, and what is taken for known.

    `eye`: `none`: what the recording and its map do not tell is unknown; `scripted`: there was nothing unusual. Light phases and turn signals stay
    unknown in both. `interpretation`: `statute_only` decides nothing that the law leaves to judgement. `period`: seconds from one instant judged to
    the next, taken to whole steps of the recording.

    `place_error` (metres) and `speed_error` (m/s): a rule counts as broken only if it is for every place and speed within them. A metre is what the
    recordings at hand and their maps are good for together: five vehicles in one lane of Lankershim all drive 0.4 to 1.3 m left of its middle, and
    those of Peachtree 0.5 m on average. Half a metre a second is what is left of the places' jitter once speeds are measured over a second.
    """

    place: str = "model"
    start: datetime.datetime = datetime.datetime(2026, 3, 4, 12)  # local time, as Observation.clock
    eye: Literal["none", "scripted"] = "none"
    interpretation: str = "statute_only"
    period: float = 0.2
    place_error: float = 1.0
    speed_error: float = 0.5
    scenes: SceneSettings = field(default_factory=lambda: SceneSettings(standstill=0.3))


class Observer:
    """Judges the vehicles of one recording, each by itself. Raises RequestError for a place or interpretation that is not there."""

    def __init__(self, database: RegulationDatabase, road_map: RoadMap, replay: Replay, settings: ObserverSettings | None = None) -> None:
        self.settings = settings or ObserverSettings()
        self.database, self.replay = database, replay
        database.at(self.settings.place, self.settings.start.date())
        self._scripted = self.settings.eye == "scripted"
        told = completed(road_map, self.settings.place, database.vocabulary, scripted=self._scripted)
        self.road_map = replace(told, facts={name: value for name, value in told.facts.items() if name not in SHAPE or name in road_map.facts})
        self.unseen = unseen_facts(database.vocabulary, replay.traffic, scripted=self._scripted)
        self._profile = without(profile_of(database, self.settings.interpretation), self.unseen)
        self._eye = build_eye(EyeSpec(self.settings.eye), database.vocabulary)
        self._graph, self._paths = LaneGraph(self.road_map), LanePaths(self.road_map, 1024)
        self._reader = Reader(self.road_map, Machine(database.machine))
        self._steps = max(1, round(self.settings.period / replay.traffic.time_step))

    @property
    def vehicles(self) -> tuple[str, ...]:
        """Ids of all that are judged: motor vehicles that are there for at least two states, standing obstacles left out."""
        return tuple(
            name for name, item in self.replay.motions.items()
            if item.obstacle.kind in DRIVERS and not item.obstacle.static and len(item.time) > 1 and item.obstacle.source_kind != "parkedVehicle"
        )  # fmt: skip

    def vehicle(self, name: str) -> Observed:
        """One vehicle over its whole recording. Raises KeyError for one that is not recorded."""
        motion = self.replay.motions[name]
        course = Course(self._graph, self._paths, motion, match(self._graph, motion))
        watcher = _Watcher(self, motion, course)
        rows = range(0, len(motion.time) - 1, self._steps)
        moments = [moment for row in rows if (moment := watcher.moment(row, min(row + self._steps, len(motion.time) - 1))) is not None]
        period = self._steps * self.replay.traffic.time_step
        return observed(name, motion.obstacle.kind, (motion.begins, motion.ends), moments, period)

    def observation(self, motion: Motion, row: int, footprint: Footprint) -> Observation:
        """What is seen from a vehicle at a row: everybody recorded, no lights."""
        time = float(motion.time[row])
        ego = ego_of(motion.at(time), footprint)
        facts, silent = self._eye.look(time, ego)
        clock = self.settings.start + datetime.timedelta(microseconds=round(time * 1e6))
        tracks = self.replay.tracks(time, motion.obstacle.id)
        return Observation(time, clock, ego, tracks, {}, facts, silent | self.unseen, self._eye.provenance)

    def others(self, motion: Motion, first: int, last: int) -> Predictions:
        """Everybody else as recorded from one row to another."""
        times = motion.time[first : last + 1]
        there = [item for name, item in self.replay.motions.items() if name != motion.obstacle.id and item.is_there(float(times[0]))]
        rows = [[np.interp(times, item.time, getattr(item, part)) for item in there] for part in ("x", "y", "heading", "speed")]
        x, y, heading, speed = (np.array(part, dtype=np.float64).reshape(len(there), len(times)) for part in rows)
        lengths, widths = (np.array([getattr(item.obstacle, part) for item in there], dtype=np.float64) for part in ("length", "width"))
        names, kinds = tuple(item.obstacle.id for item in there), tuple(item.obstacle.kind for item in there)
        return Predictions(names, kinds, times - times[0], x, y, heading, speed, lengths, widths, np.zeros_like(x))


class _Watcher:
    """One vehicle, row after row: its history, its state, what was not seen of its past."""

    def __init__(self, observer: Observer, motion: Motion, course: Course) -> None:
        self.observer, self.motion, self.course = observer, motion, course
        self.footprint = footprint_of(motion)
        facts = recorded_vehicle(observer.database.vocabulary, self.footprint, motion.obstacle.kind, scripted=observer._scripted)
        self.scenes = Scenes(observer.road_map, observer.database, self.footprint, observer.settings.scenes, observer._profile, facts)
        self.assessors = tuple(
            Assessor(observer.database, self.footprint, AssessmentSettings(line_tolerance=error), observer._profile, observer.road_map)
            for error in (observer.settings.place_error, -observer.settings.place_error)
        )
        self.history = self.scenes.history()
        self.state = ""
        self.first_seen: dict[str, float] = {}
        self.pending: dict[str, Said] = {}

    def moment(self, row: int, until: int) -> Moment | None:
        """The verdict on the motion from a row to another; None where the vehicle is on no lane."""
        there = self.course.at(row)
        if there is None:
            return None
        observation = self.observer.observation(self.motion, row, self.footprint)
        readings = [self.observer._reader.read(self.motion, there, path, observation.tracks, self.footprint, self.state) for path in there.ways]
        self.history.update(observation, readings[0].lane_path, readings[0].junction)
        predictions = self.observer.others(self.motion, row, until)
        doubted = BEYOND_LANES | STRADDLES if self.course.may_be_in_lane(row) else BEYOND_LANES
        answer = _agreed([self._judge(observation, maneuver, predictions, row, until, doubted) for maneuver in readings], WAY_ON)
        if there.change is not None and not there.change.certain(self.observer.settings.place_error):
            answer = _doubtful(answer)
        word, said = answer
        self.state = readings[0].next
        track = self.motion.at(observation.time)
        return Moment(observation.time, track.x, track.y, there.lane, self.state, track.speed, word, said)

    def _judge(self, observation: Observation, maneuver: Maneuver, predictions: Predictions, row: int, until: int, doubted: frozenset[str]) -> Answer:
        """What holds for every place and speed within the errors."""
        unseen = self.observer.unseen | self._past_unseen(maneuver)
        stretches = [
            replace(item, roles={name: value for name, value in item.roles.items() if name not in unseen and not (name in YIELDED and value is True)})
            for item in self.scenes.stretches(observation, maneuver, self.history)
        ]
        driven = self._driven(maneuver.lane_path, row, until)
        lenient, strict = (_worst(assessor.verdicts(maneuver, stretches, driven, predictions, doubted)) for assessor in self.assessors)
        front = float(driven.station[0, 0]) + self.footprint.front, float(driven.station[0, -1]) + self.footprint.front
        answer = self._crossed(strict, maneuver.junction, front) or _agreed((lenient, strict), PLACE)
        return _beyond_doubt(answer, self.observer.settings)

    def _crossed(self, strict: Answer, junction: Junction | None, front: tuple[float, float]) -> Answer | None:
        """A line is entered in one moment by the strict reading of the place and in a later one by the lenient; by then it is certain.

        Refuted, while still before the line, by a moment in which even the strict reading finds nothing: it stopped after all.
        """
        now = {item.rule: item for item in strict[1] if item.at_line} if strict[0] == "illegal" else {}
        pending, self.pending = self.pending, {**self.pending, **now}
        if junction is None or not pending:
            return None
        if front[0] <= junction.stop_station:
            self.pending = now
            return None
        if front[1] <= junction.stop_station + self.observer.settings.place_error:
            return None
        self.pending = {}
        return "illegal", tuple(pending.values())

    def _past_unseen(self, maneuver: Maneuver) -> frozenset[str]:
        """Facts of history about the time before the recording: whoever is first seen at the line may have stopped there, or come first."""
        junction = maneuver.junction
        if junction is None:
            return frozenset()
        settings = self.observer.settings.scenes
        first = self.first_seen.get(junction.id)
        if first is None:
            front = float(self.observer._reader.fronts(self.motion, maneuver.lane_path, self.footprint, 0)[0])
            first = self.first_seen[junction.id] = junction.stop_station - front
        found = {"ego.arrived_first"} if first < settings.watched else set()
        if first < settings.at_line and not self.history.past.stopped:
            found.add("ego.stopped_at_line")
        return frozenset(found)

    def _driven(self, path: LanePath, row: int, until: int) -> Candidates:
        """The recorded motion as the one candidate there is."""
        rows, motion, print_ = slice(row, until + 1), self.motion, self.footprint
        heading, speed = motion.heading[rows], motion.speed[rows]
        x, y = motion.x[rows] - print_.center * np.cos(heading), motion.y[rows] - print_.center * np.sin(heading)
        station, offset = path.path.project(np.column_stack([x, y]), extend=True)
        bend = np.divide(motion.yaw_rate[rows], speed, out=np.zeros_like(speed), where=speed > 0.5)  # as ego_of
        columns: list[Floats] = [x, y, heading, speed, motion.acceleration[rows], np.zeros_like(x), bend, np.maximum.accumulate(station), offset]
        return Candidates(motion.time[rows] - motion.time[row], *(column[None, :] for column in columns))


Answer = tuple[Word, tuple[Said, ...]]
"""A verdict, and what the rules behind it say."""


def _agreed(answers: Sequence[Answer], doubt: str) -> Answer:
    """The verdict on which all answers agree; where they do not it is unknown, for want of what they differ in."""
    if len(answers) == 1 or all(answer == answers[0] for answer in answers):
        return answers[0]
    word = answers[0][0]
    if all(other == word for other, _ in answers):
        shared = set.intersection(*({item.rule for item in said} for _, said in answers))
        if word == "legal" or (word == "illegal" and shared):
            return word, tuple(item for item in answers[0][1] if item.rule in shared)
    found: dict[str, Said] = {}
    for _, said in answers:
        for item in said:
            certain = item.word == "unknown"
            open_ = item if certain else replace(item, word="unknown", missing=(doubt,))
            held = found.get(item.rule)
            found[item.rule] = open_ if held is None else replace(held, missing=tuple(dict.fromkeys((*held.missing, *open_.missing))))
    return "unknown", tuple(found.values())


def _doubtful(answer: Answer) -> Answer:
    """A breach found in a manoeuvre that may have been none."""
    word, said = answer
    return ("unknown", tuple(replace(item, word="unknown", missing=(PLACE,)) for item in said)) if word == "illegal" else answer


def _beyond_doubt(answer: Answer, settings: ObserverSettings) -> Answer:
    """Broken only are limits that are exceeded by more than the error of what was measured."""
    word, said = answer
    if word != "illegal":
        return answer
    errors = {"m/s": (settings.speed_error, SPEED), "m": (settings.place_error, PLACE)}
    doubtful = {item.rule: errors[item.unit][1] for item in said if item.unit in errors and item.measured is not None and item.bound is not None
                and item.beyond <= errors[item.unit][0]}
    certain = tuple(item for item in said if item.rule not in doubtful)
    if certain:
        return "illegal", certain
    return "unknown", tuple(replace(item, word="unknown", missing=(doubtful[item.rule],)) for item in said)


def _worst(answer: Sequence[tuple[Stretch, Verdict]]) -> Answer:
    """The worst verdict among stretches, with what the rules behind verdicts of that kind say."""
    word = WORDS[max((RANKS[verdict.verdict] for _, verdict in answer), default=0)]
    said: dict[str, Said] = {}
    for _, verdict in answer:
        if verdict.verdict == word and word != "legal":
            for rule in verdict.deciding:
                found = rejection(verdict, rule)
                missing = verdict.judgement.missing((rule,)) if word == "unknown" else ()
                because = in_words(rule, found)
                at_line = not ENTERS.isdisjoint(rule.facts)
                now = Said(rule.id, rule.citation, word, because, found.measured, found.bound, found.unit, tuple(missing), rule.force, at_line)
                if rule.id not in said or now.beyond > said[rule.id].beyond:
                    said[rule.id] = now
    return word, tuple(said.values())


def in_words(rule: Regulation, found: Rejection) -> str:
    """What a rule asks; of a limit that was measured how far it is passed, in the law's unit."""
    limit = next((item for item in rule.limits if SI_SYMBOL.get(unit_named(item.unit).dimension) == found.unit), None)
    if limit is None or found.measured is None or found.bound is None:
        return rule.result
    measured, bound = float(from_si(found.measured, limit.unit)), from_si(found.bound, limit.unit)
    what, word = limit.fact.removeprefix("plan.").replace("_", " "), "at most" if limit.direction == "max" else "at least"
    asked, unit = float(bound), limit.unit
    return f"{what} {measured:.1f} {unit}, {word} {round(asked, 1):g} {unit} is lawful ({measured - asked:+.1f} {unit})"


def profile_of(database: RegulationDatabase, name: str) -> Interpretation:
    """An interpretation by its name. Raises RequestError."""
    found = database.interpretations.get(name)
    if found is None:
        raise RequestError(f"the database has no interpretation {name!r}; it has: {', '.join(sorted(database.interpretations))}")
    return found
