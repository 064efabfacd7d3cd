"""One tick as a record of the log: what was seen, what was decided, and by which law."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import lru_cache
from typing import Any

import numpy as np

from regdb.meaning import LimitInForce, combine
from regdb.regulation import Regulation
from regdb.situation import Situation
from regdb.units import show_si, unit_named
from regdb.vocabulary import Value, Vocabulary
from regdb_runtime.decision import CandidateReport, CostTerms, Decision, Rejection
from regdb_runtime.drive.downtrack import Downtrack
from regdb_runtime.emergency import EmergencyReport
from regdb_runtime.geometry import boxes, distance
from regdb_runtime.observation import Footprint, Observation, Track
from regdb_runtime.trajectory import Trajectory
from regdb_runtime.verdict import Verdict

RANKS = ("lawful", "unknown", "unlawful", "none")
"""Words of the log for `CandidateReport.rank`."""
PLAN_STEP = 0.5
"""Seconds between the points kept of a chosen plan."""
Record = dict[str, Any]


class Recorder:
    """Makes the record of a tick; keeps the last station, so that the next is looked for nearby, and what the eye said last."""

    def __init__(self, downtrack: Downtrack, footprint: Footprint) -> None:
        self._downtrack, self._footprint = downtrack, footprint
        self._near: float | None = None
        self._facts: Mapping[str, Value] | None = None
        self._silent: frozenset[str] | None = None

    def tick(self, observation: Observation, decision: Decision) -> Record:
        """The record of one tick, keys in their order."""
        candidates = [candidate_record(item) for item in decision.candidates]
        return {
            "kind": "tick",
            "time": observation.time,
            "clock": observation.clock.isoformat(timespec="milliseconds"),
            "state": decision.state,
            "steps": decision.steps,
            "phase": decision.stop_phase,
            "strategic": decision.strategic,
            "flag": decision.flag,
            "reason": decision.reason,
            "ego": self._ego(observation),
            "law": None if decision.chosen is None else candidates[decision.chosen]["law"],
            "chosen": decision.chosen,
            "margin": decision.margin,
            "candidates": candidates,
            "plan": plan_record(decision.trajectory) if decision.strategic else None,
            "emergency": emergency_record(decision.emergency),
            "tracks": self._tracks(observation),
            "signals": {name: [[i.color, i.shape, i.flashing] for i in shown] for name, shown in sorted(observation.signals.items())},
            **self._seen(observation),
            "events": decision.events,
        }

    def _ego(self, observation: Observation) -> Record:
        ego = observation.ego
        front, _ = self._downtrack.locate(*ego.front_bumper(self._footprint), self._near)
        station, offset = self._downtrack.locate(ego.x, ego.y, self._near)
        self._near = station
        return {
            "x": ego.x, "y": ego.y, "heading": ego.heading, "speed": ego.speed, "acceleration": ego.acceleration, "curvature": ego.curvature,
            "turn_signal": ego.turn_signal, "station": station, "front": front, "offset": offset,
        }  # fmt: skip


    def _seen(self, observation: Observation) -> Record:
        """What the eye reports and does not; None where it is as in the tick before."""
        facts = None if observation.facts == self._facts else dict(sorted(observation.facts.items()))
        silent = None if observation.silent == self._silent else sorted(observation.silent)
        self._facts, self._silent = observation.facts, observation.silent
        return {"facts": facts, "silent": silent}

    def _tracks(self, observation: Observation) -> list[Record]:
        """Every road user with its clearance: the distance, edge to edge, between its box and the vehicle's."""
        tracks, ego = observation.tracks, observation.ego
        if not tracks:
            return []
        own = boxes(*ego.box_center(self._footprint), ego.heading, self._footprint.length, self._footprint.width)
        columns = zip(*((track.x, track.y, track.heading, track.length, track.width) for track in tracks), strict=True)
        gaps = distance(own, boxes(*columns))
        return [track_record(track, float(gap)) for track, gap in zip(tracks, gaps, strict=True)]


