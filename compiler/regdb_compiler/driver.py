"""The one module that knows the order of the passes: read, resolve, precedence, authority, law tests, lower."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from regdb.regulation import Regulation
from regdb_compiler.authority import Authority
from regdb_compiler.corpus import Corpus
from regdb_compiler.diagnostics import Diagnostic, in_order
from regdb_compiler.law_tests.read import LawTest, check_tests, read_tests
from regdb_compiler.lower import Row, lower
from regdb_compiler.precedence import Targets, find_targets
from regdb_compiler.read_corpus import read_corpus
from regdb_compiler.resolve import Resolution, resolve
from regdb_compiler.source import collector_paused
from regdb_compiler.timeline import check_timeline


@dataclass(frozen=True)
class Build:
    """A codes folder taken as far as rows; `diagnostics` are all errors that reading and resolving found."""

    corpus: Corpus
    resolution: Resolution
    targets: Targets
    authority: Authority
    diagnostics: tuple[Diagnostic, ...]
    law_tests: tuple[LawTest, ...] = ()

    @cached_property
    def rows(self) -> tuple[Row, ...]:
        """Rows of every sound regulation. With errors among the diagnostics they are for looking at, not for driving."""
        with collector_paused():
            return lower(self.resolution, self.targets, self.authority)

    @cached_property
    def regulations(self) -> tuple[Regulation, ...]:
        return tuple(row.regulation for row in self.rows)

    @property
    def has_errors(self) -> bool:
        return any(item.level == "error" for item in self.diagnostics)


def build(codes: Path, added: Sequence[Path] | None = None) -> Build:
    """Read and resolve a codes folder and what is added to it; never raises for what is in them. `added` is as in `read_corpus`."""
    with collector_paused():
        return _build(codes, added)


def _build(codes: Path, added: Sequence[Path] | None) -> Build:
    corpus = read_corpus(codes, added)
    resolution = resolve(corpus)
    targets = find_targets(corpus)
    authority = Authority(resolution, targets)
    tests = read_tests(corpus)
    found = corpus.diagnostics
    if corpus.has_language:  # else all that follows would only tell of the words that are missing
        found = (*found, *resolution.diagnostics, *targets.problems, *check_timeline(corpus), *authority.check(), *check_tests(tests))
    return Build(corpus, resolution, targets, authority, in_order(found), tests)
