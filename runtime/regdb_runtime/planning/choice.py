"""The choice among candidates: lawful before unknown before unlawful, then the weighted cost, then the order they were given in.

No weight can buy a breach: the weighted sum is compared only between candidates of the same rank. Among unlawful ones, when there is nothing
else, the lesser breach by declared order of duties wins before cost is looked at; among unknown ones likewise the lesser breach that there may
be, so that a vehicle that knows little stops at a red light rather than take it that somebody waves it through.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final, Literal, Protocol

from regdb_runtime.planning.cost import CostTerms
from regdb_runtime.planning.duties import DUTIES, Duty, violations
from regdb_runtime.verdict import Verdict

LAWFUL, UNKNOWN, UNLAWFUL, NO_PLAN = 0, 1, 2, 3

ChoiceFlag = Literal["", "unknown", "least_violation", "no_trajectory"]
FLAGS: Final[tuple[ChoiceFlag, ...]] = ("", "unknown", "least_violation", "no_trajectory")
"""By rank: what is to be said of a choice."""


class Option(Protocol):
    """What is chosen among: a `decision.CandidateReport`, or whatever has these."""

    @property
    def rank(self) -> int: ...
    @property
    def cost(self) -> CostTerms | None: ...
    @property
    def verdict(self) -> Verdict | None: ...


@dataclass(frozen=True, slots=True)
class Choice:
    """Index of the chosen option (None: none has a plan), what the next best of the same rank (and the same breach, unless lawful) costs more
    than it, and the flag. `violations`: how far the chosen one breaks each duty, or may, in their order; empty when it is lawful."""

    index: int | None
    margin: float | None
    flag: ChoiceFlag
    violations: tuple[float, ...] = ()


Key = tuple[int, tuple[float, ...], float, int]


def choose(
    options: Sequence[Option], duties: Sequence[Duty] = DUTIES, ties: Sequence[int] | None = None,
    breaches: Callable[[Option], tuple[float, ...]] | None = None,
) -> Choice:  # fmt: skip
    """The best option: least by (rank, breach, weighted cost, tie).

    `ties`: the place of each option in the fixed order that settles equal costs (a state's place in the machine); without it the order given.
    `breaches` measures an option that is not lawful; by default from its verdict. An option without a cost has no plan, whatever its rank. A cost
    that is not a number counts as the greatest.
    """
    measure = breaches or (lambda option: () if option.verdict is None else violations(option.verdict, duties))
    keys = [_key(option, index if ties is None else ties[index], measure) for index, option in enumerate(options)]
    able = [index for index, key in enumerate(keys) if key[0] < NO_PLAN]
    if not able:
        return Choice(None, None, "no_trajectory")
    first, *others = sorted(able, key=lambda index: keys[index])
    best = keys[first]
    margin = next((keys[index][2] - best[2] for index in others if keys[index][:2] == best[:2] and math.isfinite(keys[index][2])), None)
    return Choice(first, margin, FLAGS[best[0]], best[1])


def _key(option: Option, tie: int, measure: Callable[[Option], tuple[float, ...]]) -> Key:
    if option.cost is None or option.rank >= NO_PLAN:
        return NO_PLAN, (), 0.0, tie
    total = option.cost.total
    return option.rank, measure(option) if option.rank in (UNKNOWN, UNLAWFUL) else (), total if total == total else float("inf"), tie
