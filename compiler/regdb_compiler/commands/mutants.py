"""What `regdb test` says of the law's tests themselves: mutants no test notices, and the sides of numbers no test shows."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from dataclasses import dataclass

import typer

from regdb_compiler.driver import Build
from regdb_compiler.law_tests.boundaries import boundaries
from regdb_compiler.law_tests.boundaries_text import boundaries_json, boundaries_text
from regdb_compiler.mutation.generate import generate
from regdb_compiler.mutation.report import mutation_json, mutation_text
from regdb_compiler.mutation.run import Mutation, chosen, judge_mutants

_EVERY = 100
"""Mutants between two lines of progress."""

Wanted = Callable[[str], bool]
"""Whether a file, by its path in the codes, was asked for."""


@dataclass(frozen=True, slots=True)
class MutateOptions:
    """`sample` mutants drawn by `seed` (0: all), the least score that is no finding, and whether to write JSON."""

    sample: int
    seed: int
    under: float
    json: bool


def say_mutation(build: Build, wanted: Wanted, options: MutateOptions) -> int:
    """Print what no test notices; returns the exit code."""
    started = time.perf_counter()
    mutants = generate(build, wanted)
    picked = chosen(mutants, options.sample, options.seed)
    found = Mutation(tuple(judge_mutants(build, picked, _progress(len(picked)))), len(mutants))
    if options.json:
        typer.echo(mutation_json(found), nl=False)
    else:
        typer.echo(mutation_text(found, time.perf_counter() - started), nl=False)
    score = found.count().score
    if score < options.under:
        typer.echo(f"the mutation score is {score:.1f} %, less than {options.under:g} %", err=True)
        return 1
    return 0


def _progress(total: int) -> Callable[[int], None]:
    """A count on stderr that writes over itself, on a terminal only."""
    if not sys.stderr.isatty():
        return lambda _: None

    def told(done: int) -> None:
        if done == total:
            sys.stderr.write("\r" + " " * 40 + "\r")
        elif done % _EVERY == 0:
            sys.stderr.write(f"\rmutants {done}/{total}")
        sys.stderr.flush()

    return told


def say_boundaries(build: Build, wanted: Wanted, *, json: bool) -> int:
    """Print what the scenes around every number show; returns the exit code: 1 where the law answers otherwise than it says."""
    found = boundaries(build, wanted)
    typer.echo(boundaries_json(found) if json else boundaries_text(found), nl=False)
    return 1 if found.wrong else 0
