"""The regulation as it crosses from compiler to runtime: one row, one dated version, everything resolved."""

from __future__ import annotations

from dataclasses import dataclass

from regdb.condition import TRUE, Linear, Node, facts_of

FORCES = ("absolute", "prima_facie", "basic", "penalty_tier", "advisory")
"""Kinds of limit. A penalty tier never loosens anything and is no limit to plan by; an advisory one makes nothing unlawful."""

NO_LIMIT_IN_FORCE = frozenset({"penalty_tier", "advisory"})


@dataclass(frozen=True, slots=True)
class Limit:
    """A bound on a quantity of the plan: `attribute` (max_speed), `fact` it bounds, `direction` max or min, `bound` in SI.

    The bound itself is within the limit. `unit` is the law's own, `text` the law's own words for the bound.
    """

    attribute: str
    fact: str
    direction: str
    bound: Linear
    unit: str = ""
    text: str = ""


@dataclass(frozen=True, slots=True)
class Regulation:
    """One regulation in one dated version, as lowered: states expanded, definitions inlined, targets resolved to ids.

    `effective` and `until` are day numbers, half-open; None is open. `current` and `next` are state ids, None for all.
    `targets` are the ids it defeats while it is in effect (its exception_to and overrides).
    """

    id: str
    citation: str
    jurisdiction: str
    legality: bool
    effective: int | None = None
    until: int | None = None
    when: Node = TRUE
    unless: Node | None = None
    limits: tuple[Limit, ...] = ()
    force: str = ""
    current: frozenset[str] | None = None
    next: frozenset[str] | None = None
    targets: tuple[str, ...] = ()
    overrides: tuple[str, ...] = ()
    authority: str = ""
    title: str = ""
    topic: str = ""
    tags: tuple[str, ...] = ()
    condition: str = ""
    result: str = ""
    quote: str = ""
    vagueness: int = 0
    vague_because: str = ""
    confidence: str = ""

    def in_force(self, day: int) -> bool:
        """Whether this version is in force on the day: effective inclusive, until exclusive."""
        return (self.effective is None or self.effective <= day) and (self.until is None or day < self.until)

    def concerns(self, current: str, following: str) -> bool:
        """Whether the transition between two state ids is one this regulation speaks of."""
        return (self.current is None or current in self.current) and (self.next is None or following in self.next)

    @property
    def facts(self) -> tuple[str, ...]:
        """Facts of the scene and plan that decide it, each once."""
        names = [*facts_of(self.when), *(facts_of(self.unless) if self.unless is not None else ())]
        for limit in self.limits:
            names += [limit.fact, *(fact for _, fact in limit.bound.terms)]
        return tuple(dict.fromkeys(names))
