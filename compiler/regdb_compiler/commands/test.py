"""`regdb test`: run the law's own tests, with coverage, boundaries and mutation."""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable, Iterable, Iterator
from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from regdb.front import FrontError, codes_folder
from regdb_compiler.commands.mutants import MutateOptions, say_boundaries, say_mutation
from regdb_compiler.driver import Build, build
from regdb_compiler.law_tests import to_json, to_junit
from regdb_compiler.law_tests.coverage import Coverage, cover
from regdb_compiler.law_tests.coverage_text import coverage_text
from regdb_compiler.law_tests.judge import judge_tests
from regdb_compiler.law_tests.outcome import Outcome, tally
from regdb_compiler.law_tests.read import LawTest
from regdb_compiler.law_tests.to_text import closing_line, outcomes_text


class Format(StrEnum):
    """How outcomes are written."""

    text = "text"
    json = "json"
    junit = "junit"


def command(
    paths: Annotated[list[Path] | None, typer.Argument(help="Files or folders whose tests to run; default: all.")] = None,
    word: Annotated[str, typer.Option("-k", metavar="WORD", help="Only tests whose name, regulation or file has this word.")] = "",
    codes: Annotated[Path | None, typer.Option(help="Folder of codes.")] = None,
    coverage: Annotated[bool, typer.Option("--coverage", help="Show what no test has tried: by rule, branch and state.")] = False,
    fail_under: Annotated[float, typer.Option("--cov-fail-under", metavar="PERCENT", help="Findings if coverage is less.")] = 0.0,
    format_: Annotated[Format, typer.Option("--format", help="text, json or junit.")] = Format.text,
    boundaries: Annotated[bool, typer.Option("--boundaries", help="Judge scenes below, at and above every number of the law.")] = False,
    mutate: Annotated[bool, typer.Option("--mutate", help="Change the law, one thing at a time; show what no test notices.")] = False,
    sample: Annotated[int, typer.Option(metavar="N", min=0, help="With --mutate: only N of the mutants.")] = 0,
    seed: Annotated[int, typer.Option(metavar="S", help="With --sample: which of them.")] = 0,
    mutate_under: Annotated[float, typer.Option("--mutate-under", metavar="PERCENT", help="Findings if the mutation score is less.")] = 0.0,
    first: Annotated[bool, typer.Option("-x", help="Stop at the first test that does not pass.")] = False,
    quiet: Annotated[bool, typer.Option("-q", help="One line for each test that does not pass.")] = False,
) -> None:
    started = time.perf_counter()
    found = build(codes_folder(codes))
    wanted = _wanted(found, paths or [])
    if boundaries or mutate or mutate_under:
        if format_ is Format.junit:
            raise typer.BadParameter("boundaries and mutants are written as text or json", param_hint="--format")
        if boundaries:
            raise typer.Exit(say_boundaries(found, wanted, json=format_ is Format.json))
        raise typer.Exit(say_mutation(found, wanted, MutateOptions(sample, seed, mutate_under, format_ is Format.json)))
    outcomes = tuple(_until_first(judge_tests(found, _chosen(found, paths or [], word)), first))
    counted = cover(found, outcomes) if coverage or fail_under else None
    if format_ is Format.json:
        typer.echo(to_json.render(outcomes, counted), nl=False)
    elif format_ is Format.junit:
        typer.echo(to_junit.render(outcomes), nl=False)
    else:
        color = sys.stdout.isatty() and not os.environ.get("NO_COLOR")
        typer.echo(outcomes_text(outcomes, quiet=quiet, color=color), nl=False)
        if coverage and counted is not None:
            typer.echo(coverage_text(counted))
        typer.echo(closing_line(tally(outcomes), time.perf_counter() - started))
    raise typer.Exit(_exit_code(found, outcomes, counted, fail_under))


def _chosen(found: Build, paths: list[Path], word: str) -> list[LawTest]:
    """The tests of the named files and folders whose name, regulation or path has the word. Raises FrontError."""
    wanted, lower = _wanted(found, paths), word.lower()
    tests = (test for test in found.law_tests if wanted(test.where.path))
    return [test for test in tests if lower in f"{test.name} {test.subject} {test.where.path}".lower()]


def _wanted(found: Build, paths: list[Path]) -> Callable[[str], bool]:
    """Whether a file is one of those named, or under a folder named; every file where none is. Raises FrontError."""
    base = found.corpus.root.parent
    roots = [_within(path, base) for path in paths]
    for path, root in zip(paths, roots, strict=True):
        if root != "." and not any(_under(name, root) for name in found.corpus.files):
            raise FrontError(f"{path} is no file or folder of the codes in {found.corpus.root}")
    return lambda name: not roots or any(_under(name, root) for root in roots)


def _within(path: Path, base: Path) -> str:
    try:
        return path.resolve().relative_to(base).as_posix()
    except ValueError:
        return path.resolve().as_posix()


def _under(name: str, root: str) -> bool:
    return root == "." or name == root or name.startswith(f"{root}/")


def _until_first(outcomes: Iterable[Outcome], stop: bool) -> Iterator[Outcome]:
    for outcome in outcomes:
        yield outcome
        if stop and outcome.status != "passed":
            return


def _exit_code(found: Build, outcomes: tuple[Outcome, ...], counted: Coverage | None, fail_under: float) -> int:
    code = 0 if tally(outcomes).ok else 1
    errors = sum(1 for item in found.diagnostics if item.level == "error" and not item.code.startswith("R8"))
    if errors:
        typer.echo(f"the codes have {errors} errors, which leave regulations out; see `regdb lint`", err=True)
        code = 1
    if counted is not None and counted.percent < fail_under:
        typer.echo(f"coverage is {counted.percent:.1f} %, less than {fail_under:g} %", err=True)
        code = 1
    return code
