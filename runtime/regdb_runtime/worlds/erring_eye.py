"""An eye that errs at a stated rate and is fused over time: what a drive sees through a model that is wrong, late and slow, by its facts."""

from __future__ import annotations

import math
import random
from collections import deque
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from regdb.vocabulary import Fact, Value, Vocabulary
from regdb_runtime.observation import EgoState, Provenance
from regdb_runtime.perception.evidence import Reading, Snapshot, Statement
from regdb_runtime.perception.fusion import Fusion
from regdb_runtime.perception.relevance import relevant_facts
from regdb_runtime.scenes.tellers import eye_facts
from regdb_runtime.worlds.eye import Eye, Look


@dataclass(frozen=True, slots=True)
class Errors:
    """How the model errs. `rate`: share of statements that are wrong; `run`: answers that one mistake lasts on average (1: independent);
    `missed`: share of statements left out; `period`, `latency`: seconds between looks, and from a frame to its answer (LLaVA-1.5 7B in
    4 bits: 2 Hz, the paper's Table IV)."""

    rate: float = 0.02
    run: float = 1.0
    missed: float = 0.0
    period: float = 0.5
    latency: float = 0.5
    seed: int = 0


class ErringEye:
    """Looks at the truth of another eye, errs, answers late, and reports what the fusion makes of it. Deterministic by its seed.

    `places`: ego -> what the map knows of the place (`relevance`); without it every fact matters everywhere.
    """

    def __init__(
        self, vocabulary: Vocabulary, truth: Eye, errors: Errors, places: Callable[[EgoState], Mapping[str, Value]] | None = None,
        beside: Callable[[float, EgoState], Reading] | None = None,
    ) -> None:  # fmt: skip
        self._vocabulary, self._truth, self._errors, self._places = vocabulary, truth, errors, places
        self._beside = beside
        self._fusion = Fusion(vocabulary, tells=eye_facts(vocabulary))
        self._random = random.Random(errors.seed)  # errors of a simulation, not a secret
        self._mistakes: dict[str, Value] = {}
        self._pending: deque[tuple[float, Reading, float]] = deque()
        self._next = -math.inf
        self._odometer: tuple[float, EgoState] | None = None
        self.latest = Snapshot(0.0)

    @property
    def provenance(self) -> Provenance:
        """The truth's: errors made up do not make it live."""
        return self._truth.provenance

    def look(self, time: float, ego: EgoState) -> Look:
        """What the fusion holds now; looks again when the period has passed. `latest` keeps the snapshot with its evidence."""
        travelled = self._drive(ego)
        if time >= self._next:
            self._next = (time if math.isinf(self._next) else max(self._next, time - self._errors.period)) + self._errors.period
            self._pending.append((time + self._errors.latency, self._reading(time, ego), travelled))
        while self._pending and self._pending[0][0] <= time:
            _, reading, where = self._pending.popleft()
            self._fusion.update(reading, where, time)
        if self._beside is not None:
            self._fusion.update(self._beside(time, ego), travelled, time)
        relevant = None if self._places is None else relevant_facts(self._vocabulary, self._places(ego))
        self.latest = self._fusion.snapshot(time, travelled, relevant)
        return self.latest.facts, self.latest.silent

    def _drive(self, ego: EgoState) -> float:
        before = self._odometer
        travelled = 0.0 if before is None else before[0] + math.hypot(ego.x - before[1].x, ego.y - before[1].y)
        self._odometer = travelled, ego
        return travelled

    def _reading(self, time: float, ego: EgoState) -> Reading:
        """One answer: the truth, with mistakes and gaps."""
        facts, _ = self._truth.look(time, ego)
        said = []
        for name in sorted(facts):
            value = self._erring(self._vocabulary.fact(name), facts[name])
            if self._random.random() >= self._errors.missed:
                said.append(Statement(name, value, source="scripted", captured=time, rule="truth" if value == facts[name] else "error"))
        return Reading("", tuple(said))

    def _erring(self, fact: Fact, shown: Value) -> Value:
        errors = self._errors
        if fact.name in self._mistakes and self._random.random() < 1 - 1 / errors.run:
            return self._mistakes[fact.name]
        self._mistakes.pop(fact.name, None)
        if self._random.random() >= errors.rate / errors.run:
            return shown
        self._mistakes[fact.name] = mistaken(fact, shown, self._random)
        return self._mistakes[fact.name]


def mistaken(fact: Fact, shown: Value, chance: random.Random) -> Value:
    """Another value that the fact can have: the opposite, another word, a word more or less, a number half to twice as large."""
    if isinstance(shown, bool):
        return not shown
    if isinstance(shown, str):
        return chance.choice([word for word in fact.values if word != shown] or [shown])
    if isinstance(shown, frozenset):
        return shown ^ {chance.choice(fact.values)}
    step = fact.fusion.step if fact.fusion is not None else None
    wrong = shown * chance.uniform(0.5, 2.0)
    return round(wrong / step) * step if step else wrong
