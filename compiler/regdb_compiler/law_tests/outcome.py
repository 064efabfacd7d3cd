"""What came of a law test: passed, failed with its differences, or broken with its reasons."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Literal

from regdb.explanation import Explanation, explain
from regdb.meaning import Decision, Judgement
from regdb_compiler.law_tests.read import LawTest

Status = Literal["passed", "failed", "broken"]


@dataclass(frozen=True, slots=True)
class Difference:
    """One key of the expectation that came out otherwise, as a person reads it."""

    key: str
    expected: str
    got: str


@dataclass(frozen=True, eq=False)
class Outcome:
    """One test judged. A broken test has no judgement; `reasons` say why."""

    test: LawTest
    status: Status
    judgement: Judgement | None = None
    differences: tuple[Difference, ...] = ()
    reasons: tuple[str, ...] = ()

    @property
    def decision(self) -> Decision | None:
        return None if self.judgement is None else self.judgement.decision

    @cached_property
    def explanation(self) -> Explanation | None:
        """Why the law answered as it did; worked out only when asked for."""
        return None if self.judgement is None else explain(self.judgement)


@dataclass(frozen=True, slots=True)
class Tally:
    """Counts of a run; `regulations` have tests beside them, `cases` involve several sections."""

    passed: int
    failed: int
    broken: int
    regulations: int
    cases: int

    @property
    def ok(self) -> bool:
        return not (self.failed or self.broken)


def tally(outcomes: tuple[Outcome, ...]) -> Tally:
    """Count a run's outcomes."""
    by = {status: sum(1 for item in outcomes if item.status == status) for status in ("passed", "failed", "broken")}
    beside = {item.test.entry for item in outcomes if item.test.entry is not None}
    cases = sum(1 for item in outcomes if item.test.entry is None)
    return Tally(by["passed"], by["failed"], by["broken"], len(beside), cases)
