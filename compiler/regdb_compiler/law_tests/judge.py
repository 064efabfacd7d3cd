"""Law tests -> outcomes: each is judged by the reference meaning, and what it expects is compared with what came out."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from regdb.explanation import show_bound
from regdb.meaning import Decision, Judgement
from regdb.situation import Situation
from regdb_compiler.law_tests.expect import ExpectedLimit
from regdb_compiler.law_tests.outcome import Difference, Outcome
from regdb_compiler.law_tests.read import LawTest
from regdb_compiler.law_tests.take_part import Law

if TYPE_CHECKING:
    from regdb_compiler.driver import Build


def judge_tests(build: Build, tests: Iterable[LawTest]) -> Iterator[Outcome]:
    """Judge tests one after the other; they are read already (`build.law_tests`)."""
    law = Law(build.regulations, build.corpus.tree)
    sound = {row.entry for row in build.rows}
    for test in tests:
        if test.problems:
            yield Outcome(test, "broken", reasons=tuple(f"{item.place}: {item.message}" for item in test.problems))
        elif test.entry is not None and test.entry not in sound:
            yield Outcome(test, "broken", reasons=(f"{test.entry.id} cannot be read; `regdb lint` says why",))
        else:
            yield _judge(build, law, test)


def _judge(build: Build, law: Law, test: LawTest) -> Outcome:
    assert test.plan is not None  # only unreadable tests lack one
    rules = law.everything(test.place, test.day) if test.entry is None else law.beside(test.entry.id, test.place, test.day)
    judgement = Judgement(rules, Situation(build.corpus.vocabulary, test.scene, test.plan))
    differences = tuple(compare(test, judgement.decision))
    return Outcome(test, "failed" if differences else "passed", judgement, differences)


def compare(test: LawTest, decision: Decision) -> Iterator[Difference]:
    """Where the decision is otherwise than expected; keys that are not written are not compared."""
    expected = test.expected
    if expected.verdict is not None and expected.verdict != decision.verdict:
        yield Difference("verdict", expected.verdict, decision.verdict)
    sets = (
        ("deciding", expected.deciding, [rule.id for rule in decision.deciding]),
        ("unknown", expected.unknown, decision.missing),
        ("assumed", expected.assumed, decision.assumed),
    )
    for key, wanted, found in sets:
        if wanted is not None and wanted != frozenset(found):
            yield Difference(key, _listed(wanted), _listed(found))
    if expected.limits is not None:
        yield from _compare_limits(expected.limits, decision)


def _compare_limits(wanted: tuple[ExpectedLimit, ...], decision: Decision) -> Iterator[Difference]:
    found = decision.combined
    if not wanted and found:
        yield Difference("limits", "none", _listed(f"{name}: {show_bound(item.bound, item.limit)}" for name, item in found.items()))
    for item in wanted:
        held = found.get(item.attribute)
        bound = None if held is None else held.bound
        same = bound == item.bound or (bound is not None and item.bound is not None and math.isclose(bound, item.bound))
        if not same:
            got = "none" if held is None else f"{show_bound(held.bound, held.limit)} ({held.regulation.id})"
            yield Difference(item.attribute, item.text, got)


def _listed(names: Iterable[str]) -> str:
    return ", ".join(sorted(set(names))) or "none"
