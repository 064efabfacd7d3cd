"""What assessing one manoeuvre finds: the plan to drive, its rank and verdict, and why others fell out."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from regdb.meaning import ILLEGAL, LEGAL, UNKNOWN
from regdb_runtime.decision import Rejection
from regdb_runtime.verdict import Verdict

LAWFUL, UNCERTAIN, UNLAWFUL, NO_PLAN = 0, 1, 2, 3
RANKS: Final = {LEGAL: LAWFUL, UNKNOWN: UNCERTAIN, ILLEGAL: UNLAWFUL}
Violation = tuple[float, ...]
"""How far each duty is broken, weightiest first (`planning.duties`); less is better, empty for what is lawful. Of an unknown plan: how far
each may be broken."""


@dataclass(frozen=True)
class Assessed:
    """The best plan of one manoeuvre by (rank, violation, cost), among those that keep the kinematic limits and touch nobody.

    `index` is its row of the candidates, None without one: then `rank` is 3, and `verdict` that of the cheapest plan that was judged. `verdict`
    is the worst of the stretches the plan crosses (of equally bad ones the first), `verdicts` all of them in order. `violation` is compared
    between plans of the same rank only. `judged`: how many plans were judged.
    """

    index: int | None
    rank: int
    verdict: Verdict | None
    rejections: tuple[Rejection, ...] = ()
    verdicts: tuple[Verdict, ...] = ()
    violation: Violation = ()
    judged: int = 0