def candidate_record(report: CandidateReport) -> Record:
    """A candidate state with its verdict, its cost, and why its other plans fell out."""
    return {
        "next": report.next,
        "rank": RANKS[report.rank],
        "law": None if report.verdict is None else law_record(report.verdict),
        "cost": None if report.cost is None else cost_record(report.cost),
        "turn_signal": report.turn_signal,
        "sampled": report.sampled,
        "rejections": [rejection_record(item) for item in report.rejections],
    }


def cost_record(cost: CostTerms) -> Record:
    """The four terms of the paper's equation, their weighted total, and what they consist of."""
    return {
        "legal": cost.legal, "safety": cost.safety, "comfort": cost.comfort, "distance": cost.distance, "total": cost.total,
        "parts": dict(sorted(cost.parts.items())),
    }  # fmt: skip


def rejection_record(item: Rejection) -> Record:
    """Why plans fell out: rule, measured, bound, and how many."""
    return {"rule": item.rule, "measured": item.measured, "bound": item.bound, "unit": item.unit, "count": item.count, "because": item.because}


def emergency_record(report: EmergencyReport) -> Record:
    """What the emergency check measured."""
    return {"active": report.active, "gap": report.gap, "required": report.required, "track": report.track}


def track_record(track: Track, clearance: float) -> Record:
    """One road user, as a box, with its clearance to the vehicle."""
    return {
        "id": track.id, "kind": track.kind, "x": track.x, "y": track.y, "heading": track.heading, "speed": track.speed,
        "length": track.length, "width": track.width, "clearance": clearance,
    }  # fmt: skip


def plan_record(plan: Trajectory) -> Record:
    """The plan decided on, a point every PLAN_STEP seconds."""
    kept = np.unique(np.searchsorted(plan.time, np.arange(0.0, float(plan.time[-1]) + 1e-9, PLAN_STEP)).clip(max=len(plan.time) - 1))
    return {name: getattr(plan, name)[kept].tolist() for name in ("time", "x", "y", "speed", "station", "offset")}


def law_record(verdict: Verdict) -> Record:
    """The verdict, the rules that decided it, the strictest limits in force, the facts both rest on, and what is missing."""
    binding = _strictest(verdict.limits)
    return {
        "verdict": verdict.verdict,
        "place": verdict.place,
        "date": verdict.date,
        "deciding": [[rule.id, rule.citation] for rule in verdict.deciding],
        "limits": {name: [item.bound, _shown(item), item.regulation.citation] for name, item in binding.items()},
        "facts": _facts(verdict, [*verdict.deciding, *(item.regulation for item in binding.values())]),
        "missing": verdict.missing if verdict.verdict == "unknown" else (),
    }


def _strictest(limits: Iterable[LimitInForce]) -> dict[str, LimitInForce]:
    """Attribute -> the strictest limit in force, by name of the attribute."""
    return dict(sorted(combine(limits).items()))


def _shown(item: LimitInForce) -> str:
    return _show(item.bound, item.limit.unit)


@lru_cache(maxsize=1024)
def _show(bound: float, unit: str) -> str:
    """A bound as people write it; the few there are come again every tick."""
    return show_si(bound, unit)


def _facts(verdict: Verdict, rules: Iterable[Regulation]) -> Mapping[str, str]:
    """The facts on which rules rest, as people write them; those assumed or unknown say so."""
    vocabulary = verdict.circumstances.vocabulary
    situation = Situation(vocabulary, verdict.scene, verdict.plan)
    found = {}
    for name in dict.fromkeys(fact for rule in rules for fact in rule.facts):
        told, assumed = situation.observed(name), situation.assumed(name)
        shown = show_fact(vocabulary, name, assumed if told is None else told)
        found[name] = f"{shown} (assumed)" if told is None and assumed is not None else shown
    return found


def show_fact(vocabulary: Vocabulary, name: str, value: Value | None) -> str:
    """A fact's value as people write it; what was measured with at most three decimals."""
    fact = vocabulary.facts.get(name)
    if fact is None or value is None:
        return "unknown" if value is None else str(value)
    if fact.kind == "quantity" and isinstance(value, float):
        return f"{value / _factor(fact.unit):.3f}".rstrip("0").rstrip(".") + f" {fact.unit}"
    return fact.show(value)


@lru_cache(maxsize=64)
def _factor(unit: str) -> float:
    return float(unit_named(unit).factor)
