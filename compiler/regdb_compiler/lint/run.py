"""Lint: what reading and resolving found, what the rules find, less what comments and the baseline put up with."""

from __future__ import annotations

import datetime
from collections.abc import Iterator, Sequence
from time import perf_counter

from regdb.front import FrontError
from regdb_compiler import baseline as known_findings
from regdb_compiler import suppression
from regdb_compiler.baseline import Baseline
from regdb_compiler.diagnostics import Diagnostic, in_order
from regdb_compiler.driver import Build
from regdb_compiler.lint.registry import all_rules
from regdb_compiler.lint.rule import Rule
from regdb_compiler.lint.selection import Selection
from regdb_compiler.lint.view import view_of
from regdb_compiler.source import collector_paused


class RuleFailureError(Exception):
    """A rule that could not finish: a mistake in the rule, not in the codes."""


def lint(
    build: Build,
    select: Sequence[str] = (),
    ignore: Sequence[str] = (),
    *,
    baseline: Baseline | None = None,
    today: datetime.date | None = None,
    rules: Sequence[Rule] | None = None,
) -> tuple[Diagnostic, ...]:
    """All findings on a build, in order. `select` and `ignore` hold codes, names and families (`R6`); errors of what cannot be read
    are always told. `today` is the day on which rules about time judge. Raises RuleFailureError, naming the rule."""
    selection = Selection(tuple(select), tuple(ignore))
    with collector_paused():
        return _lint(build, selection, baseline, today, all_rules() if rules is None else rules)


def _lint(
    build: Build, selection: Selection, baseline: Baseline | None, today: datetime.date | None, rules: Sequence[Rule]
) -> tuple[Diagnostic, ...]:
    found = [finding for finding in build.diagnostics if selection.takes(finding.code, finding.name) or selection.always(finding)]
    found += find(build, selection.of(rules), today)
    files = tuple(build.corpus.files.values())
    kept = suppression.apply(found, files, report_unused=selection.is_everything)
    kept = tuple(item for item in kept if selection.takes(item.code, item.name) or selection.always(item))
    return kept if baseline is None else known_findings.apply(baseline, kept, build.corpus.texts)


def find(build: Build, rules: Sequence[Rule], today: datetime.date | None = None) -> tuple[Diagnostic, ...]:
    """What these rules find on a build, before comments and baseline. Raises RuleFailureError."""
    view_of(build, today)
    with collector_paused():
        return in_order(finding for rule in rules for finding in _run(rule, build))


def costs(build: Build, rules: Sequence[Rule]) -> list[tuple[float, Rule]]:
    """Seconds that each rule takes on a build whose shared view has been worked out, dearest first."""
    find(build, rules)
    return sorted(((_seconds(rule, build), rule) for rule in rules), key=lambda item: -item[0])


def _seconds(rule: Rule, build: Build) -> float:
    started = perf_counter()
    for _ in rule.check(build):
        pass
    return perf_counter() - started


def _run(rule: Rule, build: Build) -> Iterator[Diagnostic]:
    try:
        yield from rule.check(build)
    except FrontError:  # a file beside the codes that a person can put right
        raise
    except Exception as error:
        raise RuleFailureError(f"lint rule {rule.code} {rule.name} ({rule.origin}) failed: {type(error).__name__}: {error}") from error
