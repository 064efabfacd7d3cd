"""Measures how often fused perception lets go what is forbidden: a light at which the vehicle waits, looked at by erring sources for hours.

    python bench/fusion.py [--hours 1000] [--seed 5]

A light is green for 25 s, yellow for 3.5 s, red for 31.5 s. The model answers at 2 Hz and errs at a rate, independently or in runs of the
same wrong answer (8 answers, 4 s, on average). A light detector that looks where the map has the light reads at 10 Hz and errs in 0.5 % of
looks, independently or in runs of 5; a light that reports its phase to the map (SPaT) says each tenth of a second what it shows, 0.3 s late.
Counted are episodes in which `signal.color` is fused as green while the light is red, each from its first to its last moment.

The fusion itself runs at every look of the model over every stretch of red in which the model says green as often as the policy asks; elsewhere
nothing could make it say so (three seconds back are run with it, longer than anything about a light is remembered).
"""

# ruff: noqa: T201  # a script whose result is what it prints

from __future__ import annotations

import argparse
import time
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from regdb_runtime.database import RegulationDatabase
from regdb_runtime.perception.evidence import Source, Statement
from regdb_runtime.perception.policies import Held, Moment, believe

from regdb.front import database
from regdb.fusion_policy import FusionPolicy
from regdb.vocabulary import Fact, Vocabulary

GREEN, YELLOW, RED = 25.0, 3.5, 31.5
CYCLE = GREEN + YELLOW + RED
COLORS = np.array(["green", "yellow", "red"])
BEFORE = 3.0
"""Seconds run before each wrong answer: longer than `holds`, `fresh` and `within` of the class `light`."""
DETECTOR_ERROR, DETECTOR_RUN, DETECTOR_HZ = 0.005, 5.0, 10.0
SPAT_LATE, SPAT_HZ = 0.3, 10.0
MODEL_HZ, MODEL_RUN = 2.0, 8.0
OTHERWISE = 100.0
"""Hours simulated where the map says nothing."""
BLOCK = 50.0
"""Hours simulated at once."""
RATES = (0.01, 0.05, 0.10)
BESIDE = ("nothing", "detector", "detector in runs", "map")


@dataclass(frozen=True)
class Looks:
    """One source's looks in order of time: when captured (s), and which colour it said (index into COLORS)."""

    source: Source
    times: NDArray[np.float64]
    said: NDArray[np.int64]


def truth(times: NDArray[np.float64]) -> NDArray[np.int64]:
    """The colour shown at each time."""
    phase = np.mod(times, CYCLE)
    return np.where(phase < GREEN, 0, np.where(phase < GREEN + YELLOW, 1, 2))


def erring(rng: np.random.Generator, times: NDArray[np.float64], rate: float, run: float) -> NDArray[np.int64]:
    """What is said: the truth, or in a share `rate` of looks another colour, in runs of `run` looks on average (1: independent), one colour a run."""
    count = len(times)
    shown = truth(times)
    if run <= 1:
        wrong = rng.random(count) < rate
        return np.where(wrong, (shown + rng.integers(1, 3, count)) % 3, shown)
    said = shown.copy()
    start = 0
    sane = run * (1 - rate) / rate
    while start < count:
        start += int(rng.geometric(1 / sane))
        length = int(rng.geometric(1 / run))
        if start < count:
            said[start : start + length] = (shown[start] + int(rng.integers(1, 3))) % 3
        start += length
    return said


def looks(rng: np.random.Generator, source: Source, hz: float, seconds: float, rate: float, run: float) -> Looks:
    times = np.arange(int(seconds * hz)) / hz + rng.random() / hz
    return Looks(source, times, erring(rng, times, rate, run))


def spat(seconds: float) -> Looks:
    """What the light reports of itself: right, and late."""
    times = np.arange(int(seconds * SPAT_HZ)) / SPAT_HZ
    return Looks("map", times + SPAT_LATE, truth(times))


def beside(rng: np.random.Generator, kind: str, seconds: float) -> tuple[Looks, ...]:
    """What corroborates."""
    if kind == "map":
        return (spat(seconds),)
    if kind == "nothing":
        return ()
    return (looks(rng, "detector", DETECTOR_HZ, seconds, DETECTOR_ERROR, DETECTOR_RUN if "runs" in kind else 1.0),)


def stretches(model: Looks) -> Iterator[tuple[float, float]]:
    """(from, to): spans of time in which the model says green at red, with what fusion remembers before and after."""
    wrong = model.times[(model.said == 0) & (truth(model.times) == 2)]
    begin = end = None
    for moment in wrong:
        if end is not None and moment > end:
            yield begin or 0.0, end
            begin = None
        begin = moment - BEFORE if begin is None else begin
        end = moment + BEFORE
    if begin is not None and end is not None:
        yield begin, end


