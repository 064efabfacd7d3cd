"""Mutants, tests -> results: which test notices each mutant, which mutants nothing can notice, and the score."""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

from regdb_compiler.driver import Build
from regdb_compiler.mutation.equivalent import why_equivalent
from regdb_compiler.mutation.kill import Trials
from regdb_compiler.mutation.mutant import KINDS, Mutant


@dataclass(frozen=True, slots=True)
class Result:
    """One mutant with the test that noticed it, as `path:line name`, or why nothing can."""

    mutant: Mutant
    killed_by: str = ""
    equivalent: str = ""

    @property
    def survives(self) -> bool:
        return not self.killed_by and not self.equivalent


@dataclass(frozen=True)
class Count:
    """Mutants killed of those that can be told from the law; equivalent ones stand beside."""

    killed: int
    total: int
    equivalent: int

    @property
    def score(self) -> float:
        """Killed in a hundred; a hundred where there was nothing to kill."""
        return 100.0 * self.killed / self.total if self.total else 100.0


@dataclass(frozen=True)
class Mutation:
    """All results of a run; `generated` mutants there were before sampling."""

    results: tuple[Result, ...]
    generated: int

    @cached_property
    def codes(self) -> tuple[str, ...]:
        return tuple(sorted({item.mutant.code for item in self.results}))

    @cached_property
    def kinds(self) -> tuple[str, ...]:
        """Kinds that occur, in the order of reports."""
        there = {item.mutant.kind for item in self.results}
        return tuple(kind for kind in KINDS if kind in there)

    def count(self, code: str | None = None, kind: str | None = None) -> Count:
        """The count of one code and kind, or of all."""
        own = [r for r in self.results if code in (None, r.mutant.code) and kind in (None, r.mutant.kind)]
        equivalent = sum(1 for item in own if item.equivalent)
        return Count(sum(1 for item in own if item.killed_by), len(own) - equivalent, equivalent)

    @property
    def survivors(self) -> tuple[Result, ...]:
        return tuple(item for item in self.results if item.survives)


def chosen(mutants: Sequence[Mutant], sample: int, seed: int) -> tuple[Mutant, ...]:
    """So many of the mutants, drawn by the seed, in their order; all where `sample` is 0."""
    if not sample or sample >= len(mutants):
        return tuple(mutants)
    picked = set(random.Random(seed).sample(range(len(mutants)), sample))
    return tuple(mutant for position, mutant in enumerate(mutants) if position in picked)


def judge_mutants(build: Build, mutants: Sequence[Mutant], told: Callable[[int], None] = lambda _: None) -> Iterator[Result]:
    """Results in the order of the mutants; `told` is called with how many are done. Tests that fail on the law itself notice nothing."""
    trials = Trials(build)
    for position, mutant in enumerate(mutants):
        test = trials.killer(mutant)
        if test is not None:
            yield Result(mutant, f"{test.where.path}:{test.where.line} {test.name}")
        else:
            yield Result(mutant, equivalent=why_equivalent(mutant, build))
        told(position + 1)
