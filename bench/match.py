"""Time the matcher on sentences and whole responses of its own tests, beside a fixed loop that tells how fast this machine is now.

    python bench/match.py
"""

# ruff: noqa: T201  # a script whose result is what it prints
from __future__ import annotations

import statistics
import time
from collections.abc import Callable
from pathlib import Path

import yaml
from matcher_keys import facts, matcher
from regdb_runtime.database import RegulationDatabase
from regdb_runtime.perception.matcher import Matcher

from regdb.front import database

SENTENCES = Path(__file__).parents[1] / "tests" / "runtime" / "data" / "matcher_sentences.yaml"
RESPONSE = 4
"""Sentences of a made response."""
LOOP_MARK_US = 1250.0
"""What the fixed loop takes where the marks were set."""
MARK_US = 120.0
"""Most microseconds a response may take, at the median."""


def microseconds(call: Callable[[], object], rounds: int = 5) -> float:
    """The least time of some rounds."""
    best = float("inf")
    for _ in range(rounds):
        started = time.perf_counter()
        call()
        best = min(best, time.perf_counter() - started)
    return 1e6 * best


def fixed_loop() -> None:
    """The yardstick: 20,000 steps of a plain dictionary count."""
    counts: dict[int, int] = {}
    for step in range(20_000):
        counts[step % 97] = counts.get(step % 97, 0) + 1


def main() -> None:
    """Print medians of reading, of reading into the keys of the labelling, of compiling the lexicon, and the yardstick."""
    kinds = yaml.safe_load(SENTENCES.read_text("utf-8")).values()
    texts = [text for ways in kinds for said in ways.values() for text in said]
    responses = [" ".join(texts[at : at + RESPONSE]) for at in range(0, len(texts), RESPONSE)]
    reader = matcher()
    for text in texts:
        reader.read(text)
    loop = microseconds(fixed_loop, 15)
    sentence = statistics.median(microseconds(lambda text=text: reader.read(text)) for text in texts)  # type: ignore[misc]
    keyed = statistics.median(microseconds(lambda text=text: facts(text)) for text in texts)  # type: ignore[misc]
    response = statistics.median(microseconds(lambda text=text: reader.read(text)) for text in responses)  # type: ignore[misc]
    vocabulary = RegulationDatabase.open(database()).vocabulary
    print(f"fixed loop       {loop:8.0f} us  ({loop / LOOP_MARK_US:.1f} times the mark's machine)")
    print(f"a sentence       {sentence:8.1f} us")
    print(f"with its keys    {keyed:8.1f} us  ({keyed / loop * LOOP_MARK_US:.1f} us on the mark's machine; mark {MARK_US:.0f})")
    print(f"{RESPONSE} sentences      {response:8.1f} us")
    print(f"lexicon compiled {microseconds(lambda: Matcher(vocabulary), 3) / 1000:8.1f} ms")


if __name__ == "__main__":
    main()