def episodes(fact: Fact, policy: FusionPolicy, sources: tuple[Looks, ...], span: tuple[float, float]) -> int:
    """Times within a span at which the fused light turns green while the light is red: the pure core, at every look of the model."""
    held: list[Held] = []
    low, high = np.searchsorted(sources[0].times, span)
    if np.count_nonzero(sources[0].said[low:high] == 0) < policy.confirmations:
        return 0
    for look in sources:
        low, high = np.searchsorted(look.times, span)
        held += [
            Held(Statement(fact.name, str(COLORS[said]), source=look.source, captured=float(at)), 0.0)
            for at, said in zip(look.times[low:high], look.said[low:high], strict=True)
        ]
    held.sort(key=lambda item: item.captured)
    found, was, first = 0, False, 0
    for index, item in enumerate(held):
        now = item.captured
        while held[first].captured < now - BEFORE:
            first += 1
        if item.statement.source != "model":
            continue
        if not _model_greens(held[first : index + 1], policy.confirmations):
            was = False
            continue
        belief = believe(fact, policy, held[first : index + 1], Moment(now, 0.0))
        wrong = belief is not None and belief.value == "green" and int(truth(np.array([now]))[0]) == 2
        found += wrong and not was
        was = wrong
    return found


def _model_greens(held: list[Held], needed: int) -> bool:
    """Whether the model has said green often enough within memory for the fusion to be asked at all."""
    return sum(item.statement.source == "model" and item.statement.value == "green" for item in held) >= needed


@dataclass(frozen=True)
class Outcome:
    """False greens: of the raw answers taken at their word, and of the fusion, over so many hours."""

    rate: float
    run: float
    kind: str
    hours: float
    raw: int
    fused: int


def simulate(vocabulary: Vocabulary, rate: float, run: float, kind: str, hours: float, seed: int, policy: FusionPolicy | None = None) -> Outcome:
    """One row: the policy of `signal.color`, or another one (without corroboration for comparison)."""
    blocks = [min(BLOCK, hours - start) for start in np.arange(0.0, hours, BLOCK)]
    parts = [_block(vocabulary, Outcome(rate, run, kind, float(length), 0, 0), [seed, number], policy) for number, length in enumerate(blocks)]
    return Outcome(rate, run, kind, hours, sum(part.raw for part in parts), sum(part.fused for part in parts))


def _block(vocabulary: Vocabulary, row: Outcome, seed: list[int], policy: FusionPolicy | None) -> Outcome:
    """As many hours as fit into memory."""
    fact = vocabulary.fact("signal.color")
    assert fact.fusion is not None
    rate, run, kind = row.rate, row.run, row.kind
    rng = np.random.default_rng([*seed, int(rate * 1000), int(run), BESIDE.index(kind)])
    seconds = row.hours * 3600
    model = looks(rng, "model", MODEL_HZ, seconds, rate, run)
    sources = (model, *beside(rng, kind, seconds))
    wrong = (model.said == 0) & (truth(model.times) == 2)
    raw = int(np.count_nonzero(wrong & ~np.concatenate(([False], wrong[:-1]))))
    used = policy or fact.fusion
    return replace(row, raw=raw, fused=sum(episodes(fact, used, sources, span) for span in stretches(model)))


def without_corroboration(vocabulary: Vocabulary) -> FusionPolicy:
    """The same policy for a model that nobody corroborates: what two fresh confirmations and the hold are worth by themselves."""
    policy = vocabulary.fact("signal.color").fusion
    assert policy is not None
    return replace(policy, corroboration=())


def table(vocabulary: Vocabulary, hours: float, seed: int) -> Iterator[tuple[str, ...]]:
    """Rows of the report: rate, how errors come, raw episodes an hour, then episodes an hour by what stands beside the model."""
    loose = without_corroboration(vocabulary)
    for run in (1.0, MODEL_RUN):
        for rate in RATES:
            alone = simulate(vocabulary, rate, run, "nothing", min(hours, OTHERWISE), seed, loose)
            rows = [simulate(vocabulary, rate, run, kind, hours if kind == "map" else min(hours, OTHERWISE), seed) for kind in BESIDE]
            shares = (shown(alone.raw, alone.hours), shown(alone.fused, alone.hours), *(shown(row.fused, row.hours) for row in rows))
            yield (f"{rate:.0%}", "independent" if run == 1 else f"in runs of {run:.0f}", *shares)


def shown(count: int, hours: float) -> str:
    """Episodes an hour; none of them as none in so many hours."""
    return f"{count / hours:.3g}" if count else f"0 in {hours:g} h"


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--hours", type=float, default=1000.0)
    parser.add_argument("--seed", type=int, default=5)
    arguments = parser.parse_args()
    began = time.perf_counter()
    vocabulary = RegulationDatabase.open(database()).vocabulary
    print("| model errs | errors | taken at its word | confirmed, not corroborated | model alone | and detector | and detector in runs | and map |")
    print("|---|---|---|---|---|---|---|---|")
    for row in table(vocabulary, arguments.hours, arguments.seed):
        print("| " + " | ".join(row) + " |", flush=True)
    other, took = min(arguments.hours, OTHERWISE), time.perf_counter() - began
    print(f"\n{arguments.hours:g} hours with the map, {other:g} hours otherwise, seed {arguments.seed}, {took:.0f} s")


if __name__ == "__main__":
    main()
