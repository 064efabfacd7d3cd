"""Why plans fell out: the rule with its citation, what was measured and what binds, in SI and in the law's own unit."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from regdb.condition import linear_value
from regdb.explanation import show_bound
from regdb.meaning import UNKNOWN
from regdb.regulation import Limit, Regulation
from regdb.situation import Situation
from regdb.units import SI_SYMBOL, unit_named
from regdb_runtime.assessment.assessed import RANKS
from regdb_runtime.assessment.judge import Judged, Rows
from regdb_runtime.assessment.measured import Bools
from regdb_runtime.decision import Rejection
from regdb_runtime.verdict import Verdict

COLLISION = "collision"


@dataclass(eq=False)
class Fallen:
    """A count of what made plans fall out: rule -> the first verdict that names it and how many plans; contacts with whom."""

    rules: dict[str, tuple[Verdict, Regulation, int]] = field(default_factory=dict)
    contacts: dict[str, int] = field(default_factory=dict)

    def count(self, judged: Judged, rows: Rows) -> None:
        """Add plans: each counts once for each rule by which it has the rank it has."""
        if not len(rows):
            return
        out = np.zeros(judged.facts.size, dtype=np.bool_)
        out[rows] = True
        named: dict[str, tuple[Verdict, Regulation, Bools]] = {}
        for group in judged.groups:
            fallen = group.rows[out[group.rows] & (judged.rank[group.rows] == RANKS[group.verdict.verdict])]
            for rule in group.verdict.deciding if len(fallen) else ():
                named.setdefault(rule.id, (group.verdict, rule, np.zeros_like(out)))[2][fallen] = True
        for name, (verdict, rule, plans) in named.items():
            held, count = self.rules.get(name), int(plans.sum())
            self.rules[name] = (verdict, rule, count) if held is None else (*held[:2], held[2] + count)

    def touch(self, whom: str) -> None:
        """Add a plan that touches a road user."""
        self.contacts[whom] = self.contacts.get(whom, 0) + 1

    def report(self) -> tuple[Rejection, ...]:
        """Rules by how many plans they cost (then by citation), then contacts."""
        order = sorted(self.rules.values(), key=lambda item: (-item[2], item[1].citation, item[1].id))
        found = [rejection(verdict, rule, count) for verdict, rule, count in order]
        if self.contacts:
            whom = sorted(self.contacts, key=lambda name: (-self.contacts[name], name))
            found.append(Rejection(COLLISION, count=sum(self.contacts.values()), because=f"touches {', '.join(whom)}"))
        return tuple(found)


def rejection(verdict: Verdict, rule: Regulation, count: int = 1) -> Rejection:
    """One rule's objection as the log has it: with a limit what was measured and the bound, else what the rule asks; and what is not known."""
    situation = Situation(verdict.circumstances.vocabulary, verdict.scene, verdict.plan)
    unknown = verdict.judgement.missing((rule,)) if verdict.verdict == UNKNOWN else ()
    missing = f"not known: {', '.join(unknown)}" if unknown else ""
    for limit in rule.limits:
        bound = linear_value(limit.bound, situation)
        if bound is not None:
            value = situation.value(limit.fact)
            measured = None if value is None else float(value)  # type: ignore[arg-type]  # limits bound numbers
            if measured is None or (measured > bound if limit.direction == "max" else measured < bound):
                unit = SI_SYMBOL.get(unit_named(limit.unit).dimension, "")
                return Rejection(rule.citation, measured, bound, unit, count, _joined(_compared(limit, measured, bound), missing))
    return Rejection(rule.citation, count=count, because=_joined(rule.result, missing))


def _compared(limit: Limit, measured: float | None, bound: float) -> str:
    word = "at most" if limit.direction == "max" else "at least"
    asked = f"{word} {show_bound(bound, limit)}"
    return f"{limit.fact} {asked}" if measured is None else f"{limit.fact} is {show_bound(measured, limit)}, {asked} is lawful"


def _joined(*parts: str) -> str:
    return "; ".join(part for part in parts if part)
